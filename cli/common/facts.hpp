#pragma once
/// The facts that `fase info` prints about a file: named texts, numbers, lists and counts.
#include <fmt/format.h>
#include <cstddef>

#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace fase::cli {

/// Facts in the order of their addition, printed as aligned lines or as one JSON object.
class Facts {
public:
    using Counts = std::map<std::string, std::size_t>;

    void add(std::string key, std::string_view text) { entries_.push_back({std::move(key), std::string(text)}); }
    void add(std::string key, const char* text) { add(std::move(key), std::string_view(text)); }
    void add(std::string key, bool value) { entries_.push_back({std::move(key), Plain{value ? "true" : "false"}}); }
    template <class T>
    requires std::is_arithmetic_v<T>
    void add(std::string key, T number) { entries_.push_back({std::move(key), Plain{fmt::format("{}", number)}}); }
    void add(std::string key, std::vector<std::string> texts) {
        entries_.push_back({std::move(key), std::move(texts)});
    }
    void add(std::string key, Counts counts) { entries_.push_back({std::move(key), std::move(counts)}); }

    [[nodiscard]] std::string json() const;
    /// Safe to print on a terminal; warnings come first, empty lists are omitted.
    [[nodiscard]] std::string lines() const;

private:
    /// A number or a boolean: JSON writes these without quotes.
    struct Plain {
        std::string text;
    };
    struct Entry {
        std::string key;
        std::variant<std::string, Plain, std::vector<std::string>, Counts> value;
    };
    std::vector<Entry> entries_;
};

}  // namespace fase::cli
