/// Chooses the cell sizes, the levels and the row axis of a row grid from a sample.
#include <algorithm>
#include <cmath>

#include "fase/broad/boxes/box_store.hpp"
#include "fase/broad/row_grid/set.hpp"

namespace fase::broad {
namespace {

using Range = RowSample::Range;

/// Max number of sampled boxes for percentiles, which take most of the time.
constexpr std::size_t max_ranked = 256;

/// Returns the quantile of the values. Reorders them.
float quantile(std::vector<float>& values, double share) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

/// Returns the range of the values without the outermost 64th on either side, plus a margin: one distant box does not
/// stretch the grid. The margin ends close to the lowest and highest value.
Range main_range(std::vector<float>& some, float lowest, float highest) {
    const double out = some.size() < 192 ? 0 : 1.0 / 64;
    const float from = quantile(some, out), to = quantile(some, 1 - out), margin = (to - from) / 16;
    const float begin = std::max(lowest - margin / 4, from - margin), end = std::min(highest + margin / 4, to + margin);
    return {begin, end - begin};
}

/// Returns the share of occupied cells of a coarse grid with one cell per sampled box, relative to evenly spread boxes.
float occupied_share(RowSample& sample, std::array<bool, 3> wide) {
    const std::vector<std::array<float, 3>>& corners = sample.corners;
    const int dimensions = int{wide[0]} + int{wide[1]} + int{wide[2]};
    if (corners.size() < 256 || dimensions == 0) return 1;
    std::size_t side = 1;
    const auto power = [&](std::size_t s) { return dimensions == 1 ? s : dimensions == 2 ? s * s : s * s * s; };
    while (power(side + 1) <= corners.size()) ++side;
    std::vector<std::uint8_t>& occupied = sample.occupied;
    occupied.assign(power(side), 0);
    std::size_t places = 0;
    for (const std::array<float, 3>& corner : corners) {
        std::size_t at = 0;
        for (std::size_t a = 0; a < 3; ++a) {
            if (!wide[a]) continue;
            const float t = (corner[a] - sample.ranges[a].from) / sample.ranges[a].length;
            const auto k = static_cast<std::size_t>(std::clamp(t, 0.0f, 1.0f) * static_cast<float>(side));
            at = at * side + std::min(k, side - 1);
        }
        places += occupied[at] != 0 ? 0 : 1;
        occupied[at] = 1;
    }
    constexpr double filled_by_chance = 0.632;  // 1 - 1/e
    return static_cast<float>(
        std::min(1.0, static_cast<double>(places) / (filled_by_chance * static_cast<double>(occupied.size()))));
}

template <class Row> void take_sample(std::span<const Row> boxes, std::size_t max_count, RowSample& sample) {
    sample.boxes = boxes.size();
    sample.sides.clear();
    sample.corners.clear();
    const std::size_t count = std::min(boxes.size(), max_count);
    for (std::size_t i = 0; i < count; ++i) {
        const Aabb& box = box_of(boxes[i * boxes.size() / count]);
        if (!is_regular(box)) continue;  // build() detects it later
        sample.sides.push_back(longest_side(box));
        sample.corners.push_back({box.lo.x, box.lo.y, box.lo.z});
    }
    if (sample.sides.empty()) return;
    const std::size_t step = (sample.sides.size() + max_ranked - 1) / max_ranked;
    std::vector<float>& some = sample.some;
    some.clear();
    for (std::size_t i = 0; i < sample.sides.size(); i += step) some.push_back(sample.sides[i]);
    sample.max_sides = quantile(some, 0.98);
    sample.many_sides = quantile(some, 0.8);
    std::array<bool, 3> wide{};
    for (std::size_t a = 0; a < 3; ++a) {
        float lowest = sample.corners[0][a], highest = lowest;
        for (const std::array<float, 3>& corner : sample.corners) {
            lowest = std::min(lowest, corner[a]);
            highest = std::max(highest, corner[a]);
        }
        some.clear();
        for (std::size_t i = 0; i < sample.corners.size(); i += step) some.push_back(sample.corners[i][a]);
        sample.ranges[a] = main_range(some, lowest, highest);
        wide[a] = sample.ranges[a].length > 4 * sample.max_sides;
    }
    sample.occupied_share = occupied_share(sample, wide);
}

/// Returns the mean distance of `count` boxes that fill the ranges, without those shorter than 4 `side`; 0 without
/// ranges.
double spacing_of(const RowSample& sample, double count, float side) {
    double volume = 1;
    int dimensions = 0;
    for (const Range& range : sample.ranges) {
        if (!(range.length > 4 * side)) continue;
        volume *= double{range.length};
        ++dimensions;
    }
    const double each = volume / count;
    return dimensions == 0 ? 0 : dimensions == 1 ? each : dimensions == 2 ? std::sqrt(each) : std::cbrt(each);
}

/// Divides the level into cells: rows `edge` metres apart, `along` cells along a row per `edge`. If that gives more
/// than `max_cells` cells, it uses fewer along a row, then a larger edge.
void divide(RowLevel& level, const RowSample& sample, const std::array<int, 3>& axis, double edge, double along,
            double max_cells) {
    const double min_along = std::min(along, 2.5);
    const auto length = [&](std::size_t k) { return double{sample.ranges[static_cast<std::size_t>(axis[k])].length}; };
    std::array<double, 3> counts{};
    for (;; edge *= 1.0625) {
        double rows = 1;
        for (const std::size_t k : {1u, 2u}) {
            double& count = counts[static_cast<std::size_t>(axis[k])] = std::floor(length(k) / edge) + 1;
            if (count <= 2) count = 1;
            rows *= count;
        }
        const double edges = length(0) / edge;
        if ((std::floor(edges * min_along) + 1) * rows > max_cells) continue;
        if (edges > 0) along = std::max(min_along, std::min(along, (max_cells / rows - 1) / edges));
        counts[static_cast<std::size_t>(axis[0])] = std::floor(edges * along) + 1;
        break;
    }
    for (std::size_t a = 0; a < 3; ++a) {
        level.origin[a] = sample.ranges[a].from;
        level.last[a] = static_cast<float>(counts[a] - 1);
        level.per_cell[a] = counts[a] > 1 ? static_cast<float>((static_cast<int>(a) == axis[0] ? along : 1) / edge) : 0;
    }
    const auto at = [&](int k) { return static_cast<std::size_t>(axis[static_cast<std::size_t>(k)]); };
    level.stride[at(0)] = 1;
    level.stride[at(2)] = static_cast<std::uint32_t>(counts[at(0)]);
    level.stride[at(1)] = static_cast<std::uint32_t>(counts[at(0)] * counts[at(2)]);
}

/// Returns the order of the axes: rows run along x, or along an axis that is clearly longer.
std::array<int, 3> axes_for(const RowSample& sample) {
    int longest = 0;
    for (int a = 1; a < 3; ++a)
        if (sample.ranges[static_cast<std::size_t>(a)].length >
            1.5f * sample.ranges[static_cast<std::size_t>(longest)].length)
            longest = a;
    return {longest, (longest + 1) % 3, (longest + 2) % 3};
}

/// The parameters of lay_out().
struct Layout {
    double cells_per_box = 0;
    double occupied = 1;   ///< occupied share of the space
    bool by_list = false;  ///< lists the rows
};

bool is_sparse(const RowSample& sample) {
    return spacing_of(sample, static_cast<double>(sample.boxes), sample.max_sides) > 2 * double{sample.max_sides};
}

/// Lays out all levels except the last, which takes boxes larger than all sampled ones.
void lay_out(const RowGridSettings& settings, const RowSample& sample, const Layout& layout, RowFit& fit) {
    fit.levels.clear();
    // The finest level takes most boxes. Where boxes are sparse, cells with one box each are small enough.
    const double max_sides = sample.max_sides, many_sides = sample.many_sides;
    const auto spacing = [&](double count, float side) { return spacing_of(sample, count / layout.occupied, side); };
    const double all_spacing = spacing(static_cast<double>(sample.boxes), sample.max_sides);
    // Boxes on a plane have only one neighbour row each: larger cells let fewer of them reach into it.
    const auto wide = std::count_if(sample.ranges.begin(), sample.ranges.end(),
                                    [&](const Range& range) { return range.length > 4 * max_sides; });
    const double share = settings.side_share * (wide < 3 ? 1.25 : 1);
    double cell =
        std::max(std::min(share * max_sides, std::max(2 * all_spacing, many_sides)), layout.by_list ? 0 : all_spacing);
    if (settings.cell > 0) cell = settings.cell;
    if (!(cell > 1e-30)) cell = 1;

    std::size_t below = 0;  // number of sampled boxes in the levels so far
    for (double limit = cell; below < sample.sides.size(); limit *= std::max(settings.level_ratio, 1.5f)) {
        const auto within = static_cast<std::size_t>(
            std::count_if(sample.sides.begin(), sample.sides.end(),
                          [max_side = static_cast<float>(limit)](float side) { return side <= max_side; }));
        if (within == below) continue;
        const double count = static_cast<double>(within - below) * static_cast<double>(sample.boxes) /
                             static_cast<double>(sample.sides.size());
        below = within;
        RowLevel level;
        level.limit = static_cast<float>(limit);
        if (layout.by_list) {
            level.listed = true;
            level.edge = limit * (1 + 0x1p-10);
            for (std::size_t a = 0; a < 3; ++a) level.origin[a] = sample.ranges[a].from;
        } else {
            const double max_cells = std::min(layout.cells_per_box * count + 64, 0x1p22);
            // A margin for the rounding errors of cell(): 2^-22 of a cell for each of some thousand rows.
            const double edge = std::max(limit, spacing(count, static_cast<float>(limit))) * (1 + 0x1p-9);
            divide(level, sample, fit.axis, edge, std::max(settings.cells_along, 0.01f), max_cells);
        }
        fit.levels.push_back(level);
    }
}

/// Returns the mean number of other boxes of its level in the cube of a box: consecutive cells of a row, as long as the
/// distance of the rows. The time of a search is proportional to it.
double crowding(RowSample& sample, const RowFit& fit) {
    const std::size_t step = (sample.corners.size() + max_ranked - 1) / max_ranked;
    std::vector<std::uint64_t>& cubes = sample.cubes;
    cubes.clear();
    for (std::size_t i = 0; i < sample.corners.size(); i += step) {
        std::size_t k = 0;
        while (k + 1 < fit.levels.size() && !(sample.sides[i] <= fit.levels[k].limit)) ++k;
        const RowLevel& level = fit.levels[k];
        std::uint64_t cube = k;
        for (const int axis : {fit.axis[1], fit.axis[2], fit.axis[0]}) {
            const auto a = static_cast<std::size_t>(axis);
            const float edges = axis == fit.axis[0] ? level.limit * level.per_cell[a] : 1;
            const auto cell = static_cast<float>(level.cell(axis, sample.corners[i][a]));
            cube = cube << 20 | static_cast<std::uint64_t>(cell / std::max(edges, 1.0f));
        }
        cubes.push_back(cube);
    }
    std::sort(cubes.begin(), cubes.end());
    double together = 0;
    for (auto from = cubes.begin(); from != cubes.end();) {
        const auto to = std::upper_bound(from, cubes.end(), *from);
        const auto count = static_cast<double>(to - from);
        together += count * (count - 1);
        from = to;
    }
    const auto seen = static_cast<double>(cubes.size());
    return together / (seen * seen) * static_cast<double>(sample.boxes);
}

/// Chooses a table, unless most of its cells would be empty and the others too full.
void add_levels(const RowGridSettings& settings, RowSample& sample, RowFit& fit) {
    using Rows = RowGridSettings::Rows;
    fit.axis = axes_for(sample);
    const Layout table{.cells_per_box = settings.cells_per_box};
    lay_out(settings, sample, settings.rows == Rows::List ? Layout{.by_list = true} : table, fit);
    if (settings.rows == Rows::List || sample.occupied_share > 0.5f) return;

    // Measured per box: a table takes 12 ns, plus 0.2 ns per other box in the cube; a table of five times as many cells
    // takes 1 ns more, but only 0.1 ns per other box; listed rows take 50 to 80 ns.
    constexpr double crowded = 16, too_crowded = 500;
    double crowd = crowding(sample, fit);
    if (crowd <= crowded) return;
    lay_out(settings, sample, {.cells_per_box = 5 * settings.cells_per_box, .occupied = sample.occupied_share}, fit);
    const double finer = crowding(sample, fit);
    if (finer > 0.7 * crowd) {
        lay_out(settings, sample, table, fit);
    } else {
        crowd = finer;
    }
    if (settings.rows == Rows::Chosen && crowd > too_crowded && is_sparse(sample))
        lay_out(settings, sample, {.by_list = true}, fit);
}

template <class Row>
void fit_rows_to(std::span<const Row> boxes, const RowGridSettings& settings, RowSample& sample, RowFit& fit) {
    fit.levels.clear();
    fit.table = 0;
    if (boxes.empty()) return;
    take_sample(boxes, std::max(settings.sample, 1u), sample);
    if (!sample.sides.empty()) add_levels(settings, sample, fit);
    RowLevel rest;
    rest.limit = Aabb::infinity;
    fit.levels.push_back(rest);
    for (RowLevel& level : fit.levels) {
        for (std::size_t a = 0; a < 3; ++a) level.stride[a] = std::max(level.stride[a], 1u);
        level.table = fit.table;
        fit.table += level.cells() + 1;
    }
}

}  // namespace

void fit_rows(std::span<const Move> boxes, const RowGridSettings& settings, RowSample& sample, RowFit& fit) {
    fit_rows_to(boxes, settings, sample, fit);
}
void fit_rows(std::span<const Aabb> boxes, const RowGridSettings& settings, RowSample& sample, RowFit& fit) {
    fit_rows_to(boxes, settings, sample, fit);
}

}  // namespace fase::broad
