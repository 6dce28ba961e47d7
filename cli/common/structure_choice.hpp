#pragma once
/// What `--structure` of the measuring commands can mean: one, the automatic choice, or all.
#include <string>
#include <vector>

#include "fase/broad/any_structure.hpp"
#include "fase/core/result.hpp"

namespace fase::cli {

/// One structure that is to be measured.
struct StructureChoice {
    std::string asked;   ///< a structure's name, or "auto"
    std::string chosen;  ///< the name of the structure that it is
    broad::AnyStructure empty;
};

/// "auto", "all" (each of the registry, in its order) or a name. BadArgument with all names for anything else.
Result<std::vector<StructureChoice>> structures_named(const std::string& option);

}  // namespace fase::cli
