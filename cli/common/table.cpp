/// Text tables with aligned columns.
#include "cli/common/table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fase::cli {

std::string Table::text() const {
    std::vector<std::size_t> widths(lines_[0].cells.size(), 0);
    for (const Line& line : lines_)
        for (std::size_t i = 0; i < line.cells.size(); ++i) widths[i] = std::max(widths[i], line.cells[i].size());
    std::string text;
    for (const Line& line : lines_) {
        for (std::size_t i = 0; i < line.cells.size(); ++i)
            text += i == 0 ? fmt::format("{:<{}}", line.cells[i], widths[i])
                           : fmt::format("  {:>{}}", line.cells[i], widths[i]);
        if (!line.note.empty()) text += "  " + line.note;
        text += '\n';
    }
    return text;
}

}  // namespace fase::cli
