/// The command `fase bench` in a program without benchmarks.
#include "cli/bench/bench.hpp"
#include "cli/common/arguments.hpp"
#include "cli/common/command_registry.hpp"
#include "cli/common/output.hpp"

namespace fase::cli {

void add_bench(Command& program, CommandRegistry& registry) {
    Command group = program.add_command("bench", "Benchmarks: not built in this program");
    group.take_all_arguments();
    registry.on(group, [] {
        return refuse({Status::Unsupported, "fase bench", "this program was built without benchmarks",
                       "build them: cmake -D FASE_BUILD_BENCH=ON build/release && cmake --build build/release"});
    });
}

}  // namespace fase::cli
