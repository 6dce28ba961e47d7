/// Builds the tree: chooses planes, cuts polygons, then finds out which leaves are solid.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fase/level/polygon_bsp.hpp"

namespace fase::level {
namespace {

using Piece = PolygonBsp::Piece;
using CutPlane = PolygonBsp::CutPlane;
using Node = PolygonBsp::Node;
using Inside = PolygonBsp::Inside;

constexpr double max_coordinate = 1e9;
constexpr std::size_t max_triangles = std::size_t{1} << 28;
constexpr std::uint32_t greatest_depth = 4096;

std::optional<Error> mistake_in(const TriangleMesh& mesh, const PolygonBspOptions& options) {
    const auto bad = [](std::string where, std::string problem) {
        return Error{Status::BadArgument, std::move(where), std::move(problem), {}};
    };
    if (mesh.indices.size() % 3 != 0)
        return bad("indices", fmt::format("found {}, need a multiple of three", mesh.indices.size()));
    if (mesh.indices.size() / 3 > max_triangles)
        return Error{Status::OutOfRange,
                     "indices",
                     fmt::format("found {} triangles, need at most {}", mesh.indices.size() / 3, max_triangles),
                     {}};
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        if (mesh.indices[i] >= mesh.positions.size())
            return bad(fmt::format("indices[{}]", i),
                       fmt::format("found {}, need one of the {} corners", mesh.indices[i], mesh.positions.size()));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3 p = abs(mesh.positions[i]);
        if (!(std::max({p.x, p.y, p.z}) <= max_coordinate) || !is_finite(p))
            return Error{Status::OutOfRange,
                         fmt::format("positions[{}]", i),
                         fmt::format("found ({}, {}, {}), need numbers within 1e9 m", mesh.positions[i].x,
                                     mesh.positions[i].y, mesh.positions[i].z),
                         {}};
    }
    if (!(options.thickness >= 0) || options.thickness > max_coordinate)
        return bad("PolygonBspOptions.thickness", fmt::format("found {}, need 0 or more metres", options.thickness));
    if (!(options.weights.balance >= 0) || !(options.weights.split >= 0))
        return bad("PolygonBspOptions.weights", "found a negative one, need 0 or more");
    if (options.max_depth < 1 || options.max_depth > greatest_depth)
        return bad("PolygonBspOptions.most_depth",
                   fmt::format("found {}, need 1 to {}", options.max_depth, greatest_depth));
    if (options.candidates == 0) return bad("PolygonBspOptions.candidates", "found 0, need 1 or more");
    return std::nullopt;
}

/// Where a row of corners lies, seen from a plane.
enum class Lie : std::uint8_t { Behind, Before, On, Astride };

}  // namespace

class PolygonBspBuilder {
public:
    PolygonBspBuilder(PolygonBsp& tree, const PolygonBspOptions& options) : tree_(tree), options_(options) {}

    /// False when no triangle has a surface.
    bool build() {
        measure();
        std::vector<std::uint32_t> all = first_pieces();
        if (all.empty()) return false;
        const std::size_t triangles = tree_.mesh_.indices.size() / 3;
        max_pieces_ = options_.max_pieces > 0 ? options_.max_pieces : 16 * triangles + 4096;
        max_pieces_ = std::min<std::size_t>(std::max(max_pieces_, all.size()), std::size_t{1} << 30);
        // Work in hand: a set of pieces, and whose child it becomes.
        std::vector<Task> tasks;
        tasks.push_back({std::move(all), no_parent, 0, 0});
        while (!tasks.empty()) {
            Task task = std::move(tasks.back());
            tasks.pop_back();
            grow(std::move(task), tasks);
        }
        mark_leaves();
        drop_cut_pieces();
        finish_stats();
        return true;
    }

private:
    static constexpr std::uint32_t no_parent = 0xffffffff;
    struct Task {
        std::vector<std::uint32_t> pieces;
        std::uint32_t parent = no_parent;
        std::uint32_t side = 0;
        std::uint32_t depth = 0;
    };

    PolygonBsp& tree_;
    const PolygonBspOptions& options_;
    std::size_t max_pieces_ = 0, live_pieces_ = 0, splits_ = 0;
    std::vector<CutPlane> planes_;             ///< by triangle
    std::vector<std::uint32_t> parents_;       ///< by node
    std::vector<std::uint32_t> leaf_parents_;  ///< by leaf
    std::vector<std::uint32_t> leaf_depths_;
    std::vector<Vec3d> before_, behind_;  ///< of split(), reused

