#pragma once
/// Casts rays through a level: the first wall, floor or ceiling on the ray, and the sub-sectors on the way.
#include <cstdint>
#include <optional>
#include <vector>

#include "fase/level/level_bsp.hpp"
#include "fase/level/map.hpp"

namespace fase::level {

/// A ray in map units; heights are along z.
struct LevelRay {
    Point from;
    double z = 0;
    Point direction{1, 0};       ///< on the plan, of any length; both 0: straight up or down
    double rise = 0;             ///< change of z for each length of `direction`
    double max_distance = 1e30;  ///< in lengths of `direction`
};

/// The kind of obstacle that stops a ray.
enum class Barrier : std::uint8_t {
    Wall,   ///< a one-sided line, or the open edge of a sector that is not closed
    Below,  ///< the step from one floor to a higher one, seen from the lower sector
    Above,  ///< the part of a wall above an opening
    Floor,
    Ceiling,
};

/// The first obstacle on a ray.
struct LevelHit {
    double distance = 0;  ///< in lengths of the ray's direction
    Barrier barrier = Barrier::Wall;
    std::uint32_t seg = no_index;   ///< the seg that was hit; no_index: a floor or ceiling
    std::uint32_t sub_sector = 0;   ///< the sub-sector in which the ray ends
    std::uint32_t line = no_index;  ///< of the map
};

/// What stops rays.
enum class Heights : std::uint8_t {
    Ignored,  ///< only walls without another side, as if each sector had infinite height and all doors were open
    Counted,  ///< also floors, ceilings, and the parts of a line above and below its opening
};

/// The vertical interval between a floor and a ceiling; closed if it has no height.
struct Opening {
    double floor = 0, ceiling = 0;
    [[nodiscard]] constexpr bool is_open() const { return floor < ceiling; }
    [[nodiscard]] constexpr bool contains(double z) const { return is_open() && floor <= z && z <= ceiling; }
};
[[nodiscard]] inline Opening opening_of(const Map& map, std::uint32_t sector) {
    return {double(map.sectors[sector].floor), double(map.sectors[sector].ceiling)};
}
/// Returns the opening between a seg's sub-sector and its partner's. The seg must have a partner.
[[nodiscard]] inline Opening opening_between(const LevelBsp& bsp, const Map& map, const Seg& seg) {
    const Opening a = opening_of(map, bsp.sub_sectors[seg.sub_sector].sector);
    const Opening b = opening_of(map, bsp.sub_sectors[bsp.segs[seg.partner].sub_sector].sector);
    return {a.floor > b.floor ? a.floor : b.floor, a.ceiling < b.ceiling ? a.ceiling : b.ceiling};
}

/// The part of a ray inside a sub-sector.
struct Passage {
    std::uint32_t sub_sector = 0;
    double from = 0, to = 0;  ///< in lengths of the ray's direction
};

/// Returns the first obstacle on a ray that starts inside the level; from outside, the backs of walls stop it too.
/// Walls that share a corner leave no gap. nullopt if nothing stops it within `max_distance`, or a number is not
/// finite. O(depth + elements near the ray); allocates nothing up to 128 levels. Safe from any number of threads.
[[nodiscard]] std::optional<LevelHit> cast_ray(const LevelBsp& bsp, const Map& map, const LevelRay& ray,
                                               Heights heights = Heights::Counted);

/// The reference for cast_ray(): tests every seg and every sub-sector.
[[nodiscard]] std::optional<LevelHit> cast_ray_brute_force(const LevelBsp& bsp, const Map& map, const LevelRay& ray,
                                                           Heights heights = Heights::Counted);

/// Appends the passages of a ray up to its first obstacle, in order; skips those shorter than 2^-30 of the distance.
void passages(const LevelBsp& bsp, const Map& map, const LevelRay& ray, Heights heights, std::vector<Passage>& out);

}  // namespace fase::level
