/// Makes columns from loops and boxes from lines.
#include "fase/level/level_solids.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "fase/geometry/hull_builder.hpp"
#include "fase/level/level_place.hpp"
#include "fase/level/level_room.hpp"

namespace fase::level {
namespace {

/// The minimal thickness of a wall, in map units.
constexpr double min_thickness = 1;

class SolidBuilder {
public:
    SolidBuilder(const LevelBsp& bsp, const Map& map, const SolidOptions& options)
        : bsp_(bsp), map_(map), options_(options) {
        for (const SubSector& s : bsp.sub_sectors) {
            const Opening opening = opening_of(map, s.sector);
            all_.floor = std::min(all_.floor, opening.floor);
            all_.ceiling = std::max({all_.ceiling, opening.ceiling, opening.floor});
        }
        all_.floor -= options.depth / options.scale;
        all_.ceiling += options.depth / options.scale;
    }

    LevelSolids build() {
        for (std::uint32_t i = 0; i < bsp_.sub_sectors.size(); ++i) add_sub_sector(i);
        // One box for each one-sided line; then one for each other seg without a partner.
        for (std::uint32_t l = 0; l < map_.lines.size(); ++l) {
            const Line& line = map_.lines[l];
            if (line.has_no_side()) continue;  // nothing stands there
            if (line.left == no_side || line.right == no_side) {
                const Point from = to_point(map_.vertices[line.from]), to = to_point(map_.vertices[line.to]);
                if (line.right == no_side) {
                    add_wall(to, from, l);
                } else {
                    add_wall(from, to, l);
                }
            }
        }
        for (const Seg& seg : bsp_.segs) {
            if (seg.partner != no_index || is_one_sided(seg)) continue;
            add_wall(bsp_.vertices[seg.from], bsp_.vertices[seg.to], seg.line);
        }
        return std::move(out_);
    }

private:
    const LevelBsp& bsp_;
    const Map& map_;
    const SolidOptions& options_;
    LevelSolids out_;
    Opening all_{1e30, -1e30};  ///< from below all floors to above all ceilings

    static Point to_point(Vertex v) { return {double(v.x), double(v.y)}; }
    [[nodiscard]] bool is_one_sided(const Seg& seg) const {
        return seg.line != no_index && (map_.lines[seg.line].left == no_side || map_.lines[seg.line].right == no_side);
    }

    void add_sub_sector(std::uint32_t index) {
        const SubSector& s = bsp_.sub_sectors[index];
        if (s.edges == 0) return;
        const Opening opening = opening_of(map_, s.sector);
        add_column(index, LevelSolid::Kind::Floor, all_.floor, opening.floor);
        // A ceiling below the floor counts as one on the floor.
        if (!is_under_sky(map_, s.sector))
            add_column(index, LevelSolid::Kind::Ceiling, std::max(opening.floor, opening.ceiling), all_.ceiling);
        add_floor_mesh(s, opening.floor);
        for (const Seg& seg : bsp_.edges(s)) add_wall_mesh(seg, s.sector);
    }

    void add_column(std::uint32_t index, LevelSolid::Kind kind, double low, double high) {
        const SubSector& s = bsp_.sub_sectors[index];
        const Point middle = middle_of(bsp_, s);
        const double height = (low + high) / 2;
        const Vec3d centre = to_world(middle, height, options_.scale);
        std::vector<Vec3> corners;
        for (const Seg& seg : bsp_.edges(s))
            for (const double z : {low, high})
                corners.push_back(to_float(to_world(bsp_.vertices[seg.from], z, options_.scale) - centre));
        Result<ConvexHull> hull = build_convex_hull(corners);
        if (!hull) {
            if (kind == LevelSolid::Kind::Floor) ++out_.too_thin;
            return;
        }
        out_.solids.push_back({kind, index, *std::move(hull), {to_float(centre), {}}});
    }

