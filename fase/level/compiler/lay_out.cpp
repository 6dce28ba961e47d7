/// Makes sub-sectors from unfinished leaves: walls on edges, minisegs, partners, vertices, boxes.
#include <algorithm>
#include <cmath>

#include "fase/level/compiler/cut_state.hpp"

namespace fase::level {
namespace {

/// A piece of a cell's outline, a wall or a miniseg, before it is split at the corners of neighbours.
struct RawSeg {
    std::uint32_t from = 0, to = 0;  ///< points
    std::uint32_t line = no_index;   ///< of the map
    std::uint32_t node = no_index;   ///< of the partition line that contains it
    std::uint32_t first_cut = 0;     ///< index in `cut_points_`: corners of neighbours inside it, in order
    std::uint32_t cuts = 0;
    std::uint32_t first_seg = 0;
    std::uint32_t position = 0;  ///< of `from` among the points of its node
    bool along = false;          ///< in the direction of its plane, and on the right of it
    bool left = false;           ///< on the left side of the line
};

/// The raw segs of one leaf: those of the loop, then the outliers.
struct LeafSegs {
    std::uint32_t first = 0, edges = 0, outliers = 0;
};

/// A wall of a leaf, with its sub-sector on the right.
struct Wall {
    std::uint32_t from = 0, to = 0, line = 0;
    bool left = false;
};

/// Builds the LevelBsp of one tree.
class Layout {
public:
    Layout(const Map& map, const RawTree& tree) : map_(map), tree_(tree), points_(tree.plan.points) {}

    LevelBsp run() {
        for (const RawLeaf& leaf : tree_.leaves) add_raw_segs(leaf);
        group_by_node();
        split_at_neighbour_corners();
        add_map_vertices();
        add_segs();
        link_partners();
        add_nodes();
        count_stats();
        return std::move(out_);
    }

private:
    const Map& map_;
    const RawTree& tree_;
    const PlanPoints& points_;
    LevelBsp out_;
    std::vector<RawSeg> raw_segs_;
    std::vector<LeafSegs> leaves_;
    std::vector<Wall> walls_;                               ///< of the current edge
    std::vector<std::uint32_t> by_node_, node_begin_;       ///< raw segs grouped by node, and the start of each group
    std::vector<std::uint32_t> node_points_, point_begin_;  ///< by node, in the order along its line
    std::vector<std::uint32_t> cut_points_;
    std::vector<std::uint32_t> vertex_of_point_;

    [[nodiscard]] const ExactLine& line_of(std::uint32_t plane) const { return tree_.plan.planes[plane]; }

    void add_raw_segs(const RawLeaf& leaf) {
        LeafSegs placed{static_cast<std::uint32_t>(raw_segs_.size()), 0, 0};
        std::vector<RawSeg> outliers;
        for (std::uint32_t i = 0; i < leaf.corners; ++i) {
            const CellCorner& corner = tree_.corners[leaf.first_corner + i];
            const std::uint32_t end = tree_.corners[leaf.first_corner + (i + 1) % leaf.corners].point;
            add_edge(leaf, corner, end, outliers);
        }
        placed.edges = static_cast<std::uint32_t>(raw_segs_.size()) - placed.first;
        placed.outliers = static_cast<std::uint32_t>(outliers.size());
        raw_segs_.insert(raw_segs_.end(), outliers.begin(), outliers.end());
        leaves_.push_back(placed);
    }

