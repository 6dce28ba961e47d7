/// Building the tree of a mesh.
#include "fase/geometry/detail/mesh_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace fase::detail {
namespace {

/// A part of the list of triangles.
struct Part {
    std::uint32_t begin = 0, end = 0;
    Aabb box;  ///< of the triangles
    int depth = 0;
    [[nodiscard]] std::uint32_t size() const { return end - begin; }
};

class Splitter {
public:
    explicit Splitter(std::span<const Aabb> boxes) : boxes_(boxes), order_(boxes.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
    }

    [[nodiscard]] Part whole() const { return part_of(0, static_cast<std::uint32_t>(order_.size()), 0); }

    /// Splits a part of two triangles or more. `halve`: by count instead of by the best plane.
    [[nodiscard]] std::array<Part, 2> split(const Part& part, bool halve) {
        Aabb centres;
        for (std::uint32_t i = part.begin; i < part.end; ++i) {
            const Vec3 c = centre_of(order_[i]);
            centres = merge(centres, {c, c});
        }
        const Vec3 size = centres.hi - centres.lo;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        std::uint32_t middle = part.begin;
        if (!halve && size[axis] > 0) middle = partition(part, axis, centres.lo[axis], size[axis]);
        if (middle == part.begin || middle == part.end) middle = halves(part, axis);
        return {part_of(part.begin, middle, part.depth + 1), part_of(middle, part.end, part.depth + 1)};
    }

    std::vector<std::uint32_t>& order() { return order_; }

private:
    static constexpr std::size_t bins = 16;

    [[nodiscard]] Vec3 centre_of(std::uint32_t triangle) const { return middle(boxes_[triangle]); }
    [[nodiscard]] static Vec3 middle(const Aabb& box) { return (box.lo + box.hi) * 0.5f; }
    [[nodiscard]] static float half_area(const Aabb& box) {
        const Vec3 e = box.hi - box.lo;
        return e.x * e.y + e.y * e.z + e.z * e.x;
    }
    [[nodiscard]] Part part_of(std::uint32_t begin, std::uint32_t end, int depth) const {
        Part part{begin, end, {}, depth};
        for (std::uint32_t i = begin; i < end; ++i) part.box = merge(part.box, boxes_[order_[i]]);
        return part;
    }
    [[nodiscard]] static std::size_t bin_of(float at, float low, float scale) {
        const auto bin = static_cast<int>((at - low) * scale);
        return static_cast<std::size_t>(std::clamp(bin, 0, int(bins) - 1));
    }

    /// Divides a part at the plane between two bins that costs least; returns where the second half begins.
    std::uint32_t partition(const Part& part, int axis, float low, float size) {
        const float scale = float(bins) / size;
        if (!std::isfinite(scale)) return part.begin;
        std::array<Aabb, bins> box;
        std::array<std::uint32_t, bins> count{};
        for (std::uint32_t i = part.begin; i < part.end; ++i) {
            const std::size_t bin = bin_of(centre_of(order_[i])[axis], low, scale);
            box[bin] = merge(box[bin], boxes_[order_[i]]);
            ++count[bin];
        }
        std::array<float, bins> cost{};
        Aabb sum;
        std::uint32_t number = 0;
        for (std::size_t i = 0; i + 1 < bins; ++i) {
            sum = merge(sum, box[i]);
            number += count[i];
            cost[i] = number ? half_area(sum) * float(number) : 0;
        }
        sum = {};
        number = 0;
        std::size_t best = 0;
        float least = std::numeric_limits<float>::infinity();
        for (std::size_t i = bins - 1; i-- > 0;) {
            sum = merge(sum, box[i + 1]);
            number += count[i + 1];
            if (number == 0 || number == part.size()) continue;
            const float here = cost[i] + half_area(sum) * float(number);
            if (here < least) {
                least = here;
                best = i;
            }
        }
        const auto end = std::partition(order_.begin() + part.begin, order_.begin() + part.end, [&](std::uint32_t t) {
            return bin_of(centre_of(t)[axis], low, scale) <= best;
        });
        return static_cast<std::uint32_t>(end - order_.begin());
    }

