/// Builds the tree: chooses planes, splits polygons, then classifies the leaves.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fase/core/no_index.hpp"
#include "fase/level/polygon_bsp.hpp"

namespace fase::level {
namespace {

using Piece = PolygonBsp::Piece;
using CutPlane = PolygonBsp::CutPlane;
using Node = PolygonBsp::Node;
using Inside = PolygonBsp::Inside;

constexpr double max_coordinate = 1e9;
constexpr std::size_t max_triangles = std::size_t{1} << 28;
constexpr std::uint32_t depth_limit = 4096;

std::optional<Error> validate(const TriangleMesh& mesh, const PolygonBspOptions& options) {
    const auto bad = [](std::string where, std::string problem) {
        return Error{Status::BadArgument, std::move(where), std::move(problem), {}};
    };
    if (mesh.indices.size() % 3 != 0)
        return bad("indices", fmt::format("found {} indices; expected a multiple of three", mesh.indices.size()));
    if (mesh.indices.size() / 3 > max_triangles)
        return Error{Status::OutOfRange,
                     "indices",
                     fmt::format("found {} triangles; expected at most {}", mesh.indices.size() / 3, max_triangles),
                     {}};
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        if (mesh.indices[i] >= mesh.positions.size())
            return bad(fmt::format("indices[{}]", i),
                       fmt::format("found corner {}; expected less than {}", mesh.indices[i], mesh.positions.size()));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3 p = abs(mesh.positions[i]);
        if (!(std::max({p.x, p.y, p.z}) <= max_coordinate) || !is_finite(p))
            return Error{Status::OutOfRange,
                         fmt::format("positions[{}]", i),
                         fmt::format("found ({}, {}, {}); expected numbers within 1e9 m", mesh.positions[i].x,
                                     mesh.positions[i].y, mesh.positions[i].z),
                         {}};
    }
    if (!(options.thickness >= 0) || options.thickness > max_coordinate)
        return bad("PolygonBspOptions.thickness",
                   fmt::format("found {}; expected 0 or more metres", options.thickness));
    if (!(options.weights.balance >= 0) || !(options.weights.split >= 0))
        return bad("PolygonBspOptions.weights", "found a negative weight; expected 0 or more");
    if (options.max_depth < 1 || options.max_depth > depth_limit)
        return bad("PolygonBspOptions.max_depth",
                   fmt::format("found {}; expected 1 to {}", options.max_depth, depth_limit));
    if (options.candidates == 0) return bad("PolygonBspOptions.candidates", "found 0; expected 1 or more");
    return std::nullopt;
}

/// The position of a polygon relative to a plane.
enum class PlaneSide : std::uint8_t { Back, Front, On, Straddling };

}  // namespace

class PolygonBspBuilder {
public:
    PolygonBspBuilder(PolygonBsp& tree, const PolygonBspOptions& options) : tree_(tree), options_(options) {}

    /// Builds the tree. Returns false if no triangle has an area.
    bool build() {
        measure();
        std::vector<std::uint32_t> all = first_pieces();
        if (all.empty()) return false;
        const std::size_t triangles = tree_.mesh_.indices.size() / 3;
        max_pieces_ = options_.max_pieces > 0 ? options_.max_pieces : 16 * triangles + 4096;
        max_pieces_ = std::min<std::size_t>(std::max(max_pieces_, all.size()), std::size_t{1} << 30);
        // Pending sets of pieces, each with the parent of its node.
        std::vector<Task> tasks;
        tasks.push_back({std::move(all), no_index, 0, 0});
        while (!tasks.empty()) {
            Task task = std::move(tasks.back());
            tasks.pop_back();
            add_node(std::move(task), tasks);
        }
        classify_leaves();
        remove_split_pieces();
        fill_stats();
        return true;
    }

private:
    struct Task {
        std::vector<std::uint32_t> pieces;
        std::uint32_t parent = no_index;
        std::uint32_t side = 0;
        std::uint32_t depth = 0;
    };

