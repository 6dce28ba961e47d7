/// What `--structure` of the measuring commands can mean: one, the automatic choice, or all.
#include "cli/common/structure_choice.hpp"

#include <fmt/format.h>

#include "cli/common/output.hpp"

namespace fase::cli {

Result<std::vector<StructureChoice>> structures_named(const std::string& option) {
    std::vector<StructureChoice> choices;
    const auto add = [&](const std::string& asked, broad::AnyStructure empty) {
        const std::string chosen(empty.info().name);
        choices.push_back({asked, chosen, std::move(empty)});
    };
    if (option == "auto") {
        add(option, {});
    } else if (option == "all") {
        broad::for_each_structure([&]<broad::Structure S>() {
            const std::string name(S::info.name);
            if (auto structure = broad::AnyStructure::named(name)) add(name, *std::move(structure));
        });
    } else if (auto structure = broad::AnyStructure::named(option)) {
        add(option, *std::move(structure));
    } else {
        return Error{Status::BadArgument,
                     "--structure",
                     fmt::format("found \"{}\", need auto, all or one of {}", printable(option, 60),
                                 broad::AnyStructure::names()),
                     {}};
    }
    return choices;
}

}  // namespace fase::cli
