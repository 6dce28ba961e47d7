/// The facts that `fase info` prints about a file: named texts, numbers, lists and counts.
#include "cli/common/facts.hpp"

#include <algorithm>

#include "cli/common/output.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase::cli {

std::string Facts::json() const {
    std::string text = "{";
    for (const Entry& entry : entries_) {
        if (text.size() > 1) text += ", ";
        text += scene::quoted(entry.key) + ": ";
        std::vector<std::string> parts;
        if (const auto* words = std::get_if<std::string>(&entry.value)) {
            text += scene::quoted(*words);
        } else if (const auto* plain = std::get_if<Plain>(&entry.value)) {
            text += plain->text;
        } else if (const auto* list = std::get_if<std::vector<std::string>>(&entry.value)) {
            for (const std::string& one : *list) parts.push_back(scene::quoted(one));
            text += fmt::format("[{}]", fmt::join(parts, ", "));
        } else {
            for (const auto& [name, count] : std::get<Counts>(entry.value))
                parts.push_back(fmt::format("{}: {}", scene::quoted(name), count));
            text += fmt::format("{{{}}}", fmt::join(parts, ", "));
        }
    }
    return text + "}\n";
}

std::string Facts::lines() const {
    std::string text;
    std::vector<Entry> entries = entries_;
    std::stable_partition(entries.begin(), entries.end(), [](const Entry& entry) { return entry.key == "warnings"; });
    for (const Entry& entry : entries) {
        std::string_view key = entry.key;
        const auto line = [&](std::string_view value) {
            text += fmt::format("{:<20} {}\n", std::exchange(key, ""), printable(value));
        };
        if (const auto* words = std::get_if<std::string>(&entry.value)) {
            line(*words);
        } else if (const auto* plain = std::get_if<Plain>(&entry.value)) {
            line(plain->text);
        } else if (const auto* list = std::get_if<std::vector<std::string>>(&entry.value)) {
            for (const std::string& one : *list) line(one);
        } else {
            for (const auto& [name, count] : std::get<Counts>(entry.value)) line(fmt::format("{} {}", count, name));
        }
    }
    return text;
}

}  // namespace fase::cli