    void add_edge(const RawLeaf& leaf, const CellCorner& corner, std::uint32_t end, std::vector<RawSeg>& outliers) {
        const Plan& plan = tree_.plan;
        const ExactLine& line = line_of(corner.plane);
        const bool along = points_.order(line, corner.point, end) < 0;
        const auto before = [&](std::uint32_t p, std::uint32_t q) {
            return (along ? points_.order(line, p, q) : points_.order(line, q, p)) < 0;
        };
        walls_.clear();
        for (std::uint32_t k = 0; k < leaf.pieces; ++k) {
            const Piece& piece = tree_.pieces[leaf.first_piece + k];
            if (plan.plane_of_line[piece.line] != corner.plane) continue;
            const bool left = piece.sides == left_side;
            walls_.push_back({left ? piece.b : piece.a, left ? piece.a : piece.b, piece.line, left});
        }
        if (walls_.size() > 1) {
            std::sort(walls_.begin(), walls_.end(), [&](const Wall& a, const Wall& b) {
                return a.from != b.from ? before(a.from, b.from) : a.line < b.line;
            });
        }
        std::uint32_t reached = corner.point;
        const auto raw_seg = [&](std::uint32_t from, std::uint32_t to, std::uint32_t of_line, bool left) {
            return RawSeg{from, to, of_line, corner.node, 0, 0, 0, 0, along, left};
        };
        for (const Wall& wall : walls_) {
            std::uint32_t from = wall.from;
            if (before(reached, from)) {
                raw_segs_.push_back(raw_seg(reached, from, no_index, false));
            } else if (from != reached) {  // overlaps the previous wall
                const bool covered = !before(reached, wall.to);
                outliers.push_back(raw_seg(from, covered ? wall.to : reached, wall.line, wall.left));
                if (covered) continue;
                from = reached;
            }
            raw_segs_.push_back(raw_seg(from, wall.to, wall.line, wall.left));
            reached = wall.to;
        }
        if (reached != end) raw_segs_.push_back(raw_seg(reached, end, no_index, false));
    }

    /// Groups the edges by the node whose line contains them.
    void group_by_node() {
        node_begin_.assign(tree_.nodes.size() + 1, 0);
        each_edge([&](const RawSeg& s) {
            if (s.node != no_index) ++node_begin_[s.node + 1];
        });
        for (std::size_t n = 0; n < tree_.nodes.size(); ++n) node_begin_[n + 1] += node_begin_[n];
        by_node_.resize(node_begin_.back());
        std::vector<std::uint32_t> next(node_begin_.begin(), node_begin_.end());
        each_edge([&](const RawSeg& s) {
            if (s.node != no_index) by_node_[next[s.node]++] = static_cast<std::uint32_t>(&s - raw_segs_.data());
        });
    }
    template <class Visit> void each_edge(Visit&& visit) const {
        for (const LeafSegs& leaf : leaves_)
            for (std::uint32_t i = 0; i < leaf.edges; ++i) visit(raw_segs_[leaf.first + i]);
    }

    /// Splits the edges on one side of a partition line at the corners of cells on the other side.
    void split_at_neighbour_corners() {
        std::vector<std::uint32_t> position(points_.size());
        point_begin_.assign(1, 0);
        for (std::size_t n = 0; n < tree_.nodes.size(); ++n) {
            const ExactLine& line = line_of(tree_.nodes[n].plane);
            const auto first = static_cast<std::ptrdiff_t>(node_points_.size());
            for (std::uint32_t k = node_begin_[n]; k < node_begin_[n + 1]; ++k) {
                node_points_.push_back(raw_segs_[by_node_[k]].from);
                node_points_.push_back(raw_segs_[by_node_[k]].to);
            }
            std::sort(node_points_.begin() + first, node_points_.end(),
                      [&](std::uint32_t p, std::uint32_t q) { return points_.order(line, p, q) < 0; });
            node_points_.erase(std::unique(node_points_.begin() + first, node_points_.end()), node_points_.end());
            for (std::size_t i = static_cast<std::size_t>(first); i < node_points_.size(); ++i)
                position[node_points_[i]] = static_cast<std::uint32_t>(i);
            for (std::uint32_t k = node_begin_[n]; k < node_begin_[n + 1]; ++k) {
                RawSeg& s = raw_segs_[by_node_[k]];
                s.position = position[s.from];
                s.first_cut = static_cast<std::uint32_t>(cut_points_.size());
                const std::uint32_t to = position[s.to];
                if (s.along) {
                    for (std::uint32_t i = s.position + 1; i < to; ++i) cut_points_.push_back(node_points_[i]);
                } else {
                    for (std::uint32_t i = s.position; --i > to;) cut_points_.push_back(node_points_[i]);
                }
                s.cuts = static_cast<std::uint32_t>(cut_points_.size()) - s.first_cut;
            }
            point_begin_.push_back(static_cast<std::uint32_t>(node_points_.size()));
        }
    }