    void measure() {
        Vec3d lo{1e300, 1e300, 1e300}, hi{-1e300, -1e300, -1e300};
        for (const std::uint32_t index : tree_.mesh_.indices) {
            lo = min(lo, to_double(tree_.mesh_.positions[index]));
            hi = max(hi, to_double(tree_.mesh_.positions[index]));
        }
        tree_.lo_ = lo;
        tree_.hi_ = hi;
        const Vec3d most = max(abs(lo), abs(hi));
        tree_.thickness_ = options_.thickness > 0 ? options_.thickness : std::max({most.x, most.y, most.z}) * 0x1p-20;
    }

    std::vector<std::uint32_t> first_pieces() {
        const std::size_t count = tree_.mesh_.indices.size() / 3;
        std::vector<std::uint32_t> all;
        planes_.resize(count);
        for (std::uint32_t t = 0; t < count; ++t) {
            const TriangleCorners corners = corners_of(tree_.mesh_, t);
            const Vec3d normal = normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
            if (normal == Vec3d{}) {
                ++tree_.stats_.dropped;
                continue;
            }
            // Through the middle: no corner is then far off by rounding.
            planes_[t] = {normal, dot(normal, corners[0] + corners[1] + corners[2]) / 3};
            all.push_back(static_cast<std::uint32_t>(tree_.pieces_.size()));
            tree_.pieces_.push_back({t, static_cast<std::uint32_t>(tree_.corners_.size()), 3});
            tree_.corners_.insert(tree_.corners_.end(), corners.begin(), corners.end());
        }
        live_pieces_ = all.size();
        return all;
    }

    [[nodiscard]] Lie lie_of(const CutPlane& plane, const Piece& piece) const {
        double least = std::numeric_limits<double>::infinity(), most = -least;
        for (std::uint32_t i = piece.first; i < piece.first + piece.count; ++i) {
            const double side = dot(plane.normal, tree_.corners_[i]) - plane.offset;
            least = std::min(least, side);
            most = std::max(most, side);
        }
        const double thickness = tree_.thickness_;
        const bool goes_before = most > thickness, goes_behind = -least > thickness;
        if (goes_behind) return goes_before ? Lie::Astride : Lie::Behind;
        return goes_before ? Lie::Before : Lie::On;
    }

    /// The plane for a set, by the score that all trees of planes share; what lies on it counts as behind it.
    [[nodiscard]] CutPlane choose(const std::vector<std::uint32_t>& set) const {
        const std::size_t own = std::min(options_.candidates, set.size());
        const auto own_plane = [&](std::size_t i) {
            return planes_[tree_.pieces_[set[i * set.size() / own]].triangle];
        };
        const auto side_at = [&](const CutPlane& plane, std::size_t k) {
            const Lie lie = lie_of(plane, tree_.pieces_[set[k]]);
            return lie == Lie::Astride  ? broad::Side::Astride
                   : lie == Lie::Before ? broad::Side::Above
                                        : broad::Side::Below;
        };
        const auto best = broad::choose_plane(own, own_plane, set.size(), side_at, options_.weights);
        CutPlane plane = own_plane(0);
        if (best) {
            plane = best->plane;
        } else {
            // Convex: the plane that takes most away; sides of many pieces, as boxes have, are gone in a few levels.
            std::size_t most = 0;
            for (std::size_t i = 0; i < own; ++i) {
                std::size_t on = 0;
                for (const std::uint32_t p : set) on += lie_of(own_plane(i), tree_.pieces_[p]) == Lie::On ? 1 : 0;
                if (on > most) plane = own_plane(i);
                most = std::max(most, on);
            }
            if (most * options_.few >= set.size()) return plane;
        }
        if (set.size() <= options_.few) return plane;
        Vec3d lo{1e300, 1e300, 1e300}, hi{-1e300, -1e300, -1e300};
        for (const std::uint32_t p : set) {
            for (const Vec3d& corner : tree_.corners(tree_.pieces_[p])) {
                lo = min(lo, corner);
                hi = max(hi, corner);
            }
        }
        const auto across = [&](std::size_t axis) {
            Vec3d normal;
            normal[static_cast<int>(axis)] = 1;
            return CutPlane{normal, 0.5 * dot(lo + hi, normal)};
        };
        const auto other = broad::choose_plane(3, across, set.size(), side_at, options_.weights);
        return other && (!best || other->score < 0.5 * best->score) ? other->plane : plane;
    }

    /// A new piece of the corners; the triangle's.
    std::uint32_t add_piece(std::uint32_t triangle, const std::vector<Vec3d>& corners) {
        const auto first = static_cast<std::uint32_t>(tree_.corners_.size());
        tree_.corners_.insert(tree_.corners_.end(), corners.begin(), corners.end());
        tree_.pieces_.push_back({triangle, first, static_cast<std::uint32_t>(corners.size())});
        return static_cast<std::uint32_t>(tree_.pieces_.size() - 1);
    }

