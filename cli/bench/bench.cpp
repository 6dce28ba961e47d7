/// The command `fase bench` in a program with benchmarks.
#include "cli/bench/bench.hpp"

#include "cli/bench/index.hpp"
#include "cli/bench/pairs.hpp"
#include "cli/bench/queries.hpp"
#include "cli/bench/step.hpp"
#include "cli/bench/sudden.hpp"
#include "cli/common/arguments.hpp"

namespace fase::cli {

void add_bench(Command& program, CommandRegistry& registry) {
    Command group = program.add_command("bench", "Run benchmarks of Fase and of other engines");
    group.require_command();
    add_bench_step(group, registry);
    add_bench_pairs(group, registry);
    add_bench_queries(group, registry);
    add_bench_sudden(group, registry);
    add_bench_index(group, registry);
}

}  // namespace fase::cli