    PolygonBsp& tree_;
    const PolygonBspOptions& options_;
    std::size_t max_pieces_ = 0, active_pieces_ = 0, splits_ = 0;
    std::vector<CutPlane> planes_;             ///< by triangle
    std::vector<std::uint32_t> parents_;       ///< by node
    std::vector<std::uint32_t> leaf_parents_;  ///< by leaf
    std::vector<std::uint32_t> leaf_depths_;
    std::vector<Vec3d> front_, back_;  ///< buffers of split()

    void measure() {
        Vec3d lo{1e300, 1e300, 1e300}, hi{-1e300, -1e300, -1e300};
        for (const std::uint32_t index : tree_.mesh_.indices) {
            lo = min(lo, to_double(tree_.mesh_.positions[index]));
            hi = max(hi, to_double(tree_.mesh_.positions[index]));
        }
        tree_.lo_ = lo;
        tree_.hi_ = hi;
        const Vec3d extent = max(abs(lo), abs(hi));
        tree_.thickness_ =
            options_.thickness > 0 ? options_.thickness : std::max({extent.x, extent.y, extent.z}) * 0x1p-20;
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
            // Through the centroid, so that rounding moves no corner far off the plane.
            planes_[t] = {normal, dot(normal, corners[0] + corners[1] + corners[2]) / 3};
            all.push_back(static_cast<std::uint32_t>(tree_.pieces_.size()));
            tree_.pieces_.push_back({t, static_cast<std::uint32_t>(tree_.corners_.size()), 3});
            tree_.corners_.insert(tree_.corners_.end(), corners.begin(), corners.end());
        }
        active_pieces_ = all.size();
        return all;
    }

    [[nodiscard]] PlaneSide side_of(const CutPlane& plane, const Piece& piece) const {
        double min_side = std::numeric_limits<double>::infinity(), max_side = -min_side;
        for (std::uint32_t i = piece.first; i < piece.first + piece.count; ++i) {
            const double side = dot(plane.normal, tree_.corners_[i]) - plane.offset;
            min_side = std::min(min_side, side);
            max_side = std::max(max_side, side);
        }
        const double thickness = tree_.thickness_;
        const bool in_front = max_side > thickness, behind = -min_side > thickness;
        if (behind) return in_front ? PlaneSide::Straddling : PlaneSide::Back;
        return in_front ? PlaneSide::Front : PlaneSide::On;
    }

    /// Returns the plane for a set, by the score that all plane trees share; pieces on it count as behind it.
    [[nodiscard]] CutPlane choose(const std::vector<std::uint32_t>& set) const {
        const std::size_t own = std::min(options_.candidates, set.size());
        const auto own_plane = [&](std::size_t i) {
            return planes_[tree_.pieces_[set[i * set.size() / own]].triangle];
        };
        const auto side_at = [&](const CutPlane& plane, std::size_t k) {
            const PlaneSide side = side_of(plane, tree_.pieces_[set[k]]);
            return side == PlaneSide::Straddling ? broad::Side::Straddling
                   : side == PlaneSide::Front    ? broad::Side::Above
                                                 : broad::Side::Below;
        };
        const auto best = broad::choose_plane(own, own_plane, set.size(), side_at, options_.weights);
        CutPlane plane = own_plane(0);
        if (best) {
            plane = best->plane;
        } else {
            // A convex set: takes the plane with most pieces on it; this removes sides of many pieces, as in boxes, in
            // a few levels.
            std::size_t max_on = 0;
            for (std::size_t i = 0; i < own; ++i) {
                std::size_t on = 0;
                for (const std::uint32_t p : set)
                    on += side_of(own_plane(i), tree_.pieces_[p]) == PlaneSide::On ? 1 : 0;
                if (on > max_on) plane = own_plane(i);
                max_on = std::max(max_on, on);
            }
            if (max_on * options_.small_set >= set.size()) return plane;
        }
        if (set.size() <= options_.small_set) return plane;
        Vec3d lo{1e300, 1e300, 1e300}, hi{-1e300, -1e300, -1e300};
        for (const std::uint32_t p : set) {
            for (const Vec3d& corner : tree_.corners(tree_.pieces_[p])) {
                lo = min(lo, corner);
                hi = max(hi, corner);
            }
        }
        const auto middle_plane = [&](std::size_t axis) {
            Vec3d normal;
            normal[static_cast<int>(axis)] = 1;
            return CutPlane{normal, 0.5 * dot(lo + hi, normal)};
        };
        const auto other = broad::choose_plane(3, middle_plane, set.size(), side_at, options_.weights);
        return other && (!best || other->score < 0.5 * best->score) ? other->plane : plane;
    }

    /// Adds a piece of a triangle and returns its index.
    std::uint32_t add_piece(std::uint32_t triangle, const std::vector<Vec3d>& corners) {
        const auto first = static_cast<std::uint32_t>(tree_.corners_.size());
        tree_.corners_.insert(tree_.corners_.end(), corners.begin(), corners.end());
        tree_.pieces_.push_back({triangle, first, static_cast<std::uint32_t>(corners.size())});
        return static_cast<std::uint32_t>(tree_.pieces_.size() - 1);
    }

    /// Splits a straddling piece. Corners on the plane belong to both parts, so that no area is lost.
    void split(const CutPlane& plane, std::uint32_t index, std::vector<std::uint32_t>& back,
               std::vector<std::uint32_t>& front) {
        const Piece piece = tree_.pieces_[index];
        front_.clear();
        back_.clear();
        const auto side_of_corner = [&](Vec3d p) {
            const double s = dot(plane.normal, p) - plane.offset;
            return std::abs(s) <= tree_.thickness_ ? 0.0 : s;
        };
        for (std::uint32_t i = 0; i < piece.count; ++i) {
            const Vec3d a = tree_.corners_[piece.first + i], b = tree_.corners_[piece.first + (i + 1) % piece.count];
            const double sa = side_of_corner(a), sb = side_of_corner(b);
            if (sa >= 0) front_.push_back(a);
            if (sa <= 0) back_.push_back(a);
            if ((sa > 0 && sb < 0) || (sa < 0 && sb > 0)) {
                // From the corner in front of the plane, so that neighbours get the same point on a shared edge.
                const Vec3d crossing = sa > 0 ? a + (b - a) * (sa / (sa - sb)) : b + (a - b) * (sb / (sb - sa));
                front_.push_back(crossing);
                back_.push_back(crossing);
            }
        }
        front.push_back(add_piece(piece.triangle, front_));
        back.push_back(add_piece(piece.triangle, back_));
        ++splits_;
        ++active_pieces_;
    }

    /// Links a node to its child.
    void link_child(const Task& task, std::uint32_t child) {
        if (task.parent != no_index) tree_.nodes_[task.parent].children[task.side] = child;
    }

    void add_leaf(const Task& task) {
        PolygonBsp::Leaf leaf;
        if (!task.pieces.empty()) {
            leaf = {Inside::Mixed, static_cast<std::uint32_t>(tree_.lists_.size()),
                    static_cast<std::uint32_t>(task.pieces.size())};
            tree_.lists_.insert(tree_.lists_.end(), task.pieces.begin(), task.pieces.end());
        }
        link_child(task, Node::leaf_bit | static_cast<std::uint32_t>(tree_.leaves_.size()));
        tree_.leaves_.push_back(leaf);
        leaf_parents_.push_back(task.parent);
        leaf_depths_.push_back(task.depth);
    }

    /// Adds a leaf or a node for a set; the parts on either side become new tasks.
    void add_node(Task&& task, std::vector<Task>& tasks) {
        if (task.pieces.empty() || task.depth >= options_.max_depth || active_pieces_ >= max_pieces_)
            return add_leaf(task);
        const CutPlane plane = choose(task.pieces);
        std::vector<std::uint32_t> on;
        Task back{{}, static_cast<std::uint32_t>(tree_.nodes_.size()), 0, task.depth + 1};
        Task front{{}, back.parent, 1, task.depth + 1};
        for (const std::uint32_t p : task.pieces) {
            switch (side_of(plane, tree_.pieces_[p])) {
                case PlaneSide::Back: back.pieces.push_back(p); break;
                case PlaneSide::Front: front.pieces.push_back(p); break;
                case PlaneSide::On: on.push_back(p); break;
                case PlaneSide::Straddling: split(plane, p, back.pieces, front.pieces); break;
            }
        }
        link_child(task, back.parent);
        tree_.nodes_.push_back(
            {plane, {0, 0}, static_cast<std::uint32_t>(tree_.lists_.size()), static_cast<std::uint32_t>(on.size())});
        parents_.push_back(task.parent);
        tree_.lists_.insert(tree_.lists_.end(), on.begin(), on.end());
        task.pieces = {};
        tasks.push_back(std::move(front));
        tasks.push_back(std::move(back));
    }

    /// Returns a point inside a leaf: from the middle of a piece on its parent's plane, half way to the next plane.
    [[nodiscard]] Vec3d sample_point(std::uint32_t leaf) const {
        const std::uint32_t parent = leaf_parents_[leaf];
        const Node& node = tree_.nodes_[parent];
        const double sign_out = node.children[1] == (Node::leaf_bit | leaf) ? 1 : -1;
        const Vec3d out = node.plane.normal * sign_out;
        const Vec3d extent = tree_.hi_ - tree_.lo_;
        const double farthest = std::max({extent.x, extent.y, extent.z}) + 4 * tree_.thickness_;
        Vec3d best{};
        double best_distance = -1;
        for (std::uint32_t i = node.first; i < node.first + std::min(node.pieces, 8u); ++i) {
            Vec3d middle{};
            const auto corners = tree_.corners(tree_.pieces_[tree_.lists_[i]]);
            for (const Vec3d& corner : corners) middle += corner;
            middle *= 1.0 / double(corners.size());
            middle -= node.plane.normal * (dot(node.plane.normal, middle) - node.plane.offset);
            double distance = farthest;
            std::uint32_t from = parent;
            for (std::uint32_t up = parents_[parent]; up != no_index; from = up, up = parents_[up]) {
                const Node& above = tree_.nodes_[up];
                const double sign = above.children[1] == from ? 1 : -1;
                const double inside = sign * (dot(above.plane.normal, middle) - above.plane.offset);
                const double closing = -sign * dot(above.plane.normal, out);
                if (closing > 0) distance = std::min(distance, std::max(inside, 0.0) / closing);
            }
            if (distance > best_distance) {
                best_distance = distance;
                best = middle + out * (0.5 * distance);
            }
        }
        return best;
    }

    void classify_leaves() {
        PolygonBspStats& stats = tree_.stats_;
        tree_.boundary_ = boundary_of(tree_.mesh_);
        stats.closed = tree_.boundary_.empty();
        const auto classify = [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                PolygonBsp::Leaf& leaf = tree_.leaves_[i];
                if (leaf.inside == Inside::Mixed || leaf_parents_[i] == no_index) continue;
                const int winding = tree_.winding(sample_point(static_cast<std::uint32_t>(i)));
                leaf.inside = winding != 0 ? Inside::Solid : Inside::Empty;
            }
        };
        if (options_.tasks != nullptr) {
            parallel_ranges(*options_.tasks, tree_.leaves_.size(), 64, classify);
        } else {
            classify(0, tree_.leaves_.size());
        }
    }

    /// Removes pieces that were split further.
    void remove_split_pieces() {
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

    void fill_stats() {
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
                      tree_.corners_.size() * sizeof(Vec3d) + tree_.boundary_.size() * sizeof(BoundaryEdge) +
                      mesh.positions.size() * sizeof(Vec3) + mesh.indices.size() * sizeof(std::uint32_t);
    }
};

Result<PolygonBsp> PolygonBsp::build(TriangleMesh mesh, const PolygonBspOptions& options) {
    if (std::optional<Error> error = validate(mesh, options)) return *std::move(error);
    PolygonBsp tree;
    tree.mesh_ = std::move(mesh);
    if (!PolygonBspBuilder(tree, options).build()) {
        return Error{Status::BadArgument,
                     "indices",
                     fmt::format("found {} triangles without area; expected at least one with area",
                                 tree.mesh_.indices.size() / 3),
                     {}};
    }
    return tree;
}

}  // namespace fase::level
