#pragma once
/// The option `--structure`: one structure, the automatic choice, or all.
#include <string>
#include <vector>

#include "cli/common/arguments.hpp"
#include "fase/broad/any_structure.hpp"
#include "fase/core/result.hpp"

namespace fase::cli {

/// Adds `--structure NAME`; all names of structures follow `help` in the help text.
Option add_structure(Command& command, const std::string& help, std::string& structure);

/// A structure to measure.
struct StructureChoice {
    std::string requested;  ///< a structure's name, or "auto"
    std::string chosen;     ///< the name of the structure that is used
    broad::AnyStructure empty;
};

/// The structures that `option` names: "auto", "all" (the registry, in its order) or one name. BadArgument for anything
/// else; its message lists all names.
Result<std::vector<StructureChoice>> structures_named(const std::string& option);

}  // namespace fase::cli