    /// Cuts a piece that lies astride. Corners on the plane belong to both parts, so that no surface is lost.
    void split(const CutPlane& plane, std::uint32_t index, std::vector<std::uint32_t>& behind,
               std::vector<std::uint32_t>& before) {
        const Piece piece = tree_.pieces_[index];
        before_.clear();
        behind_.clear();
        const auto sided = [&](Vec3d p) {
            const double s = dot(plane.normal, p) - plane.offset;
            return std::abs(s) <= tree_.thickness_ ? 0.0 : s;
        };
        for (std::uint32_t i = 0; i < piece.count; ++i) {
            const Vec3d a = tree_.corners_[piece.first + i], b = tree_.corners_[piece.first + (i + 1) % piece.count];
            const double sa = sided(a), sb = sided(b);
            if (sa >= 0) before_.push_back(a);
            if (sa <= 0) behind_.push_back(a);
            if ((sa > 0 && sb < 0) || (sa < 0 && sb > 0)) {
                // From the corner before the plane, so that neighbours get the same point of a shared edge.
                const Vec3d cut = sa > 0 ? a + (b - a) * (sa / (sa - sb)) : b + (a - b) * (sb / (sb - sa));
                before_.push_back(cut);
                behind_.push_back(cut);
            }
        }
        before.push_back(add_piece(piece.triangle, before_));
        behind.push_back(add_piece(piece.triangle, behind_));
        ++splits_;
        ++live_pieces_;
    }

    /// Tells a node where its child is.
    void hang(const Task& task, std::uint32_t child) {
        if (task.parent != no_parent) tree_.nodes_[task.parent].children[task.side] = child;
    }

    void add_leaf(const Task& task) {
        PolygonBsp::Leaf leaf;
        if (!task.pieces.empty()) {
            leaf = {Inside::Mixed, static_cast<std::uint32_t>(tree_.lists_.size()),
                    static_cast<std::uint32_t>(task.pieces.size())};
            tree_.lists_.insert(tree_.lists_.end(), task.pieces.begin(), task.pieces.end());
        }
        hang(task, Node::leaf_bit | static_cast<std::uint32_t>(tree_.leaves_.size()));
        tree_.leaves_.push_back(leaf);
        leaf_parents_.push_back(task.parent);
        leaf_depths_.push_back(task.depth);
    }

    /// Makes a leaf or a node of a set; what lies on either side becomes new work.
    void grow(Task&& task, std::vector<Task>& tasks) {
        if (task.pieces.empty() || task.depth >= options_.max_depth || live_pieces_ >= max_pieces_)
            return add_leaf(task);
        const CutPlane plane = choose(task.pieces);
        std::vector<std::uint32_t> on;
        Task behind{{}, static_cast<std::uint32_t>(tree_.nodes_.size()), 0, task.depth + 1};
        Task before{{}, behind.parent, 1, task.depth + 1};
        for (const std::uint32_t p : task.pieces) {
            switch (lie_of(plane, tree_.pieces_[p])) {
                case Lie::Behind: behind.pieces.push_back(p); break;
                case Lie::Before: before.pieces.push_back(p); break;
                case Lie::On: on.push_back(p); break;
                case Lie::Astride: split(plane, p, behind.pieces, before.pieces); break;
            }
        }
        hang(task, behind.parent);
        tree_.nodes_.push_back(
            {plane, {0, 0}, static_cast<std::uint32_t>(tree_.lists_.size()), static_cast<std::uint32_t>(on.size())});
        parents_.push_back(task.parent);
        tree_.lists_.insert(tree_.lists_.end(), on.begin(), on.end());
        task.pieces = {};
        tasks.push_back(std::move(before));
        tasks.push_back(std::move(behind));
    }

