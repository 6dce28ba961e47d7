#pragma once
/// A wide tree over the boxes of triangles, with quantised nodes.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "fase/geometry/aabb.hpp"

namespace fase::detail {

/// Eight boxes on a grid of 255 steps an axis around them, each of some triangles or of a child node.
struct MeshNode {
    static constexpr std::uint8_t inner = 255;  ///< as a count: the box is that of a node

    std::array<float, 3> origin{}, step{};
    std::array<std::array<std::uint8_t, 8>, 3> lo{}, hi{};  ///< by axis, by child; lo > hi: no child
    std::array<std::uint32_t, 8> first{};                   ///< the first triangle, or the node
    std::array<std::uint8_t, 8> count{};                    ///< of triangles, or `inner`

    /// Returns the box of a child; it contains all below it.
    [[nodiscard]] Aabb box(std::size_t child) const {
        Aabb result;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const int a = static_cast<int>(axis);
            result.lo[a] = origin[axis] + step[axis] * static_cast<float>(lo[axis][child]);
            result.hi[a] = origin[axis] + step[axis] * static_cast<float>(hi[axis][child]);
        }
        return result;
    }
};

/// A tree over triangles, at most four in a leaf. It stores no triangles: it tells in which order to store them.
class MeshTree {
public:
    static constexpr std::size_t max_in_leaf = 4;

    /// Builds the tree over `boxes` (finite); returns their indices in the order of the leaves. O(n log n) by binned
    /// splits of the longest axis. Source: Wald 2007, On fast construction of SAH-based bounding volume hierarchies.
    std::vector<std::uint32_t> build(std::span<const Aabb> boxes);

    /// Calls visit(triangle) for each triangle whose leaf box touches `box`, in the order of the tree.
    template <class F> void visit(const Aabb& box, F&& visit) const {
        if (nodes_.empty()) return;
        std::array<std::uint32_t, max_stack> stack;
        std::size_t size = 0;
        stack[size++] = 0;
        while (size > 0) {
            const MeshNode& node = nodes_[stack[--size]];
            const unsigned hits = touched(node, box);
            for (std::size_t k = 0; k < 8; ++k) {
                if ((hits >> k & 1u) == 0) continue;
                if (node.count[k] == MeshNode::inner) {
                    stack[size++] = node.first[k];
                    continue;
                }
                for (std::uint32_t i = 0; i < node.count[k]; ++i) visit(node.first[k] + i);
            }
        }
    }

    /// A ray, or a box that moves along one: `lo` and `hi` are its corners relative to the origin of the ray.
    struct Path {
        Vec3d origin, direction;  ///< distances are in multiples of the direction's length
        Vec3 lo{}, hi{};
    };

    /// Calls visit(triangle) for the triangles whose leaf boxes the path enters, leaves from near to far. It returns
    /// the distance up to which triangles are still of interest, which never grows; it begins with `limit`.
    template <class F> void visit_along(const Path& path, float limit, F&& visit) const {
        const PathInFloat in_float(path);
        visit_in_order(
            limit, [&](const MeshNode& node, Entries& entries) { in_float.enter(node, entries); }, visit);
    }

    /// Visits leaves from near to far: `entry(box)` returns the distance at which a box is entered, infinite for never;
    /// `visit(triangle)` returns the distance up to which boxes are still of interest, which never grows.
    template <class Entry, class F> void visit_nearest(float limit, Entry&& entry, F&& visit) const {
        visit_in_order(
            limit,
            [&](const MeshNode& node, Entries& entries) {
                for (std::size_t k = 0; k < 8; ++k)
                    entries[k] = node.lo[0][k] <= node.hi[0][k] ? entry(node.box(k)) : Aabb::infinity;
            },
            visit);
    }

    [[nodiscard]] Aabb bounds() const { return bounds_; }
    [[nodiscard]] std::span<const MeshNode> nodes() const { return nodes_; }
    [[nodiscard]] std::size_t bytes() const { return nodes_.capacity() * sizeof(MeshNode); }

private:
    /// Splits stop to choose planes at this depth and halve the lists, so that no tree is deeper than max_depth.
    static constexpr int max_chosen_depth = 48, max_depth = max_chosen_depth + 32;
    static constexpr std::size_t max_stack = 7 * max_depth + 8;

    /// The distances at which the children of a node are entered; infinite: never.
    using Entries = std::array<float, 8>;

