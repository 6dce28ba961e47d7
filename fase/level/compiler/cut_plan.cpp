/// The first stage of the compiler: groups the lines of a map by plane.
#include <algorithm>
#include <array>
#include <map>

#include "fase/core/hash.hpp"
#include "fase/level/compiler/cut_state.hpp"

namespace fase::level {
namespace {

/// Equal for all lines on one plane, in either direction.
struct PlaneKey {
    std::int64_t dx = 0, dy = 0, offset = 0;
    friend bool operator==(const PlaneKey&, const PlaneKey&) = default;
};

PlaneKey key_of(const ExactLine& line, bool& opposite) {
    const std::int64_t common = std::gcd(line.dx, line.dy);
    opposite = line.dx < 0 || (line.dx == 0 && line.dy < 0);
    const std::int64_t divisor = opposite ? -common : common;
    // The divisor divides the offset too: it is dx * Y - dy * X with integers X and Y.
    return {line.dx / divisor, line.dy / divisor, line.offset() / divisor};
}

/// Maps keys to planes: a hash table with open addressing.
class PlaneTable {
public:
    explicit PlaneTable(std::size_t lines) {
        std::size_t slots = 16;
        while (slots < 2 * lines) slots *= 2;
        slots_.assign(slots, no_index);
    }
    std::uint32_t index_of(const PlaneKey& key) {
        const auto word = [](std::int64_t value) { return static_cast<std::uint64_t>(value); };
        std::size_t slot =
            mix_bits(word(key.dx) * 0x9e3779b97f4a7c15ull + word(key.dy) * 0xc2b2ae3d27d4eb4full + word(key.offset)) &
            (slots_.size() - 1);
        while (slots_[slot] != no_index && keys_[slots_[slot]] != key) slot = (slot + 1) & (slots_.size() - 1);
        if (slots_[slot] == no_index) {
            slots_[slot] = static_cast<std::uint32_t>(keys_.size());
            keys_.push_back(key);
        }
        return slots_[slot];
    }

private:
    std::vector<PlaneKey> keys_;
    std::vector<std::uint32_t> slots_;
};

std::int64_t length2(const ExactLine& line) {
    return std::int64_t{line.dx} * line.dx + std::int64_t{line.dy} * line.dy;
}

}  // namespace

Plan make_plan(const Map& map, std::vector<Piece>& pieces) {
    Plan plan;
    std::int32_t west = 1 << 16, south = 1 << 16, east = -west, north = -south;
    for (const Vertex& v : map.vertices) {
        plan.point_of_vertex.push_back(plan.points.index_of({v.x, v.y, 1}));
        west = std::min<std::int32_t>(west, v.x);
        east = std::max<std::int32_t>(east, v.x);
        south = std::min<std::int32_t>(south, v.y);
        north = std::max<std::int32_t>(north, v.y);
    }
    PlaneTable table(map.lines.size());
    std::vector<std::uint8_t> plane_is_opposite;
    for (std::uint32_t i = 0; i < map.lines.size(); ++i) {
        const Line& line = map.lines[i];
        const Vertex from = map.vertices[line.from], to = map.vertices[line.to];
        plan.plane_of_line.push_back(no_index);
        plan.against_plane.push_back(0);
        if (from == to) continue;
        const ExactLine exact{from.x, from.y, to.x - from.x, to.y - from.y};
        bool opposite = false;
        const std::uint32_t plane = table.index_of(key_of(exact, opposite));
        if (plane == plan.planes.size()) {
            plan.planes.push_back(exact);
            plane_is_opposite.push_back(opposite ? 1 : 0);
        } else if (length2(exact) > length2(plan.planes[plane])) {
            plan.planes[plane] = exact;
            plane_is_opposite[plane] = opposite ? 1 : 0;
        }
        plan.plane_of_line[i] = plane;
        plan.against_plane[i] = opposite ? 1 : 0;
        const auto sides = static_cast<std::uint8_t>((line.right != no_side ? right_side : 0) |
                                                     (line.left != no_side ? left_side : 0));
        if (sides != 0) pieces.push_back({plan.point_of_vertex[line.from], plan.point_of_vertex[line.to], i, sides});
    }
    for (std::uint32_t i = 0; i < map.lines.size(); ++i)
        if (plan.plane_of_line[i] != no_index) plan.against_plane[i] ^= plane_is_opposite[plan.plane_of_line[i]];
    plan.box_planes = static_cast<std::uint32_t>(plan.planes.size());
    constexpr std::int32_t margin = 8;
    plan.planes.push_back({west - margin, 0, 0, 1});
    plan.planes.push_back({0, north + margin, 1, 0});
    plan.planes.push_back({east + margin, 0, 0, -1});
    plan.planes.push_back({0, south - margin, -1, 0});
    return plan;
}

}  // namespace fase::level
