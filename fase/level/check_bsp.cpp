/// Measures a tree from the data in its file only: lines, segs, nodes.
#include "fase/level/check_bsp.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace fase::level {
namespace {

double length_of(Point a, Point b) { return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y)); }

/// Returns the distance of a point to the left of the line from a to b.
double left_of(Point a, Point b, Point p) {
    const double length = length_of(a, b);
    return length == 0 ? 0 : ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) / length;
}

double area_of(const std::vector<Point>& outline) {  // positive if clockwise
    double twice = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Point a = outline[i], b = outline[(i + 1) % outline.size()], o = outline[0];
        twice += (a.y - o.y) * (b.x - o.x) - (a.x - o.x) * (b.y - o.y);
    }
    return twice / 2;
}

/// Clips an outline to the right of the line from a to b.
void clip_right(std::vector<Point>& outline, Point a, Point b, std::vector<Point>& scratch) {
    scratch.clear();
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Point p = outline[i], q = outline[(i + 1) % outline.size()];
        const double at_p = left_of(a, b, p), at_q = left_of(a, b, q);
        if (at_p <= 0) scratch.push_back(p);
        if ((at_p < 0 && at_q > 0) || (at_p > 0 && at_q < 0)) {
            const double t = at_p / (at_p - at_q);
            scratch.push_back({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)});
        }
    }
    outline.swap(scratch);
}

/// Measures one tree.
class Checker {
public:
    Checker(const Map& map, const LevelBsp& bsp) : map_(map), bsp_(bsp) {
        for (std::uint32_t i = 0; i < map.sectors.size(); ++i) merged_.push_back(i);
        for (const Point p : bsp.vertices) plan_.add(p);
    }

    BspCheck run() {
        for (const SubSector& s : bsp_.sub_sectors) check_sub_sector(s);
        check_cover();
        areas_.assign(map_.sectors.size(), 0);
        const PlanBox around{{plan_.lo.x - 8, plan_.lo.y - 8}, {plan_.hi.x + 8, plan_.hi.y + 8}};
        check_tree({bsp_.root(), {around.lo, {around.lo.x, around.hi.y}, around.hi, {around.hi.x, around.lo.y}}});
        check_areas();
        return out_;
    }

private:
    /// A child, and the cell bounded by the partition lines above it.
    struct Cell {
        std::uint32_t child = 0;
        std::vector<Point> outline;
    };
    const Map& map_;
    const LevelBsp& bsp_;
    PlanBox plan_;
    BspCheck out_;
    std::vector<double> areas_;
    std::vector<std::uint32_t> merged_;  ///< by sector: a sector with which it is measured, or itself

    [[nodiscard]] std::uint32_t root_of(std::uint32_t sector) const {
        while (merged_[sector] != sector) sector = merged_[sector];
        return sector;
    }
    [[nodiscard]] Point position(std::uint32_t vertex) const { return bsp_.vertices[vertex]; }
    /// Returns the ends of a seg; for walls the ends of the line, which are not rounded.
    [[nodiscard]] std::pair<Point, Point> ends_of(const Seg& seg) const {
        if (seg.line == no_index) return {position(seg.from), position(seg.to)};
        const Line& line = map_.lines[seg.line];
        const Vertex a = map_.vertices[seg.left ? line.to : line.from],
                     b = map_.vertices[seg.left ? line.from : line.to];
        return {{double(a.x), double(a.y)}, {double(b.x), double(b.y)}};
    }
    [[nodiscard]] std::uint32_t sector_of(const Seg& seg) const {
        const Line& line = map_.lines[seg.line];
        return map_.sides[seg.left ? line.left : line.right].sector;
    }

