#pragma once
/// The command `fase info`: prints the kind and the contents of a file.
#include <string>

namespace fase::cli {

class Command;
class CommandRegistry;

struct InfoOptions {
    std::string file;   ///< any kind that Fase reads; the content decides
    bool json = false;  ///< one JSON value on stdout instead of lines
};

/// Prints the kind, counts, extensions and warnings. Returns the exit code: 0; 2 the file has an unknown format or is
/// damaged; 3 it cannot be opened; 4 too little memory.
int run_info(const InfoOptions& options);

/// Adds the command to the program.
void add_info(Command& program, CommandRegistry& registry);

}  // namespace fase::cli