    /// Adds the map's vertices with the same indices; of two at one point, segs use the first.
    void add_map_vertices() {
        vertex_of_point_.assign(points_.size(), no_index);
        for (std::uint32_t v = 0; v < map_.vertices.size(); ++v) {
            out_.vertices.push_back({double(map_.vertices[v].x), double(map_.vertices[v].y)});
            std::uint32_t& vertex = vertex_of_point_[tree_.plan.point_of_vertex[v]];
            vertex = std::min(vertex, v);
        }
        out_.map_vertices = map_.vertices.size();
    }
    std::uint32_t vertex_of(std::uint32_t point) {
        std::uint32_t& vertex = vertex_of_point_[point];
        if (vertex == no_index) {
            vertex = static_cast<std::uint32_t>(out_.vertices.size());
            out_.vertices.push_back(points_.rounded(point));
        }
        return vertex;
    }

    [[nodiscard]] double offset_of(const RawSeg& s, std::uint32_t vertex) const {
        if (s.line == no_index) return 0;
        const Line& line = map_.lines[s.line];
        const Point start = out_.vertices[s.left ? line.to : line.from], p = out_.vertices[vertex];
        return std::sqrt((p.x - start.x) * (p.x - start.x) + (p.y - start.y) * (p.y - start.y));
    }

    void add_segs() {
        for (const LeafSegs& leaf : leaves_) {
            const auto sub_sector = static_cast<std::uint32_t>(out_.sub_sectors.size());
            SubSector& placed = out_.sub_sectors.emplace_back();
            placed.first = static_cast<std::uint32_t>(out_.segs.size());
            for (std::uint32_t i = 0; i < leaf.edges + leaf.outliers; ++i) {
                RawSeg& s = raw_segs_[leaf.first + i];
                s.first_seg = static_cast<std::uint32_t>(out_.segs.size());
                std::uint32_t from = vertex_of(s.from);
                for (std::uint32_t k = 0; k <= s.cuts; ++k) {
                    const std::uint32_t to = vertex_of(k < s.cuts ? cut_points_[s.first_cut + k] : s.to);
                    out_.segs.push_back({from, to, s.line, no_index, sub_sector, s.left, offset_of(s, from)});
                    from = to;
                }
                if (i + 1 == leaf.edges) placed.edges = static_cast<std::uint32_t>(out_.segs.size()) - placed.first;
            }
            placed.outliers = static_cast<std::uint32_t>(out_.segs.size()) - placed.first - placed.edges;
            placed.sector = sector_of(placed);
        }
    }

    /// Returns the sector with the greatest length of walls. Lines with one sector on both sides are used only if there
    /// are no others, because maps have such lines outside their sector too.
    [[nodiscard]] std::uint32_t sector_of(const SubSector& placed) const {
        std::vector<std::pair<std::uint32_t, double>> shares;
        for (const bool last : {false, true}) {
            for (std::uint32_t i = 0; i < placed.edges + placed.outliers; ++i) {
                const Seg& seg = out_.segs[placed.first + i];
                if (seg.line == no_index) continue;
                const Line& line = map_.lines[seg.line];
                const std::uint32_t sector = map_.sides[seg.left ? line.left : line.right].sector;
                const std::uint16_t behind = seg.left ? line.right : line.left;
                if (!last && behind != no_side && map_.sides[behind].sector == sector) continue;
                const Point p = out_.vertices[seg.from], q = out_.vertices[seg.to];
                const double length = std::sqrt((p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y));
                const auto known = std::find_if(shares.begin(), shares.end(),
                                                [&](const auto& share) { return share.first == sector; });
                if (known == shares.end()) {
                    shares.emplace_back(sector, length);
                } else {
                    known->second += length;
                }
            }
            if (!shares.empty()) break;
        }
        return std::max_element(shares.begin(), shares.end(),
                                [](const auto& a, const auto& b) { return a.second < b.second; })
            ->first;
    }