    void check_sub_sector(const SubSector& s) {
        const std::span<const Seg> segs(bsp_.segs.data() + s.first, std::size_t{s.edges} + s.outliers);
        bool mixed = false, open = false;
        for (const Seg& seg : segs) {
            const auto [a, b] = ends_of(seg);
            if (segs.size() <= 64 || &seg == segs.data()) {
                for (const Seg& other : segs)
                    for (const std::uint32_t v : {other.from, other.to})
                        out_.bulge = std::max(out_.bulge, left_of(a, b, position(v)));
            } else {  // in long loops, only corners against the adjacent edges
                const Seg& before = *(&seg - 1);
                for (const std::uint32_t v : {before.from, before.to})
                    out_.bulge = std::max(out_.bulge, left_of(a, b, position(v)));
            }
            if (seg.line == no_index || sector_of(seg) == s.sector) continue;
            mixed = true;
            const std::uint32_t a_sector = root_of(sector_of(seg)), b_sector = root_of(s.sector);
            merged_[std::max(a_sector, b_sector)] = std::min(a_sector, b_sector);
        }
        for (std::uint32_t i = 0; i < s.edges; ++i) {
            const Seg& seg = segs[i];
            open |= seg.to != segs[(i + 1) % s.edges].from;
            if (seg.partner == no_index) {
                out_.openings += seg.line == no_index ? 1 : 0;
                continue;
            }
            const Seg& partner = bsp_.segs[seg.partner];
            const bool opposite = partner.from == seg.to && partner.to == seg.from;
            if (!opposite || partner.partner != static_cast<std::uint32_t>(&seg - bsp_.segs.data()))
                ++out_.wrong_partners;
        }
        out_.mixed += mixed ? 1 : 0;
        out_.open_loops += open ? 1 : 0;
    }

    /// Checks that the segs of each side of each line cover it from end to end.
    void check_cover() {
        struct Interval {
            std::uint64_t side = 0;
            double from = 0, to = 0;
        };
        std::vector<Interval> intervals;
        std::vector<std::uint8_t> covered(2 * map_.lines.size());
        for (const SubSector& s : bsp_.sub_sectors) {
            for (std::uint32_t i = s.first; i < s.first + s.edges + s.outliers; ++i) {
                const Seg& seg = bsp_.segs[i];
                if (seg.line == no_index) continue;
                const auto [a, b] = ends_of(seg);
                const auto along = [&, from = a, to = b](Point p) {
                    return ((p.x - from.x) * (to.x - from.x) + (p.y - from.y) * (to.y - from.y)) / length_of(from, to);
                };
                intervals.push_back(
                    {seg.line * 2ull + (seg.left ? 1 : 0), along(position(seg.from)), along(position(seg.to))});
            }
        }
        std::sort(intervals.begin(), intervals.end(), [](const Interval& p, const Interval& q) {
            return p.side != q.side ? p.side < q.side : p.from < q.from;
        });
        for (std::size_t i = 0; i < intervals.size();) {
            const std::uint64_t side = intervals[i].side;
            covered[side] = 1;
            double end = 0;
            for (; i < intervals.size() && intervals[i].side == side; ++i) {
                out_.gaps += std::max(intervals[i].from - end, 0.0);
                out_.overlaps += std::max(std::min(end, intervals[i].to) - intervals[i].from, 0.0);
                end = std::max(end, intervals[i].to);
            }
            out_.gaps += std::max(length_of_line(side / 2) - end, 0.0);
        }
        for (std::size_t side = 0; side < covered.size(); ++side) {
            const Line& line = map_.lines[side / 2];
            if (covered[side] == 0 && (side % 2 == 0 ? line.right : line.left) != no_side)
                out_.gaps += length_of_line(side / 2);
        }
    }
    [[nodiscard]] double length_of_line(std::size_t i) const {
        const Vertex a = map_.vertices[map_.lines[i].from], b = map_.vertices[map_.lines[i].to];
        return length_of({double(a.x), double(a.y)}, {double(b.x), double(b.y)});
    }

