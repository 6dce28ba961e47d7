/// Rules from measurements, and the move into another structure.
#include "fase/broad/auto_structure.hpp"

#include <algorithm>
#include <vector>

namespace fase::broad {
namespace {

// Where trying all costs as much as sorting into rows, in boxes. Rows pay for each level of sizes, so that the more
// sizes differ, the longer trying all wins; on a plane they are short. Who is only asked does not find pairs of its
// own.
constexpr double usual = 110, on_a_plane = 60, of_many_sizes = 130, asked = 400;
constexpr std::size_t always_few = 50, never_few = 160;  // of those that find pairs, whatever the boxes
constexpr float many_sizes = 4;

double middle_of(const BoxStatistics& statistics) {
    if (statistics.use == BoxUse::IsAsked) return asked;
    return statistics.size_spread >= many_sizes ? of_many_sizes : statistics.flat ? on_a_plane : usual;
}

/// Whether sizes and places do not matter.
bool count_decides(std::size_t boxes, BoxUse use) {
    return use == BoxUse::IsAsked || boxes <= always_few || boxes >= never_few;
}

float longest_side(const Aabb& box) {
    const Vec3 side = extent(box);
    return std::max({side.x, side.y, side.z});
}

BoxStatistics look_at(const AnyStructure& structure, BoxUse use) {
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
    const auto at = [&](std::size_t place) {
        const auto nth = sides.begin() + static_cast<std::ptrdiff_t>(place);
        std::nth_element(sides.begin(), nth, sides.end());
        return *nth;
    };
    const float most = at(sides.size() * 49 / 50), middle = at(sides.size() / 2);
    found.size_spread = middle > 0 ? most / middle : (most > 0 ? Aabb::infinity : 1);
    const Vec3 spread = extent(corners);
    found.flat = std::min({spread.x, spread.y, spread.z}) <= 2 * middle;
    return found;
}

std::string_view reason_for(std::string_view structure) {
    if (structure == BruteForce::info.name) return "few boxes: to try all costs less than to sort them";
    if (structure == RowGrid::info.name) return "many boxes: sorted into rows, each meets only its neighbours";
    return {};
}

std::string_view auto_structure(const BoxStatistics& statistics, std::string_view current) {
    const double middle = middle_of(statistics);
    const double share = current.empty() ? 1 : current == BruteForce::info.name ? 1.15 : 0.85;
    return static_cast<double>(statistics.boxes) < share * middle ? BruteForce::info.name : RowGrid::info.name;
}

void suit(AnyStructure& structure, BoxUse use, bool looks_closely) {
    if (!looks_closely && !count_decides(structure.size(), use)) return;
    const std::string_view suited = auto_structure(look_at(structure, use), structure.info().name);
    if (suited != structure.info().name) structure.convert_to(*AnyStructure::named(suited));
}

}  // namespace fase::broad
