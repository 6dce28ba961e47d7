/// The program `fase`: takes the command line apart and starts the command it names.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <functional>
#include <new>

#include "cli/arguments.hpp"
#include "cli/distance.hpp"
#include "cli/generate.hpp"
#include "cli/info.hpp"
#include "cli/output.hpp"
#include "cli/run.hpp"
#include "cli/view.hpp"
#include "fase/broad/any_structure.hpp"
#include "fase/core/version.hpp"
#include "fase/scene/generate.hpp"
#ifdef HAS_FASE_BENCH
#include "cli/bench_step.hpp"
#endif

namespace fase::cli {
namespace {

/// What the command line asks for.
struct Request {
    RunOptions run;
    ViewOptions view;
    InfoOptions info;
    GenerateOptions generate;
    DistanceOptions distance;
#ifdef HAS_FASE_BENCH
    BenchStepOptions bench_step;
#endif
    std::function<int()> start;
};

constexpr std::uint64_t most_bodies = 1'000'000, most_threads = 1024;
constexpr double most_seconds = 1e9;

void add_run(CLI::App& app, Request& request) {
    RunOptions& run = request.run;
    CLI::App& command = *app.add_subcommand("run", "Simulate a scene; tell how it went; record it");
    add_text(command, "SCENE", "A .gltf or .glb file, or a kind of 'fase generate'", run.scene)->required();
    CLI::Option* seconds = add_positive_number(command, "--seconds", "Simulated time (default 10)", most_seconds,
                                               [&run](double value) { run.seconds = value; });
    add_whole_number(command, "--steps", "Steps, instead of seconds", 0, most_steps, [&run](std::uint64_t value) {
        run.steps = value;
    })->excludes(seconds);
    add_text(command, "--structure", "Broad phase: auto (default), " + broad::AnyStructure::names(), run.structure);
    add_whole_number(command, "--threads", "0 (default): all cores; the result is the same for any", 0, most_threads,
                     [&run](std::uint64_t value) { run.threads = static_cast<int>(value); });
    add_positive_number(command, "--dt", "Seconds a step (default: the scene's, else 1/60)", 1,
                        [&run](double value) { run.time_step = value; });
    add_whole_number(command, "--sub-steps", "Solver's steps in a step (default: the scene's, else 4)", 1, 64,
                     [&run](std::uint64_t value) { run.sub_steps = static_cast<int>(value); });
    command.add_flag("--no-sleep", run.keep_awake, "Nothing falls asleep");
    add_whole_number(command, "--count", "Of a kind: bodies, roughly", 1, most_bodies,
                     [&run](std::uint64_t value) { run.count = value; });
    add_whole_number(command, "--seed", "Of a kind: another one of it", 0, ~0ull,
                     [&run](std::uint64_t value) { run.seed = value; });
    CLI::Option* record = add_text(command, "--record", "Write a recording for 'fase view'", run.record);
    command.add_flag("--contacts", run.record_contacts, "Record all contact points too")->needs(record);
    command.add_flag("--durable", run.durable, "Force each block of the recording to the disk (power loss)")
        ->needs(record);
    command.add_flag("--json", run.json, "Print one JSON object");
    command.footer(
        "\nExamples:\n"
        "  fase run castle --seconds 12 --record castle.faserec\n"
        "  fase run scene.glb --steps 600 --threads 4 --json\n"
        "  fase run pile --count 500 --structure brute_force\n"
        "\nCtrl-C ends the run after the step in hand; what is recorded so far is kept.");
    command.callback([&request] { request.start = [&request] { return run_scene(request.run); }; });
}

void add_view(CLI::App& app, Request& request) {
    ViewOptions& view = request.view;
    CLI::App& command = *app.add_subcommand("view", "Show a recording in the browser");
    add_text(command, "FILE", "A recording of 'fase run --record'", view.file)->required();
    add_text(command, "--html", "Write one self-contained page instead of serving", view.html);
    add_text(command, "--glb", "Write the motion as a glTF animation instead of serving", view.glb);
    add_whole_number(command, "--port", "Serve on 127.0.0.1:N (default: any free one)", 0, 65535,
                     [&view](std::uint64_t value) { view.port = static_cast<int>(value); });
    command.footer(
        "\nExamples:\n"
        "  fase view castle.faserec\n"
        "  fase view castle.faserec --html castle.html\n"
        "  fase view castle.faserec --glb castle_animation.glb");
    command.callback([&request] {
        request.start = [&request] {
            for (const std::string* out : {&request.view.html, &request.view.glb}) {
                if (out->empty()) continue;
                if (auto writable = check_output(*out, request.view.file); !writable) return refuse(writable.error());
            }
            return run_view(request.view);
        };
    });
}

void add_info(CLI::App& app, Request& request) {
    CLI::App& command = *app.add_subcommand("info", "Say what a file is and what is in it");
    add_text(command, "FILE", "A scene or a recording", request.info.file)->required();
    command.add_flag("--json", request.info.json, "Print one JSON object");
    command.footer("\nExamples:\n  fase info scene.glb\n  fase info castle.faserec --json");
    command.callback([&request] { request.start = [&request] { return run_info(request.info); }; });
}

void add_generate(CLI::App& app, Request& request) {
    GenerateOptions& generate = request.generate;
    CLI::App& command = *app.add_subcommand("generate", "Write a scene made by rule");
    add_text(command, "KIND", "What to make, see below", generate.kind)->required();
    add_whole_number(command, "--count", "Bodies, roughly", 1, most_bodies,
                     [&generate](std::uint64_t value) { generate.count = value; });
    add_whole_number(command, "--seed", "Another one of the kind (default 1)", 0, ~0ull,
                     [&generate](std::uint64_t value) { generate.seed = value; });
    add_text(command, "-o,--output", "The .glb or .gltf file to write", generate.output)->required();
    command.footer("\nKinds:\n" + generate_kinds() +
                   "\nExamples:\n"
                   "  fase generate castle -o castle.glb\n"
                   "  fase generate pile --count 500 --seed 7 -o pile.gltf");
    command.callback([&request] {
        request.start = [&request] {
            if (auto writable = check_output(request.generate.output); !writable) return refuse(writable.error());
            return run_generate(request.generate);
        };
    });
}

void add_distance(CLI::App& app, Request& request) {
    CLI::App& command = *app.add_subcommand("distance", "Hold distances of pairs of shapes against published ones");
    add_text(command, "PAIRS.json", "Pairs with the distances they should have", request.distance.file)->required();
    command.add_flag("--json", request.distance.json, "Print one JSON object");
    command.footer("\nExample:\n  fase distance pairs.json\n\nExit code 1: a distance is wrong.");
    command.callback([&request] { request.start = [&request] { return run_distance(request.distance); }; });
}

#ifdef HAS_FASE_BENCH
void add_bench(CLI::App& app, Request& request) {
    BenchStepOptions& bench = request.bench_step;
    CLI::App& group = *app.add_subcommand("bench", "Measure, beside other engines");
    group.require_subcommand(1);
    CLI::App& command = *group.add_subcommand("step", "Time whole steps of benchmark scenes");
    add_text(command, "--scene", "One of " + bench_scene_names() + " (default: all)", bench.scene);
    add_text(command, "--engine", "all (default), or some of " + bench_engine_names() + ", commas between",
             bench.engine);
    add_whole_number(command, "--threads", "For engines that have threads (default 1)", 1, most_threads,
                     [&bench](std::uint64_t value) { bench.threads = static_cast<int>(value); });
    add_whole_number(command, "--steps", "Steps (default: the scene's)", 1, 100000,
                     [&bench](std::uint64_t value) { bench.steps = value; });
    add_whole_number(command, "--rounds", "How often it is all done (default 3)", 1, 1000,
                     [&bench](std::uint64_t value) { bench.rounds = static_cast<int>(value); });
    add_whole_number(command, "--count", "Bodies, roughly (default: the scene's)", 1, most_bodies,
                     [&bench](std::uint64_t value) { bench.count = value; });
    add_text(command, "--csv", "Add the rows to this table", bench.csv);
    command.add_flag("--json", bench.json, "Print one JSON array");
    command.footer(
        "\nExamples:\n"
        "  fase bench step --scene large_pyramid\n"
        "  fase bench step --engine fase --threads 4 --json\n"
        "\nEngines take turns in one run, a few steps each, so that a noisy machine is noisy for all.\n"
        "Exit code 1: the rounds of an engine that is deterministic ended in different states.");
    command.callback([&request] {
        request.start = [&request] {
            if (!request.bench_step.csv.empty()) {
                if (auto writable = check_output(request.bench_step.csv); !writable) return refuse(writable.error());
            }
            return run_bench_step(request.bench_step);
        };
    });
}
#endif

int run_program(int count, char** arguments) {
    Request request;
    CLI::App app("Collision detection and rigid-body physics: simulate, record, look, measure.", "fase");
    app.set_version_flag("--version", fmt::format("fase {}", library_version()));
    app.require_subcommand(1);
    app.footer(
        "\nA first look:\n"
        "  fase generate castle -o castle.glb\n"
        "  fase run castle.glb --seconds 12 --record castle.faserec\n"
        "  fase view castle.faserec\n"
        "\nAn argument that begins with '-' but is no option goes behind '--' or '='.\n"
        "Exit codes: 0 done, 1 a check failed, 2 bad input, 3 a file failed, 4 a limit, 70 a mistake of ours, 130 "
        "Ctrl-C.");
    add_run(app, request);
    add_view(app, request);
    add_info(app, request);
    add_generate(app, request);
    add_distance(app, request);
#ifdef HAS_FASE_BENCH
    add_bench(app, request);
#endif
    try {
        app.parse(count, arguments);
    } catch (const CLI::Success& help) {
        app.exit(help);  // prints help or version on stdout
        return exit_ok;
    } catch (const CLI::ParseError& error) {
        const std::string line = usage_problem(app, error);
        std::fwrite(line.data(), 1, line.size(), stderr);
        return exit_bad_input;
    }
    return request.start();
}

}  // namespace
}  // namespace fase::cli

int main(int count, char** arguments) {
    namespace cli = fase::cli;
    cli::guard_standard_streams();
    int code = cli::exit_bug;
    try {
        code = cli::run_program(count, arguments);
    } catch (const std::bad_alloc&) {
        code = cli::refuse({fase::Status::NoMemory, "fase", "found too little memory", {}});
    } catch (const std::exception& error) {
        std::fputs(("fase: error: mistake of ours: " + cli::printable(error.what()) + "\n").c_str(), stderr);
    }
    return cli::finish_output(code);
}