    void check_tree(Cell root) {
        std::vector<Cell> cells;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> above;  // (node, side) of the path from the root, by depth
        std::vector<std::size_t> depths{0};
        std::vector<Point> scratch;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> steps{{0, 0}};
        cells.push_back(std::move(root));
        while (!cells.empty()) {
            const Cell cell = std::move(cells.back());
            const std::size_t depth = depths.back();
            above.resize(depth);
            if (depth > 0) above[depth - 1] = steps.back();
            cells.pop_back();
            depths.pop_back();
            steps.pop_back();
            const std::uint32_t index = cell.child & ~Node::leaf_bit;
            if ((cell.child & Node::leaf_bit) != 0) {
                check_leaf(bsp_.sub_sectors[index], above, cell.outline, scratch);
                continue;
            }
            const Node& node = bsp_.nodes[index];
            const Point a{double(node.x), double(node.y)}, b{a.x + node.dx, a.y + node.dy};
            for (const std::uint32_t side : {0u, 1u}) {
                Cell child{node.children[side], cell.outline};
                clip_right(child.outline, side == 0 ? a : b, side == 0 ? b : a, scratch);
                cells.push_back(std::move(child));
                depths.push_back(depth + 1);
                steps.emplace_back(index, side);
            }
        }
    }
    void check_leaf(const SubSector& s, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& above,
                    std::vector<Point> outline, std::vector<Point>& scratch) {
        for (std::uint32_t i = s.first; i < s.first + s.edges + s.outliers; ++i) {
            const Seg& seg = bsp_.segs[i];
            for (const Point p : {position(seg.from), position(seg.to)}) {
                for (const auto& [n, side] : above) {
                    const Node& node = bsp_.nodes[n];
                    const PlanBox& box = node.boxes[side];
                    const double value = left_of({double(node.x), double(node.y)},
                                                 {double(node.x) + node.dx, double(node.y) + node.dy}, p);
                    out_.outside_node = std::max(out_.outside_node, side == 0 ? value : -value);
                    out_.outside_box =
                        std::max({out_.outside_box, box.lo.x - p.x, p.x - box.hi.x, box.lo.y - p.y, p.y - box.hi.y});
                }
            }
            if (s.edges != 0) continue;
            const auto [a, b] = ends_of(seg);
            clip_right(outline, a, b, scratch);
        }
        if (s.edges != 0) {
            outline.clear();
            for (const Seg& seg : bsp_.edges(s)) outline.push_back(position(seg.from));
        }
        if (!outline.empty()) areas_[s.sector] += area_of(outline);
    }

    void check_areas() {
        const std::vector<double> by_lines = sector_areas(map_);
        std::vector<double> expected(by_lines.size()), found(by_lines.size());
        std::vector<std::uint8_t> open(by_lines.size());
        for (std::uint32_t i = 0; i < by_lines.size(); ++i) {
            out_.open_sectors += by_lines[i] < 0 ? 1 : 0;
            open[root_of(i)] |= by_lines[i] < 0 ? 1 : 0;
            expected[root_of(i)] += by_lines[i];
            found[root_of(i)] += areas_[i];
        }
        for (std::uint32_t i = 0; i < by_lines.size(); ++i) {
            if (open[i] != 0 || root_of(i) != i) continue;
            out_.total_area += expected[i];
            const double error = std::abs(found[i] - expected[i]) / std::max(expected[i], 1.0);
            if (error <= out_.area_error) continue;
            out_.area_error = error;
            out_.worst_sector = i;
        }
    }
};

}  // namespace

BspCheck check_bsp(const Map& map, const LevelBsp& bsp) { return Checker(map, bsp).run(); }

std::vector<double> sector_areas(const Map& map) {
    struct End {
        std::uint32_t sector = 0;
        Vertex vertex;
        int balance = 0;  ///< outgoing minus incoming lines
    };
    std::vector<double> areas(map.sectors.size());
    std::vector<End> ends;
    for (const Line& line : map.lines) {
        const Vertex a = map.vertices[line.from], b = map.vertices[line.to];
        const double twice = double(a.y) * b.x - double(a.x) * b.y;
        for (const bool left : {false, true}) {
            const std::uint16_t side = left ? line.left : line.right;
            if (side == no_side) continue;
            const std::uint32_t sector = map.sides[side].sector;
            areas[sector] += (left ? -twice : twice) / 2;
            ends.push_back({sector, a, left ? -1 : 1});
            ends.push_back({sector, b, left ? 1 : -1});
        }
    }
    const auto key = [](const End& end) { return std::tuple(end.sector, end.vertex.x, end.vertex.y); };
    std::sort(ends.begin(), ends.end(), [&](const End& p, const End& q) { return key(p) < key(q); });
    for (std::size_t i = 0; i < ends.size();) {
        int balance = 0;
        const std::size_t first = i;
        for (; i < ends.size() && key(ends[i]) == key(ends[first]); ++i) balance += ends[i].balance;
        if (balance != 0) areas[ends[first].sector] = -1;
    }
    for (double& area : areas)
        if (area < 0) area = -1;
    return areas;
}

}  // namespace fase::level
