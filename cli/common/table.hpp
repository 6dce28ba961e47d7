#pragma once
/// Text tables with aligned columns.
#include <string>
#include <utility>
#include <vector>

namespace fase::cli {

/// Rows of cells under a heading. The first column is left-aligned, the others right-aligned; each is as wide as its
/// widest cell.
class Table {
public:
    explicit Table(std::vector<std::string> heading) { lines_.push_back({std::move(heading), {}}); }
    /// Adds a row; it must have as many cells as the heading.
    void add(std::vector<std::string> cells) { lines_.push_back({std::move(cells), {}}); }
    /// Adds a row with a note instead of figures.
    void add_note(std::string first, std::string note) { lines_.push_back({{std::move(first)}, std::move(note)}); }

    [[nodiscard]] std::string text() const;

private:
    struct Line {
        std::vector<std::string> cells;
        std::string note;
    };
    std::vector<Line> lines_;
};

}  // namespace fase::cli
