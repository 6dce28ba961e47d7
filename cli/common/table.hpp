#pragma once
/// Aligned columns for people.
#include <string>
#include <utility>
#include <vector>

namespace fase::cli {

/// Rows of cells under a heading; the first column stands left, the others right, each as wide as its widest cell.
class Table {
public:
    explicit Table(std::vector<std::string> heading) { lines_.push_back({std::move(heading), {}}); }
    /// As many cells as the heading has.
    void add(std::vector<std::string> cells) { lines_.push_back({std::move(cells), {}}); }
    /// A row that has nothing to show but words.
    void add_note(std::string first, std::string words) { lines_.push_back({{std::move(first)}, std::move(words)}); }

    [[nodiscard]] std::string text() const;

private:
    struct Line {
        std::vector<std::string> cells;
        std::string words;
    };
    std::vector<Line> lines_;
};

}  // namespace fase::cli
