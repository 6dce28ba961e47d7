#pragma once
/// Rays through a level: what wall, floor or ceiling they meet first, and what they pass on the way.
#include <cstdint>
#include <optional>
#include <vector>

#include "fase/level/level_bsp.hpp"
#include "fase/level/map.hpp"

namespace fase::level {

/// A straight line from a place, in map units, heights along z.
struct LevelRay {
    Point from;
    double z = 0;
    Point direction{1, 0};  ///< on the plan, of any length; both 0: straight up or down
    double rise = 0;        ///< of z, for each `direction`
    double most = 1e30;     ///< goes so many times the direction
};

/// What stops a ray.
enum class Barrier : std::uint8_t {
    Wall,   ///< a one-sided line, or the end of a sector that is not closed
    Below,  ///< the step from one floor to a higher one, seen from the lower sector
    Above,  ///< the part of a wall over an opening
    Floor,
    Ceiling,
};

/// Where a ray ends.
struct LevelHit {
    double at = 0;  ///< times the ray's direction
    Barrier barrier = Barrier::Wall;
    std::uint32_t seg = no_seg;    ///< that was met; no_seg: a floor or ceiling
    std::uint32_t sub_sector = 0;  ///< on whose inside
    std::uint32_t line = no_line;  ///< of the map
};

/// What stops rays.
enum class Heights : std::uint8_t {
    Ignored,  ///< only walls without another side: as if each sector were endlessly high, doors open
    Counted,  ///< floors, ceilings and what is not opening between two of them, too
};

/// Room between a floor and a ceiling; closed when it has no height.
struct Opening {
    double floor = 0, ceiling = 0;
    [[nodiscard]] constexpr bool is_open() const { return floor < ceiling; }
    [[nodiscard]] constexpr bool contains(double z) const { return is_open() && floor <= z && z <= ceiling; }
};
[[nodiscard]] inline Opening opening_of(const Map& map, std::uint32_t sector) {
    return {double(map.sectors[sector].floor), double(map.sectors[sector].ceiling)};
}
/// The way from a seg's sub-sector into its partner's; the seg has one.
[[nodiscard]] inline Opening opening_between(const LevelBsp& bsp, const Map& map, const Seg& seg) {
    const Opening a = opening_of(map, bsp.sub_sectors[seg.sub_sector].sector);
    const Opening b = opening_of(map, bsp.sub_sectors[bsp.segs[seg.partner].sub_sector].sector);
    return {a.floor > b.floor ? a.floor : b.floor, a.ceiling < b.ceiling ? a.ceiling : b.ceiling};
}

/// The stretch of a ray inside a sub-sector.
struct Passage {
    std::uint32_t sub_sector = 0;
    double from = 0, to = 0;  ///< times the ray's direction
};

/// The first thing that stops a ray that begins inside the level; from outside, walls stop it too, by their backs.
/// Walls that meet in a corner leave no gap between them. nullopt when nothing does within `most`, or a number is not
/// finite. O(depth + what is near the ray); allocates nothing up to 128 levels. Safe from any number of threads.
[[nodiscard]] std::optional<LevelHit> cast_ray(const LevelBsp& bsp, const Map& map, const LevelRay& ray,
                                               Heights heights = Heights::Counted);

/// The same, asked of each seg and each sub-sector: the judge.
[[nodiscard]] std::optional<LevelHit> cast_ray_at_all(const LevelBsp& bsp, const Map& map, const LevelRay& ray,
                                                      Heights heights = Heights::Counted);

/// Appends what a ray passes on its way to what stops it, in order; passages shorter than 2^-30 of the way are left
/// out.
void passages(const LevelBsp& bsp, const Map& map, const LevelRay& ray, Heights heights, std::vector<Passage>& out);

}  // namespace fase::level