    std::uint32_t halves(const Part& part, int axis) {
        const std::uint32_t middle = part.begin + part.size() / 2;
        std::nth_element(order_.begin() + part.begin, order_.begin() + middle, order_.begin() + part.end,
                         [&](std::uint32_t a, std::uint32_t b) {
                             const float x = centre_of(a)[axis], y = centre_of(b)[axis];
                             return x != y ? x < y : a < b;
                         });
        return middle;
    }

    std::span<const Aabb> boxes_;
    std::vector<std::uint32_t> order_;
};

/// Returns the smallest step for which origin + 255 * step reaches `high`.
float step_of(float origin, float high) {
    if (!(high > origin)) return 0;
    float step = (high - origin) / 255;
    while (origin + step * 255 < high) step = std::nextafter(step, std::numeric_limits<float>::infinity());
    return step;
}

void quantise(MeshNode& node, std::size_t child, const Aabb& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int a = static_cast<int>(axis);
        const float origin = node.origin[axis], step = node.step[axis];
        const auto at = [&](int q) { return origin + step * static_cast<float>(q); };
        const auto nearest = [&](float x) {
            return step > 0 ? static_cast<int>(std::clamp((x - origin) / step, 0.0f, 255.0f)) : 0;
        };
        int lo = nearest(box.lo[a]), hi = nearest(box.hi[a]);
        while (lo > 0 && at(lo) > box.lo[a]) --lo;
        while (hi < 255 && at(hi) < box.hi[a]) ++hi;
        node.lo[axis][child] = static_cast<std::uint8_t>(lo);
        node.hi[axis][child] = static_cast<std::uint8_t>(hi);
    }
}

}  // namespace

std::vector<std::uint32_t> MeshTree::build(std::span<const Aabb> boxes) {
    nodes_.clear();
    bounds_ = {};
    if (boxes.empty()) return {};
    Splitter splitter(boxes);
    struct Open {
        Part part;
        std::uint32_t node;
    };
    std::vector<Open> open{{splitter.whole(), 0}};
    bounds_ = open.front().part.box;
    nodes_.reserve(boxes.size() / 12 + 1);
    nodes_.emplace_back();
    while (!open.empty()) {
        const Open item = open.back();
        open.pop_back();
        std::vector<Part> parts{item.part};
        while (parts.size() < 8) {
            std::size_t largest = 0;
            for (std::size_t i = 1; i < parts.size(); ++i)
                if (parts[i].size() > parts[largest].size()) largest = i;
            const Part part = parts[largest];
            if (part.size() <= max_in_leaf) break;
            const auto [left, right] = splitter.split(part, part.depth >= max_chosen_depth);
            parts[largest] = left;
            parts.push_back(right);
        }
        std::ranges::sort(parts, {}, &Part::begin);
        MeshNode node;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const int a = static_cast<int>(axis);
            node.origin[axis] = item.part.box.lo[a];
            node.step[axis] = step_of(item.part.box.lo[a], item.part.box.hi[a]);
            node.lo[axis].fill(1);
        }
        for (std::size_t k = 0; k < parts.size(); ++k) {
            quantise(node, k, parts[k].box);
            const bool is_leaf = parts[k].size() <= max_in_leaf;
            node.count[k] = is_leaf ? static_cast<std::uint8_t>(parts[k].size()) : MeshNode::inner;
            node.first[k] = is_leaf ? parts[k].begin : static_cast<std::uint32_t>(nodes_.size());
            if (is_leaf) continue;
            open.push_back({parts[k], node.first[k]});
            nodes_.emplace_back();
        }
        nodes_[item.node] = node;
    }
    nodes_.shrink_to_fit();
    return std::move(splitter.order());
}

}  // namespace fase::detail
