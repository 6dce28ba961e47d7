/// The distance of two convex cores (GJK).
#include "fase/narrow/detail/gjk.hpp"

#include <optional>

namespace fase::narrow {
namespace {

/// The point of a simplex closest to the origin, with its barycentric weights.
struct Closest {
    std::array<double, 4> weight{};
    Vec3d point;
    double squared = std::numeric_limits<double>::infinity();
};

class ClosestPoint {
public:
    explicit ClosestPoint(const Simplex& simplex) : simplex_(simplex) {}

    [[nodiscard]] Closest find() const {
        if (simplex_.count == 1) return vertex(0);
        if (simplex_.count == 2) return segment(0, 1);
        if (simplex_.count == 3) return triangle(0, 1, 2);
        return tetrahedron();
    }

private:
    [[nodiscard]] Vec3d at(std::size_t i) const { return simplex_.corners[i].difference; }

    [[nodiscard]] Closest vertex(std::size_t i) const {
        Closest result;
        result.weight[i] = 1;
        result.point = at(i);
        result.squared = length_squared(result.point);
        return result;
    }

    [[nodiscard]] Closest segment(std::size_t i, std::size_t j) const {
        const Vec3d p = at(i), q = at(j), along = q - p;
        const double squared = length_squared(along);
        const double from_p = -dot(p, along), from_q = dot(q, along);
        if (!(from_p > 0) || !(squared > 0)) return vertex(i);
        if (!(from_q > 0)) return vertex(j);
        Closest result;
        // Measured from the nearer end, to reduce rounding errors on long segments.
        if (from_p < from_q) {
            const double fraction = from_p / squared;
            result.weight[i] = 1 - fraction;
            result.weight[j] = fraction;
            result.point = p + along * fraction;
        } else {
            const double fraction = from_q / squared;
            result.weight[i] = fraction;
            result.weight[j] = 1 - fraction;
            result.point = q - along * fraction;
        }
        result.squared = length_squared(result.point);
        return result;
    }

    [[nodiscard]] static const Closest& nearer(const Closest& a, const Closest& b) {
        return b.squared < a.squared ? b : a;
    }

    [[nodiscard]] Closest triangle(std::size_t i, std::size_t j, std::size_t k) const {
        const Vec3d p = at(i), q = at(j), r = at(k);
        const Vec3d normal = cross(q - p, r - p);
        const double squared = length_squared(normal);
        const double edges = length_squared(q - p) * length_squared(r - p);
        if (!(squared > 1e-30 * edges)) return nearer(nearer(segment(i, j), segment(i, k)), segment(j, k));
        // The projection of the origin on the plane, tested along the axis with the largest projected area.
        const Vec3d foot = normal * (dot(normal, p) / squared);
        const Vec3d size = abs(normal);
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const int u = axis == 2 ? 0 : axis + 1, v = u == 2 ? 0 : u + 1;
        const auto area = [&](Vec3d s, Vec3d t) {
            return (s[u] - foot[u]) * (t[v] - foot[v]) - (s[v] - foot[v]) * (t[u] - foot[u]);
        };
        const double total = normal[axis];
        const double weight_p = area(q, r) / total, weight_q = area(r, p) / total, weight_r = area(p, q) / total;
        if (weight_p > 0 && weight_q > 0 && weight_r > 0) {
            Closest result;
            const double sum = weight_p + weight_q + weight_r;
            result.weight[i] = weight_p / sum;
            result.weight[j] = weight_q / sum;
            result.weight[k] = weight_r / sum;
            result.point = foot;
            result.squared = length_squared(foot);
            return result;
        }
        Closest result;
        if (!(weight_p > 0)) result = segment(j, k);
        if (!(weight_q > 0)) result = nearer(result, segment(i, k));
        if (!(weight_r > 0)) result = nearer(result, segment(i, j));
        return result;
    }

    [[nodiscard]] Closest tetrahedron() const {
        const Vec3d p = at(0), q = at(1), r = at(2), s = at(3);
        const Vec3d u = q - p, v = r - p, w = s - p;
        const double volume = dot(u, cross(v, w));
        const double bound = length_squared(u) * length_squared(v) * length_squared(w);
        std::array<double, 4> weight{};
        const bool flat = !(volume * volume > 1e-28 * bound);
        if (!flat) {
            // Relative to corner p, not to the origin: far from the origin the products would lose all their digits.
            weight[1] = -dot(p, cross(v, w)) / volume;
            weight[2] = dot(p, cross(u, w)) / volume;
            weight[3] = -dot(p, cross(u, v)) / volume;
            weight[0] = 1 - weight[1] - weight[2] - weight[3];
            if (weight[0] > 0 && weight[1] > 0 && weight[2] > 0 && weight[3] > 0) {
                Closest inside;
                const double sum = weight[0] + weight[1] + weight[2] + weight[3];
                for (double& share : weight) share /= sum;
                inside.weight = weight;
                inside.squared = 0;
                return inside;
            }
        }
        Closest result;
        if (flat || !(weight[0] > 0)) result = triangle(1, 2, 3);
        if (flat || !(weight[1] > 0)) result = nearer(result, triangle(0, 2, 3));
        if (flat || !(weight[2] > 0)) result = nearer(result, triangle(0, 1, 3));
        if (flat || !(weight[3] > 0)) result = nearer(result, triangle(0, 1, 2));
        return result;
    }

