/// Loops into columns, lines into boxes.
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

/// The least thickness of a wall, map units.
constexpr double thinnest = 1;

class Maker {
public:
    Maker(const LevelBsp& bsp, const Map& map, const SolidOptions& options) : bsp_(bsp), map_(map), options_(options) {
        for (const SubSector& s : bsp.sub_sectors) {
            const Opening room = opening_of(map, s.sector);
            all_.floor = std::min(all_.floor, room.floor);
            all_.ceiling = std::max({all_.ceiling, room.ceiling, room.floor});
        }
        all_.floor -= options.depth / options.scale;
        all_.ceiling += options.depth / options.scale;
    }

    LevelSolids make() {
        for (std::uint32_t i = 0; i < bsp_.sub_sectors.size(); ++i) add_sub_sector(i);
        // One box a line with one side; what else has nothing behind it, piece by piece.
        for (std::uint32_t l = 0; l < map_.lines.size(); ++l) {
            const Line& line = map_.lines[l];
            if (line.left == no_side || line.right == no_side) {
                const Point from = place(map_.vertices[line.from]), to = place(map_.vertices[line.to]);
                if (line.right == no_side) {
                    add_wall(to, from, l);
                } else {
                    add_wall(from, to, l);
                }
            }
        }
        for (const Seg& seg : bsp_.segs) {
            if (seg.partner != no_seg || is_one_sided(seg)) continue;
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

    static Point place(Vertex v) { return {double(v.x), double(v.y)}; }
    [[nodiscard]] bool is_one_sided(const Seg& seg) const {
        return seg.line != no_line && (map_.lines[seg.line].left == no_side || map_.lines[seg.line].right == no_side);
    }

    void add_sub_sector(std::uint32_t index) {
        const SubSector& s = bsp_.sub_sectors[index];
        if (s.edges == 0) return;
        const Opening room = opening_of(map_, s.sector);
        add_column(index, LevelSolid::Kind::Floor, all_.floor, room.floor);
        // A ceiling below the floor is as good as one on it.
        if (!is_under_sky(map_, s.sector))
            add_column(index, LevelSolid::Kind::Ceiling, std::max(room.floor, room.ceiling), all_.ceiling);
        draw_floor(s, room.floor);
        for (const Seg& seg : bsp_.edges(s)) draw_wall(seg, s.sector);
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

    /// A box on the left of the way from one corner to the other.
    void add_wall(Point from, Point to, std::uint32_t line) {
        const double dx = to.x - from.x, dy = to.y - from.y, length = std::sqrt(dx * dx + dy * dy);
        if (!(length > 0)) return;
        const Point out{-dy / length, dx / length};
        double thick = std::max(options_.wall / options_.scale, thinnest);
        for (; thick > thinnest; thick = std::max(thick / 2, thinnest)) {
            const std::array<Point, 4> corners{from,
                                               to,
                                               {to.x + out.x * thick, to.y + out.y * thick},
                                               {from.x + out.x * thick, from.y + out.y * thick}};
            if (!reaches_inside(bsp_, corners, 0.01)) break;
        }
        const Point middle{(from.x + to.x + out.x * thick) / 2, (from.y + to.y + out.y * thick) / 2};
        const Vec3d centre = to_world(middle, (all_.floor + all_.ceiling) / 2, options_.scale);
        const Vec3d half{length / 2 * options_.scale, (all_.ceiling - all_.floor) / 2 * options_.scale,
                         thick / 2 * options_.scale};
        // Turned about y so that x goes along the wall: by the halves of the angle's cosine.
        const double cosine = dx / length;
        const double w = std::sqrt(std::max(0.0, (1 + cosine) / 2)), y = std::sqrt(std::max(0.0, (1 - cosine) / 2));
        const Quat turned{0, static_cast<float>(dy < 0 ? -y : y), 0, static_cast<float>(w)};
        out_.solids.push_back({LevelSolid::Kind::Wall, line, Box{to_float(half)}, {to_float(centre), turned}});
    }

    [[nodiscard]] int light_of(std::uint32_t sector) const {
        return std::clamp(map_.sectors[sector].light / 16, 0, 15);
    }

    void add_corner(TriangleMesh& mesh, Point p, double z) const {
        mesh.positions.push_back(to_float(to_world(p, z, options_.scale)));
    }
    void draw_floor(const SubSector& s, double floor) {
        TriangleMesh& mesh = out_.floors[light_of(s.sector)];
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Seg& seg : bsp_.edges(s)) add_corner(mesh, bsp_.vertices[seg.from], floor);
        for (std::uint32_t i = 2; i < s.edges; ++i)
            mesh.indices.insert(mesh.indices.end(), {first, first + i, first + i - 1});
    }
    void draw_wall(const Seg& seg, std::uint32_t sector) {
        const Opening room = opening_of(map_, sector);
        if (seg.partner == no_seg) return draw_wall(seg, sector, room.floor, room.ceiling);
        const std::uint32_t behind = bsp_.sub_sectors[bsp_.segs[seg.partner].sub_sector].sector;
        const Opening next = opening_of(map_, behind);
        draw_wall(seg, sector, room.floor, next.floor);
        if (!is_under_sky(map_, behind)) draw_wall(seg, sector, std::max(next.ceiling, room.floor), room.ceiling);
    }
    void draw_wall(const Seg& seg, std::uint32_t sector, double low, double high) {
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
                     fmt::format("found {}, need a number above 0", value),
                     {}};
    }
    return Maker(bsp, map, options).make();
}

bool is_under_sky(const Map& map, std::uint32_t sector) { return map.sectors[sector].ceiling_texture == "F_SKY1"; }

bool is_inside(const LevelBsp& bsp, const Map& map, Vec3d place, double scale, double slack) {
    const Point p = to_plan(place, scale);
    const auto within = [&](std::uint32_t sector) {
        const Opening room = opening_of(map, sector);
        return place.y >= room.floor * scale - slack &&
               (is_under_sky(map, sector) || place.y <= room.ceiling * scale + slack);
    };
    if (const auto sector = sector_at(bsp, p); sector && within(*sector)) return true;
    // Within the slack of where it is good, to eight sides.
    for (const auto& [x, y] : {std::pair{1.0, 0.0},
                               {0.7, 0.7},
                               {0.0, 1.0},
                               {-0.7, 0.7},
                               {-1.0, 0.0},
                               {-0.7, -0.7},
                               {0.0, -1.0},
                               {0.7, -0.7}}) {
        const auto sector = sector_at(bsp, {p.x + x * slack / scale, p.y + y * slack / scale});
        if (sector && within(*sector)) return true;
    }
    return false;
}

}  // namespace fase::level
