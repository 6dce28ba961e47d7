/// Rules from measurements, and the move into another structure.
#include "fase/broad/suited_structure.hpp"

#include <algorithm>
#include <vector>

namespace fase::broad {
namespace {

// Below the first number trying all wins whatever the boxes, above the second sorting them into rows does. Between,
// rows pay for each level of sizes, so that the more sizes differ, the longer trying all wins.
constexpr std::size_t always_few = 80, never_few = 160;
constexpr std::size_t few_of_one_size = 95, few_of_many_sizes = 130;
constexpr float many_sizes = 4;

float longest_side(const Aabb& box) {
    const Vec3 side = extent(box);
    return std::max({side.x, side.y, side.z});
}

BoxStatistics statistics_of(const AnyStructure& structure) {
    BoxStatistics found{structure.size(), 1};
    if (count_decides(found.boxes)) return found;
    std::vector<float> sides;
    structure.traverse(Everything{}, [&](Proxy, const Aabb& box) {
        const float side = longest_side(box);
        if (side >= 0 && side < Aabb::infinity) sides.push_back(side);  // false for NaN
        return true;
    });
    if (sides.size() < 2) return found;
    const auto at = [&](std::size_t place) {
        const auto nth = sides.begin() + static_cast<std::ptrdiff_t>(place);
        std::nth_element(sides.begin(), nth, sides.end());
        return *nth;
    };
    const float most = at(sides.size() * 49 / 50), middle = at(sides.size() / 2);
    found.size_spread = middle > 0 ? most / middle : (most > 0 ? Aabb::infinity : 1);
    return found;
}

}  // namespace

SuitedStructure suited_structure(const BoxStatistics& statistics, std::string_view current) {
    const SuitedStructure all{BruteForce::info.name, "few boxes: to try all costs less than to sort them"};
    const SuitedStructure rows{RowGrid::info.name, "many boxes: sorted into rows, each meets only its neighbours"};
    if (count_decides(statistics.boxes)) return statistics.boxes <= always_few ? all : rows;
    const bool many = statistics.size_spread >= many_sizes;
    const double middle = static_cast<double>(many ? few_of_many_sizes : few_of_one_size);
    const auto count = static_cast<double>(statistics.boxes);
    const bool tries_all = current == all.structure ? count < 1.15 * middle : count < 0.85 * middle;
    return tries_all ? all : rows;
}

bool count_decides(std::size_t boxes) { return boxes <= always_few || boxes >= never_few; }

void suit(AnyStructure& structure, bool looks_closely) {
    if (!looks_closely && !count_decides(structure.size())) return;
    const SuitedStructure suited = suited_structure(statistics_of(structure), structure.info().name);
    if (suited.structure != structure.info().name) structure.become(*AnyStructure::named(suited.structure));
}

}  // namespace fase::broad