    /// Adds a box on the left of the line from one corner to the other; thinner if it would overlap a sub-sector.
    void add_wall(Point from, Point to, std::uint32_t line) {
        const double dx = to.x - from.x, dy = to.y - from.y, length = std::sqrt(dx * dx + dy * dy);
        if (!(length > 0)) return;
        const Point out{-dy / length, dx / length};
        double thickness = std::max(options_.wall / options_.scale, min_thickness);
        for (; thickness > min_thickness; thickness = std::max(thickness / 2, min_thickness)) {
            const std::array<Point, 4> corners{from,
                                               to,
                                               {to.x + out.x * thickness, to.y + out.y * thickness},
                                               {from.x + out.x * thickness, from.y + out.y * thickness}};
            if (!overlaps_interior(bsp_, corners, 0.01)) break;
        }
        const Point middle{(from.x + to.x + out.x * thickness) / 2, (from.y + to.y + out.y * thickness) / 2};
        const Vec3d centre = to_world(middle, (all_.floor + all_.ceiling) / 2, options_.scale);
        const Vec3d half{length / 2 * options_.scale, (all_.ceiling - all_.floor) / 2 * options_.scale,
                         thickness / 2 * options_.scale};
        // Rotates about y so that x is along the wall; half-angle formulas from the cosine.
        const double cosine = dx / length;
        const double w = std::sqrt(std::max(0.0, (1 + cosine) / 2)), y = std::sqrt(std::max(0.0, (1 - cosine) / 2));
        const Quat rotation{0, static_cast<float>(dy < 0 ? -y : y), 0, static_cast<float>(w)};
        out_.solids.push_back({LevelSolid::Kind::Wall, line, Box{to_float(half)}, {to_float(centre), rotation}});
    }

    [[nodiscard]] int light_of(std::uint32_t sector) const {
        return std::clamp(map_.sectors[sector].light / 16, 0, 15);
    }

    void add_corner(TriangleMesh& mesh, Point p, double z) const {
        mesh.positions.push_back(to_float(to_world(p, z, options_.scale)));
    }
    void add_floor_mesh(const SubSector& s, double floor) {
        TriangleMesh& mesh = out_.floors[light_of(s.sector)];
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Seg& seg : bsp_.edges(s)) add_corner(mesh, bsp_.vertices[seg.from], floor);
        for (std::uint32_t i = 2; i < s.edges; ++i)
            mesh.indices.insert(mesh.indices.end(), {first, first + i, first + i - 1});
    }
    void add_wall_mesh(const Seg& seg, std::uint32_t sector) {
        const Opening opening = opening_of(map_, sector);
        if (seg.partner == no_index) return add_wall_mesh(seg, sector, opening.floor, opening.ceiling);
        const std::uint32_t behind = bsp_.sub_sectors[bsp_.segs[seg.partner].sub_sector].sector;
        const Opening next = opening_of(map_, behind);
        add_wall_mesh(seg, sector, opening.floor, next.floor);
        if (!is_under_sky(map_, behind))
            add_wall_mesh(seg, sector, std::max(next.ceiling, opening.floor), opening.ceiling);
    }
    void add_wall_mesh(const Seg& seg, std::uint32_t sector, double low, double high) {
        if (!(low < high)) return;
        TriangleMesh& mesh = out_.walls[light_of(sector)];
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        const Point a = bsp_.vertices[seg.from], b = bsp_.vertices[seg.to];
        add_corner(mesh, a, low);
        add_corner(mesh, b, low);
        add_corner(mesh, b, high);
        add_corner(mesh, a, high);
        mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
    }
};

}  // namespace

Result<LevelSolids> make_solids(const LevelBsp& bsp, const Map& map, const SolidOptions& options) {
    for (const auto& [name, value] :
         {std::pair{"scale", options.scale}, {"depth", options.depth}, {"wall", options.wall}}) {
        if (std::isfinite(value) && value > 0) continue;
        return Error{Status::BadArgument,
                     fmt::format("SolidOptions.{}", name),
                     fmt::format("found {}; expected a number above 0", value),
                     {}};
    }
    return SolidBuilder(bsp, map, options).build();
}

bool is_under_sky(const Map& map, std::uint32_t sector) { return map.sectors[sector].ceiling_texture == "F_SKY1"; }

bool is_inside(const LevelBsp& bsp, const Map& map, Vec3d place, double scale, double slack) {
    const Point p = to_plan(place, scale);
    const auto in_sector = [&](std::uint32_t sector) {
        const Opening opening = opening_of(map, sector);
        return place.y >= opening.floor * scale - slack &&
               (is_under_sky(map, sector) || place.y <= opening.ceiling * scale + slack);
    };
    if (const auto sector = sector_at(bsp, p); sector && in_sector(*sector)) return true;
    // Tests points at the distance of the slack in eight directions.
    for (const auto& [x, y] : {std::pair{1.0, 0.0},
                               {0.7, 0.7},
                               {0.0, 1.0},
                               {-0.7, 0.7},
                               {-1.0, 0.0},
                               {-0.7, -0.7},
                               {0.0, -1.0},
                               {0.7, -0.7}}) {
        const auto sector = sector_at(bsp, {p.x + x * slack / scale, p.y + y * slack / scale});
        if (sector && in_sector(*sector)) return true;
    }
    return false;
}

}  // namespace fase::level