    const Simplex& simplex_;
};

/// Removes the corners of weight 0 and stores the weights of the others.
void keep(Simplex& simplex, const Closest& closest) {
    int kept = 0;
    for (int i = 0; i < simplex.count; ++i) {
        const double weight = closest.weight[static_cast<std::size_t>(i)];
        if (!(weight > 0)) continue;
        if (kept < i) simplex.corners[static_cast<std::size_t>(kept)] = simplex.corners[static_cast<std::size_t>(i)];
        simplex.corners[static_cast<std::size_t>(kept++)].weight = weight;
    }
    simplex.count = kept;
}

/// Returns the weighted sum of the corners.
SimplexCorner weighted_sum(const Simplex& simplex) {
    SimplexCorner sum;
    for (int i = 0; i < simplex.count; ++i) {
        const SimplexCorner& corner = simplex.corners[static_cast<std::size_t>(i)];
        sum.on_a += corner.on_a * corner.weight;
        sum.on_b += corner.on_b * corner.weight;
    }
    sum.difference = sum.on_a - sum.on_b;
    sum.weight = 1;
    return sum;
}

/// Returns the square of the largest length of a corner's vectors.
double size_squared(const SimplexCorner& corner) {
    const double a = length_squared(corner.on_a), b = length_squared(corner.on_b);
    const double difference = length_squared(corner.difference), larger = a > b ? a : b;
    return larger > difference ? larger : difference;
}

/// The state before an iteration without measurable progress.
struct Previous {
    Simplex simplex;
    Vec3d v;
    double squared = 0, gap = 0;
};

bool has_corner(const Simplex& simplex, Vec3d difference) {
    for (int i = 0; i < simplex.count; ++i) {
        if (simplex.corners[static_cast<std::size_t>(i)].difference == difference) return true;
    }
    return false;
}

/// gjk() of two cores, whose farthest points in a direction `support_a` and `support_b` return.
template <class A, class B>
GjkResult find_nearest(const A& support_a, const B& support_b, const TransformD& b_in_a, const GjkOptions& options) {
    constexpr int max_rounds = 128;
    const auto corner_along = [&](Vec3d direction) {
        SimplexCorner corner;
        corner.on_a = support_a(direction);
        corner.on_b = transform(b_in_a, support_b(transpose_times(b_in_a.rotation, -direction)));
        corner.difference = corner.on_a - corner.on_b;
        return corner;
    };
    GjkResult result;
    Simplex& simplex = result.simplex;
    const Vec3d start = length_squared(b_in_a.position) > 0 ? b_in_a.position : Vec3d{1, 0, 0};
    simplex.corners[0] = corner_along(start);
    simplex.corners[0].weight = 1;
    simplex.count = 1;
    Vec3d v = simplex.corners[0].difference;
    double squared = length_squared(v), scale_squared = size_squared(simplex.corners[0]);
    std::optional<Previous> previous;
    bool stalled = false;
    for (; result.iterations < max_rounds; ++result.iterations) {
        // Within rounding of the origin.
        if (squared <= 1e-30 * scale_squared) break;
        const SimplexCorner corner = corner_along(-v);
        const double bound = dot(v, corner.difference);  // |v| times a lower bound of the distance
        if (bound > 0 && bound * bound > options.farther_than * options.farther_than * squared) {
            result.state = GjkResult::State::Farther;
            result.distance = bound / std::sqrt(squared);
            break;
        }
        const double size = size_squared(corner);
        if (size > scale_squared) scale_squared = size;
        const double gap = squared - bound;
        if (stalled && !(gap < previous->gap)) {
            simplex = previous->simplex;
            v = previous->v;
            squared = previous->squared;
            break;
        }
        if (gap <= options.tolerance * squared || has_corner(simplex, corner.difference)) break;
        simplex.corners[static_cast<std::size_t>(simplex.count++)] = corner;
        const Closest closest = ClosestPoint(simplex).find();
        // Rounding may hide the decrease of the length while the direction still improves: then compares the gap.
        constexpr double noise = 1e-14;
        stalled = !(closest.squared < squared * (1 - noise));
        if (stalled) {
            --simplex.count;
            if (!(closest.squared <= squared * (1 + noise))) break;
            previous = Previous{simplex, v, squared, gap};
            ++simplex.count;
        }
        keep(simplex, closest);
        v = closest.point;
        squared = closest.squared;
        if (squared == 0) break;
    }
    result.scale = std::sqrt(scale_squared);
    const SimplexCorner closest = weighted_sum(simplex);
    result.on_a = closest.on_a;
    result.on_b = closest.on_b;
    if (result.state == GjkResult::State::Farther) {
        result.normal = normalized(-v);
        return result;
    }
    if (squared <= 1e-30 * scale_squared) {
        result.state = GjkResult::State::Overlap;
        return result;
    }
    result.distance = std::sqrt(squared);
    result.normal = v * (-1 / result.distance);
    return result;
}

}  // namespace

GjkResult gjk(const CoreView& a, const CoreView& b, const TransformD& b_in_a, const GjkOptions& options) {
    const auto core = [](const CoreView& view) { return [&view](Vec3d d) { return view.support(d); }; };
    if (a.table != &core_table<Box> || b.table != &core_table<Box>)
        return find_nearest(core(a), core(b), b_in_a, options);
    // Boxes in heaps come here often, and their support points are cheaper than a call.
    const auto box = [](const CoreView& view) {
        return [half = to_double(static_cast<const Box*>(view.shape)->half)](Vec3d d) {
            return Vec3d{d.x < 0 ? -half.x : half.x, d.y < 0 ? -half.y : half.y, d.z < 0 ? -half.z : half.z};
        };
    };
    return find_nearest(box(a), box(b), b_in_a, options);
}

}  // namespace fase::narrow
