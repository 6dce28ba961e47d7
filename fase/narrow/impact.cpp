/// When a moving vertex first meets a moving triangle, and when two moving edges meet.
///
/// The difference of two points, one on each feature, is a function F of the time and two coordinates on the features.
/// It is affine in each of the three, so over a box of the three its values lie in the convex hull of those at the
/// eight corners. A box is dropped when a direction exists along which all eight are on one side of 0; others are
/// halved.
#include "fase/narrow/impact.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace fase::narrow {
namespace {

constexpr double largest = 1e100;
constexpr int dimensions = 3;  // time, and the coordinates u and v on the features

/// Halving is exact in double down to here, and so are 1 - t and 1 - u - v.
constexpr double min_width = 0x1p-48;
/// Where another meeting is known, undecided boxes of this width count as one.
constexpr double coarse_width = 0x1p-22;

/// A part of the domain.
struct Cell {
    std::array<double, dimensions> lo, hi;  // not initialised: most of the stack is never used
    [[nodiscard]] double width(std::size_t d) const { return hi[d] - lo[d]; }
};

/// The values of F at the corners of a box: bit d of the index tells whether coordinate d is the upper one.
using Corners = std::array<Vec3d, 8>;

Vec3d at(const MovingPoint& point, double time) { return point.begin * (1 - time) + point.end * time; }

struct VertexFace {
    static constexpr bool triangular = true;  ///< only u + v <= 1 belongs to the triangle
    const MovingPoint& vertex;
    const std::array<MovingPoint, 3>& face;

    /// Sets the four corners at a time; `upper`: 1 for the upper time of the box.
    void corners_at(double time, const Cell& box, std::size_t upper, Corners& out) const {
        const Vec3d p = at(vertex, time), a = at(face[0], time), b = at(face[1], time), c = at(face[2], time);
        for (std::size_t k = 0; k < 4; ++k) {
            const double u = k & 1 ? box.hi[1] : box.lo[1], v = k & 2 ? box.hi[2] : box.lo[2];
            out[upper + 2 * k] = p - (a * (1 - u - v) + b * u + c * v);
        }
    }
    template <class F> void for_each_point(const F& f) const {
        f(vertex);
        for (const MovingPoint& point : face) f(point);
    }
};

struct EdgeEdge {
    static constexpr bool triangular = false;
    const std::array<MovingPoint, 2>&a, &b;

