/// The program `fase`: parses the command line and runs the command that it names.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>

#include "cli/atlas.hpp"
#include "cli/common/arguments.hpp"
#include "cli/common/command_registry.hpp"
#include "cli/common/output.hpp"
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
#include "cli/check.hpp"
#endif

namespace fase::cli {
namespace {

#ifdef HAS_FASE_BENCH
void add_bench(Command& program, CommandRegistry& registry) {
    Command group = program.add_command("bench", "Run benchmarks of Fase and of other engines");
    group.require_command();
    add_bench_step(group, registry);
    add_bench_pairs(group, registry);
    add_bench_queries(group, registry);
    add_bench_sudden(group, registry);
}
#endif

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
    add_draw(program, registry);
    add_pairs(program, registry);
    add_query(program, registry);
    add_atlas(program, registry);
    add_level(program, registry);
#ifdef HAS_FASE_BENCH
    add_bench(program, registry);
    add_check(program, registry);
#endif
    if (const std::optional<int> code = line.parse(count, arguments)) return *code;
    return registry.run();
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
        std::fputs(("fase: error: internal error: " + cli::printable(error.what()) + "\n").c_str(), stderr);
    }
    return cli::finish_output(code);
}
