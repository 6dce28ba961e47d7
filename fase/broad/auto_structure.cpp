/// The rules, derived from measurements, and the conversion to another structure.
#include "fase/broad/auto_structure.hpp"

#include <algorithm>
#include <vector>

#include "fase/broad/registry.hpp"

namespace fase::broad {
namespace {

// Break-even counts: the number of boxes at which brute force costs as much as a row grid. A row grid has a cost per
// size level, so brute force wins longer when sizes differ; on a plane the rows are short. A set that only answers
// queries does not find pairs among its own boxes.
constexpr double typical_break_even = 110, flat_break_even = 60, mixed_sizes_break_even = 130, queried_break_even = 400;
// For rays the wide tree is faster from 8 boxes on, for boxes and views from about a hundred.
constexpr double query_break_even = 8;
// Outside these counts the sizes do not matter for sets that find pairs.
constexpr std::size_t always_few = 50, never_few = 160;
constexpr float mixed_sizes = 4;

double break_even(const BoxStatistics& statistics) {
    if (statistics.use == BoxUse::AnswersQueries) return query_break_even;
    if (statistics.use == BoxUse::IsQueried) return queried_break_even;
    return statistics.size_spread >= mixed_sizes ? mixed_sizes_break_even
           : statistics.flat                     ? flat_break_even
                                                 : typical_break_even;
}

/// Returns whether the count alone decides, without sizes and positions.
bool count_decides(std::size_t boxes, BoxUse use) {
    return use != BoxUse::FindsPairs || boxes <= always_few || boxes >= never_few;
}

BoxStatistics stored_statistics(const AnyStructure& structure, BoxUse use) {
    if (count_decides(structure.size(), use)) return {.boxes = structure.size(), .use = use};
    std::vector<Move> boxes;
    structure.traverse(Everything{}, [&](Proxy p, const Aabb& box) {
        boxes.push_back({p, box});
        return true;
    });
    return statistics_of(boxes, use);
}

}  // namespace

BoxStatistics statistics_of(std::span<const Move> boxes, BoxUse use) {
    BoxStatistics found{.boxes = boxes.size(), .use = use};
    if (count_decides(found.boxes, use)) return found;
    std::vector<float> sides;
    Aabb corners;
    for (const Move& m : boxes) {
        const float side = longest_side(m.box);
        if (!(side >= 0 && side < Aabb::infinity)) continue;  // a NaN too
        sides.push_back(side);
        corners.lo = min(corners.lo, m.box.lo);
        corners.hi = max(corners.hi, m.box.lo);
    }
    if (sides.size() < 2) return found;
    const auto nth_smallest = [&](std::size_t n) {
        const auto nth = sides.begin() + static_cast<std::ptrdiff_t>(n);
        std::nth_element(sides.begin(), nth, sides.end());
        return *nth;
    };
    const float percentile_98 = nth_smallest(sides.size() * 49 / 50), median = nth_smallest(sides.size() / 2);
    found.size_spread = median > 0 ? percentile_98 / median : (percentile_98 > 0 ? Aabb::infinity : 1);
    const Vec3 spread = extent(corners);
    found.flat = std::min({spread.x, spread.y, spread.z}) <= 2 * median;
    return found;
}

std::string_view choice_reason(std::string_view structure) {
    if (structure == BruteForce::info.name) return "few boxes: testing all pairs costs less than sorting";
    if (structure == WideBvh::info.name) return "queries: visits few wide nodes, nearest first";
    if (structure == RowGrid::info.name) return "many boxes: sorted into rows, only neighbours are tested";
    return {};
}

std::string_view choose_structure(const BoxStatistics& statistics, std::string_view current) {
    const double hysteresis = current.empty() ? 1 : current == BruteForce::info.name ? 1.15 : 0.85;
    if (static_cast<double>(statistics.boxes) < hysteresis * break_even(statistics)) return BruteForce::info.name;
    return statistics.use == BoxUse::AnswersQueries ? WideBvh::info.name : RowGrid::info.name;
}

void update_auto_structure(AnyStructure& structure, BoxUse use, bool inspect_sizes) {
    if (!inspect_sizes && !count_decides(structure.size(), use)) return;
    const std::string_view best = choose_structure(stored_statistics(structure, use), structure.info().name);
    if (best != structure.info().name) structure.convert_to(*AnyStructure::named(best));
}

}  // namespace fase::broad
