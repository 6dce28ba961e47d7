/// The program `fase`: parses the command line and runs the command that it names.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>

#include "cli/atlas.hpp"
#include "cli/bench/bench.hpp"
#include "cli/check.hpp"
#include "cli/common/arguments.hpp"
#include "cli/common/command_registry.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/output.hpp"
#include "cli/distance.hpp"
#include "cli/draw.hpp"
#include "cli/generate.hpp"
#include "cli/impact.hpp"
#include "cli/info.hpp"
#include "cli/level/level.hpp"
#include "cli/pairs.hpp"
#include "cli/query.hpp"
#include "cli/run.hpp"
#include "cli/view/view.hpp"
#include "fase/core/version.hpp"

namespace fase::cli {
namespace {

int run_program(int count, char** arguments) {
    CommandRegistry registry;
    CommandLine line("fase", "Collision detection and rigid-body physics: simulate, record, view, measure.",
                     fmt::format("fase {}", library_version()));
    Command program = line.root();
    program.require_command();
    program.set_footer(
        "\nFirst steps:\n"
        "  fase generate castle -o castle.glb\n"
        "  fase run castle.glb --seconds 12 --record castle.faserec\n"
        "  fase view castle.faserec\n"
        "\nAn argument that begins with '-' but is not an option follows '--' or '='.\n"
        "Exit codes: 0 success, 1 a check failed, 2 bad input, 3 a file error, 4 a limit, 70 an internal error, 130 "
        "Ctrl-C.");
    add_run(program, registry);
    add_view(program, registry);
    add_info(program, registry);
    add_generate(program, registry);
    add_distance(program, registry);
    add_impact(program, registry);
    add_draw(program, registry);
    add_pairs(program, registry);
    add_query(program, registry);
    add_atlas(program, registry);
    add_level(program, registry);
    add_bench(program, registry);
    add_check(program, registry);
    if (const std::optional<int> code = line.parse(count, arguments)) return *code;
    return registry.run();
}

}  // namespace
}  // namespace fase::cli

int main(int count, char** arguments) {
    namespace cli = fase::cli;
    cli::guard_standard_streams();
    cli::remove_temporary_files_on_signals();
    int code = cli::exit_bug;
    try {
        code = cli::run_program(count, arguments);
    } catch (const std::bad_alloc&) {
        code = cli::refuse({fase::Status::NoMemory, "fase", "found too little memory", {}});
    } catch (const std::exception& error) {
        std::fputs(("fase: error: internal error: " + cli::printable(error.what()) + "\n").c_str(), stderr);
    }
    return cli::finish_output(code);
}
