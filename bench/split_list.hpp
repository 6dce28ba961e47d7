#pragma once
/// Lists of names in options.
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace fase::bench {

/// Returns the names of a comma-separated list; the empty list has one empty name.
[[nodiscard]] inline std::vector<std::string> split_list(const std::string& list) {
    std::vector<std::string> names;
    for (std::size_t begin = 0; begin <= list.size();) {
        const std::size_t end = std::min(list.find(',', begin), list.size());
        names.push_back(list.substr(begin, end - begin));
        begin = end + 1;
    }
    return names;
}

}  // namespace fase::bench
