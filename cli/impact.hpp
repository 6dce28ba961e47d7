#pragma once
/// The command `fase impact`: compares times of impact with queries whose answer is known.
#include <string>

namespace fase::cli {

class Command;
class CommandRegistry;

struct ImpactCommandOptions {
    std::string folder;
    bool json = false;  ///< one JSON value on stdout instead of lines
};

/// Answers all queries in the files FOLDER/**/edge-edge/*.csv and FOLDER/**/vertex-face/*.csv, and prints how many of
/// them meet, and how many answers are wrong. A query is eight rows, four points at time 0 and the same at time 1: for
/// edges a0, a1, b0, b1, else the vertex and the corners of the face. A row is x, y and z, each as two integers
/// (numerator, denominator), and 1 or 0: whether they meet. Returns the exit code: 0; 1 a meeting was missed; 2 a file
/// has another format; 3 it cannot be read.
int run_impact(const ImpactCommandOptions& options);

/// Adds the command to the program.
void add_impact(Command& program, CommandRegistry& registry);

}  // namespace fase::cli
