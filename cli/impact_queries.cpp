/// Files of queries for times of impact, with known answers.
#include "cli/impact_queries.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

#include "fase/core/detail/files.hpp"
#include "fase/core/detail/text.hpp"

namespace fase::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_query_bytes = std::size_t{1} << 30;
constexpr std::size_t rows_of_query = 8;  // of a query

/// Removes an integer from the beginning of a line, and the comma behind it. nullopt: there is none. Rounded to double:
/// denominators are large powers of two.
std::optional<double> take_integer(std::string_view& line) {
    const std::size_t size = std::min(line.find(','), line.size());
    const std::string_view text = line.substr(0, size);
    line.remove_prefix(std::min(size + 1, line.size()));
    const std::string_view digits = text.substr(text.starts_with('-') ? 1 : 0);
    if (digits.empty() || digits.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

/// One row: a point, and whether the query meets.
struct Row {
    Vec3d point;
    bool meets = false;
};
std::optional<Row> row_of(std::string_view line) {
    Row row;
    for (int axis = 0; axis < 3; ++axis) {
        const std::optional<double> numerator = take_integer(line), denominator = take_integer(line);
        if (!numerator || !denominator || !(*denominator > 0)) return std::nullopt;
        row.point[axis] = *numerator / *denominator;
        if (!std::isfinite(row.point[axis])) return std::nullopt;
    }
    if (line != "0" && line != "1") return std::nullopt;
    row.meets = line == "1";
    return row;
}

Result<std::vector<ImpactQuery>> read_queries(const std::string& path) {
    const auto bytes = read_file(path, max_query_bytes);
    if (!bytes) return bytes.error();
    std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    std::vector<ImpactQuery> queries;
    std::size_t line_number = 0;
    while (!text.empty()) {
        const std::size_t size = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, size);
        text.remove_prefix(std::min(size + 1, text.size()));
        if (line.ends_with('\r')) line.remove_suffix(1);
        const std::size_t row_number = line_number++ % rows_of_query;
        const std::optional<Row> row = row_of(line);
        if (!row)
            return Error{Status::Format,
                         detail::at_line(path, line_number),
                         "found no row of a query; expected x, y and z, each as two integers, and 0 or 1",
                         {}};
        if (row_number == 0) queries.push_back({{}, row->meets});
        if (row->meets != queries.back().meets)
            return Error{Status::Format,
                         detail::at_line(path, line_number),
                         "found another answer than in the row before; expected the same in the eight rows of a query",
                         {}};
        narrow::MovingPoint& point = queries.back().points[row_number % 4];
        (row_number < 4 ? point.begin : point.end) = row->point;
    }
    if (line_number % rows_of_query != 0)
        return Error{
            Status::Format,
            detail::at_line(path, line_number),
            detail::format("found the end after {} rows; expected eight rows a query", line_number % rows_of_query),
            {}};
    return queries;
}

}  // namespace

Result<std::vector<ImpactFile>> read_impact_files(const std::string& folder) {
    std::error_code why;
    if (const fs::file_status status = fs::status(folder, why); fs::exists(status) && !fs::is_directory(status))
        return Error{Status::Format, folder, "found a file; expected a folder with files of queries", {}};
    std::vector<ImpactFile> files;
    fs::recursive_directory_iterator at(folder, why), end;
    for (; !why && at != end; at.increment(why)) {
        const std::string kind = at->path().parent_path().filename().string();
        if (at->path().extension() != ".csv" || (kind != "edge-edge" && kind != "vertex-face")) continue;
        files.push_back({at->path().lexically_relative(folder).generic_string(), kind == "edge-edge", {}});
    }
    if (why) return Error{Status::Io, folder, "cannot read: " + why.message(), {}};
    std::sort(files.begin(), files.end(), [](const ImpactFile& a, const ImpactFile& b) { return a.name < b.name; });
    bool any = false;
    for (ImpactFile& file : files) {
        auto queries = read_queries((fs::path(folder) / file.name).string());
        if (!queries) return queries.error();
        file.queries = *std::move(queries);
        any = any || !file.queries.empty();
    }
    if (!any)
        return Error{
            Status::Format, folder, "found no query; expected files edge-edge/*.csv or vertex-face/*.csv in it", {}};
    return files;
}

}  // namespace fase::cli
