/// How large the cells of a row grid are, how many levels it has and which way its rows run: chosen from a sample.
#include <algorithm>
#include <cmath>

#include "fase/broad/boxes/box_store.hpp"
#include "fase/broad/row_grid/set.hpp"

namespace fase::broad {
namespace {

float longest_side(const Aabb& box) {
    const Vec3 e = extent(box);
    return std::max(e.x, std::max(e.y, e.z));
}

using Range = RowSample::Range;

/// Ranks follow from so many of a sample: to find these takes most of the time.
constexpr std::size_t ranked = 256;

/// The value that a share of them do not exceed. Changes their order.
float value_at(std::vector<float>& values, double share) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

/// All but the outermost in 64 of some values lie in it, with some room beside them: one box far away does not stretch
/// the grid. The room ends not far beyond the lowest and highest of all.
Range main_range(std::vector<float>& some, float lowest, float highest) {
    const double out = some.size() < 192 ? 0 : 1.0 / 64;
    const float from = value_at(some, out), to = value_at(some, 1 - out), room = (to - from) / 16;
    const float least = std::max(lowest - room / 4, from - room), most = std::min(highest + room / 4, to + room);
    return {least, most - least};
}

/// Lays a coarse grid with a cell a box over the sample and counts the cells that are taken.
float share_of_places(RowSample& sample, std::array<bool, 3> wide) {
    const std::vector<std::array<float, 3>>& corners = sample.corners;
    const int dimensions = int{wide[0]} + int{wide[1]} + int{wide[2]};
    if (corners.size() < 256 || dimensions == 0) return 1;
    std::size_t side = 1;
    const auto power = [&](std::size_t s) { return dimensions == 1 ? s : dimensions == 2 ? s * s : s * s * s; };
    while (power(side + 1) <= corners.size()) ++side;
    std::vector<std::uint8_t>& taken = sample.taken;
    taken.assign(power(side), 0);
    std::size_t places = 0;
    for (const std::array<float, 3>& corner : corners) {
        std::size_t at = 0;
        for (std::size_t a = 0; a < 3; ++a) {
            if (!wide[a]) continue;
            const float t = (corner[a] - sample.ranges[a].from) / sample.ranges[a].length;
            const auto k = static_cast<std::size_t>(std::clamp(t, 0.0f, 1.0f) * static_cast<float>(side));
            at = at * side + std::min(k, side - 1);
        }
        places += taken[at] != 0 ? 0 : 1;
        taken[at] = 1;
    }
    constexpr double filled_by_chance = 0.632;  // 1 - 1/e
    return static_cast<float>(
        std::min(1.0, static_cast<double>(places) / (filled_by_chance * static_cast<double>(taken.size()))));
}

template <class Row> void take_sample(std::span<const Row> boxes, std::size_t most, RowSample& sample) {
    sample.boxes = boxes.size();
    sample.sides.clear();
    sample.corners.clear();
    const std::size_t count = std::min(boxes.size(), most);
    for (std::size_t i = 0; i < count; ++i) {
        const Aabb& box = box_of(boxes[i * boxes.size() / count]);
        if (!is_regular(box)) continue;  // this will be noticed later
        sample.sides.push_back(longest_side(box));
        sample.corners.push_back({box.lo.x, box.lo.y, box.lo.z});
    }
    if (sample.sides.empty()) return;
    const std::size_t step = (sample.sides.size() + ranked - 1) / ranked;
    std::vector<float>& some = sample.some;
    some.clear();
    for (std::size_t i = 0; i < sample.sides.size(); i += step) some.push_back(sample.sides[i]);
    sample.max_sides = value_at(some, 0.98);
    sample.many_sides = value_at(some, 0.8);
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
    sample.spread_share = share_of_places(sample, wide);
}

/// Mean distance of `count` boxes that fill the ranges which are wider than a few `side`; 0 when none is.
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

/// Gives the level its cells: of that edge, `along` of them along a row for one edge. When there would be more than
/// `most`, fewer along a row, and if that is not enough, of a larger edge.
void divide(RowLevel& level, const RowSample& sample, const std::array<int, 3>& axis, double edge, double along,
            double most) {
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
        if ((std::floor(edges * min_along) + 1) * rows > most) continue;
        if (edges > 0) along = std::max(min_along, std::min(along, (most / rows - 1) / edges));
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

/// Rows run along the longest axis, along the first unless another is clearly longer.
std::array<int, 3> axes_for(const RowSample& sample) {
    int longest = 0;
    for (int a = 1; a < 3; ++a)
        if (sample.ranges[static_cast<std::size_t>(a)].length >
            1.5f * sample.ranges[static_cast<std::size_t>(longest)].length)
            longest = a;
    return {longest, (longest + 1) % 3, (longest + 2) % 3};
}

/// What levels are laid out by.
struct Layout {
    double cells_a_box = 0;
    double taken = 1;      ///< of the space that boxes lie in: the share in which they are
    bool by_list = false;  ///< rows in a list
};

bool is_sparse(const RowSample& sample) {
    return spacing_of(sample, static_cast<double>(sample.boxes), sample.max_sides) > 2 * double{sample.max_sides};
}

/// All levels but the last, which takes what is larger than all of the sample.
void lay_out(const RowGridSettings& settings, const RowSample& sample, const Layout& layout, RowFit& fit) {
    fit.levels.clear();
    // Most boxes in the lowest level; where boxes are far from each other, cells of a box each are small enough.
    const double max_sides = sample.max_sides, many_sides = sample.many_sides;
    const auto spacing = [&](double count, float side) { return spacing_of(sample, count / layout.taken, side); };
    const double all_spacing = spacing(static_cast<double>(sample.boxes), sample.max_sides);
    // Next to boxes on one plane there is but one row that they reach into: fewer of them shall.
    const auto wide = std::count_if(sample.ranges.begin(), sample.ranges.end(),
                                    [&](const Range& range) { return range.length > 4 * max_sides; });
    const double share = settings.side_share * (wide < 3 ? 1.25 : 1);
    double cell =
        std::max(std::min(share * max_sides, std::max(2 * all_spacing, many_sides)), layout.by_list ? 0 : all_spacing);
    if (settings.cell > 0) cell = settings.cell;
    if (!(cell > 1e-30)) cell = 1;

    std::size_t below = 0;  // of the sample, in the levels so far
    for (double limit = cell; below < sample.sides.size(); limit *= std::max(settings.level_ratio, 1.5f)) {
        const auto within = static_cast<std::size_t>(
            std::count_if(sample.sides.begin(), sample.sides.end(),
                          [most = static_cast<float>(limit)](float side) { return side <= most; }));
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
            const double most = std::min(layout.cells_a_box * count + 64, 0x1p22);
            // Room for the roundings of cell(): 2^-22 of a cell for each of some thousand rows.
            const double edge = std::max(limit, spacing(count, static_cast<float>(limit))) * (1 + 0x1p-9);
            divide(level, sample, fit.axis, edge, std::max(settings.cells_along, 0.01f), most);
        }
        fit.levels.push_back(level);
    }
}

/// How many others of its level share a cube with a box, in the mean: cells that follow each other in a row, as many as
/// make it as long as rows are apart. That is in proportion to the time of a search.
double crowd_of(RowSample& sample, const RowFit& fit) {
    const std::size_t step = (sample.corners.size() + ranked - 1) / ranked;
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

/// A table, unless most of it would be empty and the rest too full.
void add_levels(const RowGridSettings& settings, RowSample& sample, RowFit& fit) {
    using Rows = RowGridSettings::Rows;
    fit.axis = axes_for(sample);
    const Layout table{.cells_a_box = settings.cells_a_box};
    lay_out(settings, sample, settings.rows == Rows::List ? Layout{.by_list = true} : table, fit);
    if (settings.rows == Rows::List || sample.spread_share > 0.5f) return;

    // Measured: boxes in a table take 12 ns each, and 0.2 for each other in a cube; five times as many cells 1 ns more,
    // but 0.1 for another; rows in a list 50 to 80.
    constexpr double much = 16, too_much = 500;
    double crowd = crowd_of(sample, fit);
    if (crowd <= much) return;
    lay_out(settings, sample, {.cells_a_box = 5 * settings.cells_a_box, .taken = sample.spread_share}, fit);
    const double finer = crowd_of(sample, fit);
    if (finer > 0.7 * crowd) {
        lay_out(settings, sample, table, fit);
    } else {
        crowd = finer;
    }
    if (settings.rows == Rows::Chosen && crowd > too_much && is_sparse(sample))
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
