/// The option `--structure`: one structure, the automatic choice, or all.
#include "cli/common/structure_choice.hpp"

#include <fmt/format.h>

#include "cli/common/output.hpp"
#include "fase/broad/registry.hpp"

namespace fase::cli {

Option add_structure(Command& command, const std::string& help, std::string& structure) {
    return command.add_text("--structure", help + broad::AnyStructure::names(), structure);
}

Result<std::vector<StructureChoice>> structures_named(const std::string& option) {
    std::vector<StructureChoice> choices;
    const auto add = [&](const std::string& requested, broad::AnyStructure empty) {
        const std::string chosen(empty.info().name);
        choices.push_back({requested, chosen, std::move(empty)});
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
                     fmt::format("found \"{}\"; expected auto, all or one of {}", printable(option, 60),
                                 broad::AnyStructure::names()),
                     {}};
    }
    return choices;
}

}  // namespace fase::cli