    /// A path for tests of eight boxes at a time, in float. Entries are too early by rounding, never too late.
    class PathInFloat {
    public:
        explicit PathInFloat(const Path& path) : path_(path) {
            for (int axis = 0; axis < 3; ++axis) {
                constexpr double flat = 1e-30;
                const double d = path.direction[axis];
                inverse_[axis] = static_cast<float>(1 / (d < 0 ? (d > -flat ? -flat : d) : (d < flat ? flat : d)));
            }
        }
        void enter(const MeshNode& node, Entries& entries) const {
            constexpr float slack = 1e-6f;
            Entries far;
            entries.fill(0);
            far.fill(Aabb::infinity);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const int a = static_cast<int>(axis);
                const float base = static_cast<float>(double(node.origin[axis]) - path_.origin[a]);
                const float step = node.step[axis], inverse = inverse_[a];
                const float low = base - path_.hi[a], high = base - path_.lo[a];
                const float around = slack * ((base < 0 ? -base : base) + 255 * step + (path_.hi[a] - path_.lo[a]));
                for (std::size_t k = 0; k < 8; ++k) {
                    const float x = (low - around + step * static_cast<float>(node.lo[axis][k])) * inverse;
                    const float y = (high + around + step * static_cast<float>(node.hi[axis][k])) * inverse;
                    const float first = x < y ? x : y, last = x < y ? y : x;
                    entries[k] = entries[k] < first ? first : entries[k];
                    far[k] = last < far[k] ? last : far[k];
                }
            }
            for (std::size_t k = 0; k < 8; ++k) {
                const bool enters =
                    (node.lo[0][k] <= node.hi[0][k]) & (entries[k] * (1 - slack) <= far[k] * (1 + slack));
                entries[k] = enters ? entries[k] * (1 - slack) : Aabb::infinity;
            }
        }

    private:
        const Path& path_;
        Vec3 inverse_;
    };

    template <class Enter, class F> void visit_in_order(float limit, Enter&& enter, F&& visit) const {
        struct Item {
            float distance;
            std::uint32_t node;
        };
        if (nodes_.empty()) return;
        std::array<Item, max_stack> stack;
        std::size_t size = 0;
        stack[size++] = {0, 0};
        while (size > 0) {
            const Item item = stack[--size];
            if (!(item.distance <= limit)) continue;
            const MeshNode& node = nodes_[item.node];
            Entries entries;
            enter(node, entries);
            std::array<std::pair<float, std::size_t>, 8> order;
            std::size_t found = 0;
            for (std::size_t k = 0; k < 8; ++k) {
                const float distance = entries[k];
                if (!(distance <= limit) || distance == Aabb::infinity) continue;
                std::size_t at = found++;
                for (; at > 0 && order[at - 1].first < distance; --at) order[at] = order[at - 1];
                order[at] = {distance, k};  // the farthest first
            }
            for (std::size_t i = found; i-- > 0;) {
                const auto [distance, k] = order[i];
                if (node.count[k] == MeshNode::inner || !(distance <= limit)) continue;
                for (std::uint32_t t = 0; t < node.count[k]; ++t) limit = visit(node.first[k] + t);
            }
            for (std::size_t i = 0; i < found; ++i)
                if (node.count[order[i].second] == MeshNode::inner)
                    stack[size++] = {order[i].first, node.first[order[i].second]};
        }
    }

    /// Returns a bit for each child whose box touches `box`.
    static unsigned touched(const MeshNode& node, const Aabb& box) {
        std::array<std::uint8_t, 8> hit{};
        for (std::size_t k = 0; k < 8; ++k) hit[k] = node.lo[0][k] <= node.hi[0][k] ? 1 : 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const int a = static_cast<int>(axis);
            const float origin = node.origin[axis], step = node.step[axis], low = box.lo[a], high = box.hi[a];
            for (std::size_t k = 0; k < 8; ++k) {
                const float lo = origin + step * static_cast<float>(node.lo[axis][k]);
                const float hi = origin + step * static_cast<float>(node.hi[axis][k]);
                hit[k] = static_cast<std::uint8_t>(hit[k] & ((lo <= high) & (low <= hi) ? 1 : 0));
            }
        }
        unsigned bits = 0;
        for (std::size_t k = 0; k < 8; ++k) bits |= unsigned{hit[k]} << k;
        return bits;
    }

    std::vector<MeshNode> nodes_;
    Aabb bounds_;
};

}  // namespace fase::detail