    void link_partners() {
        std::vector<std::uint32_t> right, left;
        for (std::size_t n = 0; n < tree_.nodes.size(); ++n) {
            const std::uint32_t first = point_begin_[n], count = point_begin_[n + 1] - first;
            if (count == 0) continue;
            right.assign(count, no_index);
            left.assign(count, no_index);
            for (std::uint32_t k = node_begin_[n]; k < node_begin_[n + 1]; ++k) {
                const RawSeg& s = raw_segs_[by_node_[k]];
                for (std::uint32_t i = 0; i <= s.cuts; ++i)
                    (s.along ? right[s.position - first + i] : left[s.position - first - 1 - i]) = s.first_seg + i;
            }
            for (std::uint32_t i = 0; i < count; ++i) {
                if (right[i] == no_index || left[i] == no_index) continue;
                out_.segs[right[i]].partner = left[i];
                out_.segs[left[i]].partner = right[i];
            }
        }
    }

    void add_nodes() {
        std::vector<PlanBox> leaf_boxes(out_.sub_sectors.size());
        for (const Seg& seg : out_.segs) {
            leaf_boxes[seg.sub_sector].add(out_.vertices[seg.from]);
            leaf_boxes[seg.sub_sector].add(out_.vertices[seg.to]);
        }
        const std::size_t count = tree_.nodes.size();
        for (std::size_t n = count; n-- > 0;) {
            const RawNode& raw = tree_.nodes[n];
            const ExactLine& line = line_of(raw.plane);
            Node& node = out_.nodes.emplace_back();
            node = {line.x, line.y, line.dx, line.dy, {}, {}};
            for (const int side : {0, 1}) {
                const std::uint32_t child = raw.children[side];
                if ((child & Node::leaf_bit) != 0) {
                    node.children[side] = child;
                    node.boxes[side] = leaf_boxes[child & ~Node::leaf_bit];
                } else {
                    node.children[side] = static_cast<std::uint32_t>(count - 1 - child);
                    node.boxes[side] = out_.nodes[node.children[side]].boxes[0];
                    node.boxes[side].add(out_.nodes[node.children[side]].boxes[1]);
                }
            }
        }
    }

    void count_stats() {
        BspStats& stats = out_.stats;
        for (const Line& line : map_.lines) {
            if (map_.vertices[line.from] == map_.vertices[line.to]) continue;
            ++stats.lines;
            stats.sides += (line.right != no_side ? 1u : 0u) + (line.left != no_side ? 1u : 0u);
        }
        stats.wall_segs = tree_.pieces.size();
        stats.splits = stats.wall_segs - stats.sides;
        for (const Seg& seg : out_.segs) stats.minisegs += seg.line == no_index ? 1 : 0;
        std::size_t sum = 0;
        for (const RawLeaf& leaf : tree_.leaves) {
            sum += leaf.depth;
            stats.worst_depth = std::max<std::size_t>(stats.worst_depth, leaf.depth);
        }
        stats.mean_depth = static_cast<double>(sum) / static_cast<double>(tree_.leaves.size());
    }
};

}  // namespace

LevelBsp lay_out(const Map& map, RawTree&& tree) { return Layout(map, tree).run(); }

}  // namespace fase::level