    void corners_at(double time, const Cell& box, std::size_t upper, Corners& out) const {
        const Vec3d a0 = at(a[0], time), a1 = at(a[1], time), b0 = at(b[0], time), b1 = at(b[1], time);
        const auto on = [](Vec3d from, Vec3d to, double share) { return from * (1 - share) + to * share; };
        const Vec3d on_a[2] = {on(a0, a1, box.lo[1]), on(a0, a1, box.hi[1])};
        const Vec3d on_b[2] = {on(b0, b1, box.lo[2]), on(b0, b1, box.hi[2])};
        for (std::size_t k = 0; k < 4; ++k) out[upper + 2 * k] = on_a[k & 1] - on_b[k >> 1];
    }
    template <class F> void for_each_point(const F& f) const {
        for (const MovingPoint& point : a) f(point);
        for (const MovingPoint& point : b) f(point);
    }
};

/// What the corners of a box tell along one direction: F is nowhere 0; by coordinate, F has one sign on the lower face
/// of the box and the other on the upper.
struct Along {
    bool apart = false;
    std::array<bool, dimensions> crosses{};
};

template <class Features> class Search {
public:
    Search(const Features& features, const ImpactOptions& options) : features_(features), options_(options) {
        Vec3d size;
        features.for_each_point([&](const MovingPoint& p) {
            size = max(size, max(abs(p.begin), abs(p.end)));
            valid_ = valid_ && is_finite(p.begin) && is_finite(p.end);
        });
        valid_ = valid_ && size.x <= largest && size.y <= largest && size.z <= largest;
        // A corner of F is a sum of at most four points with weights of at most 1 each, in at most ten roundings: its
        // error is below 20 units of 2^-53 of the largest coordinate. Its product with a direction adds 12. The last
        // term is for coordinates so small that they lose digits.
        constexpr double unit = 0x1p-53, tiny = 1e-300;
        error_ = size * (40 * unit) + Vec3d{tiny, tiny, tiny};
        slack_ = std::max(options.distance, 0.0);
    }

    [[nodiscard]] std::optional<Impact> run() {
        if (!valid_) return Impact{0, false};
        push({{0, 0, 0}, {1, 1, 1}});
        for (int boxes = 0; count_ > 0; ++boxes) {
            if (boxes >= options_.max_boxes) {
                for (std::size_t i = 0; i < count_; ++i) meet(stack_[i].lo[0], false);
                break;
            }
            visit(stack_[--count_]);
        }
        if (found_) found_->time = std::min(found_->time, skipped_);
        return found_;
    }

private:
    const Features& features_;
    const ImpactOptions& options_;
    Vec3d error_;
    double slack_ = 0;
    bool valid_ = true;
    std::optional<Impact> found_;
    double skipped_ = 1;                  ///< the earliest time of boxes left out because of found_
    std::array<Cell, 3 * 48 + 2> stack_;  ///< each halving leaves one box behind
    std::size_t count_ = 0;

    void push(const Cell& box) { stack_[count_++] = box; }
    void meet(double time, bool certain) {
        if (!found_ || time < found_->time) found_ = Impact{time, certain};
    }

    void visit(const Cell box) {
        if (found_ && box.lo[0] >= found_->time - 0.5 * options_.time_tolerance) {
            skipped_ = std::min(skipped_, box.lo[0]);  // may hold an earlier meeting, within the tolerance
            return;
        }
        if (Features::triangular && box.lo[1] + box.lo[2] > 1) return;
        Corners corners;
        features_.corners_at(box.lo[0], box, 0, corners);
        features_.corners_at(box.hi[0], box, 1, corners);
        for (const Vec3d& axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
            if (look_along(axis, corners).apart) return;
        const std::array<Vec3d, dimensions> slopes = slopes_of(corners);
        bool certain = !Features::triangular || box.hi[1] + box.hi[2] <= 1;
        std::array<Vec3d, dimensions> normals{};
        for (std::size_t d = 0; d < dimensions; ++d) {
            // Along this direction, F changes with coordinate d only.
            normals[d] = cross(slopes[(d + 1) % 3], slopes[(d + 2) % 3]);
            const Along along = look_along(normals[d], corners);
            if (along.apart) return;
            certain = certain && along.crosses[d];
        }
        if (is_flat_and_apart(slopes, normals, corners)) return;
        const double time_width = box.width(0);
        if (certain && (time_width <= 0.5 * options_.time_tolerance || time_width <= min_width))
            return meet(box.lo[0], true);
        // Features that slide along each other meet in many places: the first is found in all digits, the others are
        // not.
        if (found_ && std::max({time_width, box.width(1), box.width(2)}) <= coarse_width) return meet(box.lo[0], false);
        split(box, slopes);
    }

    /// The mean derivatives of F along the sides of the box, times the sides.
    static std::array<Vec3d, dimensions> slopes_of(const Corners& corners) {
        std::array<Vec3d, dimensions> slopes{};
        for (std::size_t d = 0; d < dimensions; ++d)
            for (std::size_t k = 0; k < 8; ++k) slopes[d] += k >> d & 1 ? corners[k] : -corners[k];
        return slopes;
    }

    /// Whether F moves in a plane only, as that of parallel edges does, and is apart along a direction in this plane.
    [[nodiscard]] bool is_flat_and_apart(const std::array<Vec3d, dimensions>& slopes,
                                         const std::array<Vec3d, dimensions>& normals, const Corners& corners) const {
        std::size_t d = 0;
        for (const std::size_t other : {1u, 2u})
            if (length_squared(normals[other]) > length_squared(normals[d])) d = other;
        const double out = dot(normals[d], slopes[d]);
        constexpr double flat = 1e-6;
        if (out * out > flat * flat * length_squared(normals[d]) * length_squared(slopes[d])) return false;
        return std::any_of(slopes.begin(), slopes.end(),
                           [&](const Vec3d& slope) { return look_along(cross(normals[d], slope), corners).apart; });
    }

    /// Looks at the corners along a direction of any length. Its own rounding does not matter; that of the corners
    /// never makes them apart, nor a change of sign.
    [[nodiscard]] Along look_along(Vec3d direction, const Corners& corners) const {
        const Vec3d size = abs(direction);
        const double longest = std::max({size.x, size.y, size.z});
        if (!(longest > 0) || !std::isfinite(longest)) return {};
        const Vec3d d = direction * (1 / longest);
        const double error = dot(abs(d), error_) + slack_ * length(d);
        unsigned above = 0, below = 0;  // a bit for each corner
        for (std::size_t k = 0; k < 8; ++k) {
            const double value = dot(d, corners[k]);
            above |= value > error ? 1u << k : 0u;
            below |= value < -error ? 1u << k : 0u;
        }
        Along along;
        along.apart = above == 0xff || below == 0xff;
        constexpr unsigned upper[dimensions] = {0xaa, 0xcc, 0xf0};
        for (std::size_t side = 0; side < dimensions; ++side) {
            const unsigned hi = upper[side], lo = hi ^ 0xffu;
            along.crosses[side] =
                ((above & hi) == hi && (below & lo) == lo) || ((below & hi) == hi && (above & lo) == lo);
        }
        return along;
    }

    /// Halves the side along which F changes most. A box in which F changes by rounding only counts as a meeting.
    void split(const Cell& box, const std::array<Vec3d, dimensions>& slopes) {
        std::size_t widest = dimensions;
        double most = 0;
        bool matters = false;
        for (std::size_t d = 0; d < dimensions; ++d) {
            const Vec3d change = abs(slopes[d]) * 0.25;
            const double size = std::max({change.x, change.y, change.z});
            matters =
                matters || change.x > error_.x + slack_ || change.y > error_.y + slack_ || change.z > error_.z + slack_;
            if (box.width(d) <= min_width || (widest < dimensions && !(size > most))) continue;
            widest = d;
            most = size;
        }
        // Where a meeting is known, only an earlier one matters.
        if (found_ && box.width(0) > 0.25 * options_.time_tolerance && box.width(0) > min_width) widest = 0;
        if (widest == dimensions || !matters) return meet(box.lo[0], false);
        const double middle = 0.5 * (box.lo[widest] + box.hi[widest]);
        Cell lower = box, upper = box;
        lower.hi[widest] = upper.lo[widest] = middle;
        push(upper);
        push(lower);  // the next: earlier in time
    }
};

}  // namespace

std::optional<Impact> find_vertex_face_impact(const MovingPoint& vertex, const std::array<MovingPoint, 3>& face,
                                              const ImpactOptions& options) {
    const VertexFace features{vertex, face};
    return Search(features, options).run();
}

std::optional<Impact> find_edge_edge_impact(const std::array<MovingPoint, 2>& a, const std::array<MovingPoint, 2>& b,
                                            const ImpactOptions& options) {
    const EdgeEdge features{a, b};
    return Search(features, options).run();
}

}  // namespace fase::narrow