    /// A place inside a leaf: off the middle of a piece on the plane that made it, half way to the next plane.
    [[nodiscard]] Vec3d place_in(std::uint32_t leaf) const {
        const std::uint32_t parent = leaf_parents_[leaf];
        const Node& node = tree_.nodes_[parent];
        const double way = node.children[1] == (Node::leaf_bit | leaf) ? 1 : -1;
        const Vec3d out = node.plane.normal * way;
        const Vec3d extent = tree_.hi_ - tree_.lo_;
        const double farthest = std::max({extent.x, extent.y, extent.z}) + 4 * tree_.thickness_;
        Vec3d best{};
        double best_room = -1;
        for (std::uint32_t i = node.first; i < node.first + std::min(node.pieces, 8u); ++i) {
            Vec3d middle{};
            const auto corners = tree_.corners(tree_.pieces_[tree_.lists_[i]]);
            for (const Vec3d& corner : corners) middle += corner;
            middle *= 1.0 / double(corners.size());
            middle -= node.plane.normal * (dot(node.plane.normal, middle) - node.plane.offset);
            double room = farthest;
            std::uint32_t from = parent;
            for (std::uint32_t up = parents_[parent]; up != no_parent; from = up, up = parents_[up]) {
                const Node& above = tree_.nodes_[up];
                const double sign = above.children[1] == from ? 1 : -1;
                const double inside = sign * (dot(above.plane.normal, middle) - above.plane.offset);
                const double closing = -sign * dot(above.plane.normal, out);
                if (closing > 0) room = std::min(room, std::max(inside, 0.0) / closing);
            }
            if (room > best_room) {
                best_room = room;
                best = middle + out * (0.5 * room);
            }
        }
        return best;
    }

    void mark_leaves() {
        PolygonBspStats& stats = tree_.stats_;
        tree_.rim_ = rim_of(tree_.mesh_);
        stats.closed = tree_.rim_.empty();
        const auto mark = [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                PolygonBsp::Leaf& leaf = tree_.leaves_[i];
                if (leaf.inside == Inside::Mixed || leaf_parents_[i] == no_parent) continue;
                const int winding = tree_.winding(place_in(static_cast<std::uint32_t>(i)));
                leaf.inside = winding != 0 ? Inside::Solid : Inside::Empty;
            }
        };
        if (options_.tasks != nullptr) {
            parallel_ranges(*options_.tasks, tree_.leaves_.size(), 64, mark);
        } else {
            mark(0, tree_.leaves_.size());
        }
    }

    /// Pieces that were cut again are not needed any more.
    void drop_cut_pieces() {
        std::vector<Piece> pieces;
        std::vector<Vec3d> corners;
        pieces.reserve(tree_.lists_.size());
        for (std::uint32_t& listed : tree_.lists_) {
            Piece piece = tree_.pieces_[listed];
            const auto from = tree_.corners(piece);
            piece.first = static_cast<std::uint32_t>(corners.size());
            corners.insert(corners.end(), from.begin(), from.end());
            listed = static_cast<std::uint32_t>(pieces.size());
            pieces.push_back(piece);
        }
        tree_.pieces_ = std::move(pieces);
        tree_.corners_ = std::move(corners);
        tree_.corners_.shrink_to_fit();
        tree_.lists_.shrink_to_fit();
        tree_.nodes_.shrink_to_fit();
        tree_.leaves_.shrink_to_fit();
    }

    void finish_stats() {
        PolygonBspStats& stats = tree_.stats_;
        stats.triangles = tree_.mesh_.indices.size() / 3;
        stats.pieces = tree_.pieces_.size();
        stats.splits = splits_;
        stats.nodes = tree_.nodes_.size();
        stats.leaves = tree_.leaves_.size();
        std::uint64_t depths = 0;
        for (std::size_t i = 0; i < tree_.leaves_.size(); ++i) {
            const Inside inside = tree_.leaves_[i].inside;
            ++(inside == Inside::Solid ? stats.solid : inside == Inside::Empty ? stats.empty : stats.mixed);
            depths += leaf_depths_[i];
            stats.worst_depth = std::max<std::size_t>(stats.worst_depth, leaf_depths_[i]);
        }
        stats.mean_depth = double(depths) / double(stats.leaves);
        const TriangleMesh& mesh = tree_.mesh_;
        stats.bytes = tree_.nodes_.size() * sizeof(Node) + tree_.leaves_.size() * sizeof(PolygonBsp::Leaf) +
                      tree_.pieces_.size() * (sizeof(Piece) + sizeof(std::uint32_t)) +
                      tree_.corners_.size() * sizeof(Vec3d) + tree_.rim_.size() * sizeof(RimEdge) +
                      mesh.positions.size() * sizeof(Vec3) + mesh.indices.size() * sizeof(std::uint32_t);
    }
};

Result<PolygonBsp> PolygonBsp::build(TriangleMesh mesh, const PolygonBspOptions& options) {
    if (std::optional<Error> mistake = mistake_in(mesh, options)) return *std::move(mistake);
    PolygonBsp tree;
    tree.mesh_ = std::move(mesh);
    if (!PolygonBspBuilder(tree, options).build()) {
        return Error{Status::BadArgument,
                     "indices",
                     fmt::format("found {} triangles, none with a surface, need one", tree.mesh_.indices.size() / 3),
                     {}};
    }
    return tree;
}

}  // namespace fase::level
