/// The command `fase view`: shows a recording in the browser, or writes it as a page or as an animation.
#include "cli/view/view.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>

#include <cstdio>
#include <filesystem>
#include <system_error>
#include <thread>
#include <vector>

#include "cli/common/arguments.hpp"
#include "cli/common/command_registry.hpp"
#include "cli/common/input.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/output.hpp"
#include "cli/view/page.hpp"
#include "cli/view/server.hpp"
#include "fase/core/detail/files.hpp"
#include "fase/record/glb_export.hpp"
#include "fase/record/player.hpp"
#include "fase/record/recording/input_file.hpp"

namespace fase::cli {
namespace {

void warn(const std::string& text) { print_line("warning", text); }

/// Checks that the output files can be written and differ from the input.
Result<void> check_outputs(const ViewOptions& options, const std::string& input) {
    if (!options.html.empty())
        if (Result<void> checked = check_output(options.html, {output::page}, input); !checked) return checked;
    return options.glb.empty() ? Result<void>{} : check_output(options.glb, {output::animation}, input);
}

/// Refuses files of other kinds. The player judges beginnings of recordings, and missing files, which may have a
/// NAME.part.
Result<void> check_recording(const std::string& file) {
    static constexpr FileKind kinds[]{FileKind::Recording, FileKind::Other, FileKind::Empty};
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return {};
    const auto checked = check_input(file, {"view", "recordings (.faserec)", kinds});
    return checked ? Result<void>{} : checked.error();
}

/// The valid bytes of a recording.
Result<std::vector<std::byte>> good_bytes(const record::Player& player) {
    const Result<record::InputFile> file = record::InputFile::open(player.path());
    if (!file) return file.error();
    std::vector<std::byte> bytes(player.good_bytes());
    if (Result<void> read = (*file).read(0, bytes); !read) return read.error();
    return bytes;
}

Result<void> write_page(const record::Player& player, const std::string& name) {
    const Result<std::vector<std::byte>> recording = good_bytes(player);
    if (!recording) return recording.error();
    const Result<std::string> page = self_contained_page(*recording);
    if (!page) return page.error();
    if (Interrupts::signal() != 0) return Error{Status::Io, name, "interrupted", {}};
    if (Result<void> made = make_folder_of(name); !made) return made;
    return write_file(name, std::as_bytes(std::span(*page)));
}

Result<void> write_glb(record::Player& player, const std::string& name) {
    const Result<std::vector<std::byte>> glb = record::export_glb(player);
    if (!glb) return glb.error();
    if (Interrupts::signal() != 0) return Error{Status::Io, name, "interrupted", {}};
    if (Result<void> made = make_folder_of(name); !made) return made;
    return write_file(name, *glb);
}

/// Waits for a signal; returns its number.
int wait_for_signal(const sigset_t& signals) {
    int signal = 0;
    while (sigwait(&signals, &signal) != 0) {
    }
    return signal;
}

int serve(const record::Player& player, const ViewOptions& options) {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    struct sigaction hang_up {};
    const bool ignored = ::sigaction(SIGHUP, nullptr, &hang_up) == 0 && hang_up.sa_handler == SIG_IGN;  // nohup
    if (!ignored) sigaddset(&signals, SIGHUP);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    Result<ViewServer> server = ViewServer::listen(options.file, options.port);
    if (!server) return refuse(server.error());
    std::thread server_thread([&] { (*server).run(); });
    fmt::print("{}: {} frames, {} bodies\nhttp://127.0.0.1:{}/   (Ctrl-C ends)\n", printable(player.path()),
               player.frames(), player.tables().bodies.size(), (*server).port());
    std::fflush(stdout);
    const int signal = wait_for_signal(signals);
    (*server).stop();
    server_thread.join();
    return 128 + signal;
}

/// Writes the page and the animation that the options ask for.
int write_files(record::Player& player, const ViewOptions& options) {
    const Interrupts interrupts("interrupted: nothing is written");
    const auto write = [&](const std::string& name, const auto& write_to) {
        if (name.empty()) return exit_ok;
        const Result<void> written = write_to(player, name);
        if (!written && Interrupts::signal() != 0) return refuse_interrupted(name);
        if (!written) return refuse(written.error());
        fmt::print("{}\n", printable(name));
        return Interrupts::signal() == 0 ? exit_ok : 128 + Interrupts::signal();
    };
    const int code = write(options.html, write_page);
    return code == exit_ok ? write(options.glb, write_glb) : code;
}

}  // namespace

int run_view(const ViewOptions& options) {
    if (Result<void> checked = check_outputs(options, options.file); !checked) return refuse(checked.error());
    if (Result<void> checked = check_recording(options.file); !checked) return refuse(checked.error());
    Result<record::Player> player = record::Player::open(options.file);
    if (!player) return refuse(player.error());
    if (Result<void> has_frames = (*player).check_has_frames(); !has_frames) return refuse(has_frames.error());
    if (!(*player).lost().empty()) warn((*player).path() + ": " + (*player).lost());
    std::error_code ignored;
    if ((*player).path() == options.file && std::filesystem::exists(options.file + ".part", ignored)) {
        warn(options.file + ".part: exists too, from a recording that is running or was never finished");
    }
    if (Result<void> checked = check_outputs(options, (*player).path()); !checked) return refuse(checked.error());
    if (!options.html.empty() || !options.glb.empty()) return write_files(*player, options);
    return serve(*player, options);
}

void add_view(Command& program, CommandRegistry& registry) {
    auto& view = registry.options<ViewOptions>();
    Command command = program.add_command("view", "Show a recording in the browser");
    command.add_text("FILE", "A recording of 'fase run --record'", view.file).required();
    const Option html = command.add_text("--html", "Write one self-contained page instead of serving", view.html);
    const Option glb = command.add_text("--glb", "Write the motion as a glTF animation instead of serving", view.glb);
    Option port =
        command.add_whole_number("--port", "Serve on 127.0.0.1:N (default: any free port)", 0, 65535, view.port);
    port.excludes(html);
    port.excludes(glb);
    command.set_footer(
        "\nExamples:\n"
        "  fase view castle.faserec\n"
        "  fase view castle.faserec --html castle.html\n"
        "  fase view castle.faserec --glb castle_animation.glb");
    registry.on(command, [&view] { return run_view(view); });
}

}  // namespace fase::cli
