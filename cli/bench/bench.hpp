#pragma once
/// The command `fase bench`, and what stands for it in a program without benchmarks.

namespace fase::cli {

class Command;
class CommandRegistry;

/// Adds the command, with one command per benchmark below it (bench.cpp). Without FASE_BUILD_BENCH (none.cpp) it only
/// tells how to build them, and exits with 2.
void add_bench(Command& program, CommandRegistry& registry);

}  // namespace fase::cli
