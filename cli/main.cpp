/// The program `fase`: takes the command line apart and starts the command it names.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>

#include "cli/atlas.hpp"
#include "cli/common/arguments.hpp"
#include "cli/common/output.hpp"
#include "cli/common/start.hpp"
#include "cli/distance.hpp"
#include "cli/draw.hpp"
#include "cli/generate.hpp"
#include "cli/info.hpp"
#include "cli/level/level.hpp"
#include "cli/pairs.hpp"
#include "cli/query.hpp"
#include "cli/run.hpp"
#include "cli/view/view.hpp"
#include "fase/core/version.hpp"
#ifdef HAS_FASE_BENCH
#include "cli/bench/pairs.hpp"
#include "cli/bench/queries.hpp"
#include "cli/bench/step.hpp"
#include "cli/bench/sudden.hpp"
#endif

namespace fase::cli {
namespace {

#ifdef HAS_FASE_BENCH
void add_bench(CLI::App& app, Start& start) {
    CLI::App& group = *app.add_subcommand("bench", "Measure, beside other engines");
    group.require_subcommand(1);
    add_bench_step(group, start);
    add_bench_pairs(group, start);
    add_bench_queries(group, start);
    add_bench_sudden(group, start);
}
#endif

int run_program(int count, char** arguments) {
    Start start;
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
    add_run(app, start);
    add_view(app, start);
    add_info(app, start);
    add_generate(app, start);
    add_distance(app, start);
    add_draw(app, start);
    add_pairs(app, start);
    add_query(app, start);
    add_atlas(app, start);
    add_level(app, start);
#ifdef HAS_FASE_BENCH
    add_bench(app, start);
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
    return start();
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
