/// Penetration of two cores, at least one curved, by the expanding polytope algorithm (EPA).
#include "fase/narrow/detail/epa.hpp"

#include <array>
#include <limits>

#include "fase/narrow/detail/infinity.hpp"

namespace fase::narrow {
namespace {

constexpr std::size_t corner_capacity = 96;
constexpr std::size_t face_capacity = 2 * corner_capacity;
using Index = std::uint8_t;

/// One triangle of the polytope, counter-clockwise seen from outside. `offset` is signed: below 0 when the origin is
/// outside; infinite for a degenerate triangle, which is never selected.
struct Triangle {
    Vec3d normal;
    double offset = 0;
    std::array<Index, 3> corner{};
};

/// A closed surface of triangles that is expanded by adding corners.
class Polytope {
public:
    [[nodiscard]] std::size_t corners() const { return corner_count_; }
    [[nodiscard]] const Triangle& triangle(std::size_t i) const { return triangles_[i]; }

    /// Makes the tetrahedron of four corners, in either orientation.
    void start(const std::array<Vec3d, 4>& p) {
        for (const Vec3d& corner : p) corners_[corner_count_++] = corner;
        const bool inverted = dot(p[1] - p[0], cross(p[2] - p[0], p[3] - p[0])) > 0;
        const auto put = [&](Index i, Index j, Index k) { inverted ? add(i, k, j) : add(i, j, k); };
        put(0, 1, 2);
        put(0, 2, 3);
        put(0, 3, 1);
        put(1, 3, 2);
    }

    /// Returns the triangle nearest to the origin.
    [[nodiscard]] std::size_t nearest() const {
        std::size_t best = 0;
        for (std::size_t i = 1; i < triangle_count_; ++i) {
            if (triangles_[i].offset < triangles_[best].offset) best = i;
        }
        return best;
    }

    /// Expands the surface to a new corner; returns false when the corner is on or inside it, or the capacity is
    /// reached.
    bool expand(Vec3d corner, double slack) {
        if (corner_count_ == corner_capacity) return false;
        std::size_t kept = 0;
        rim_count_ = 0;
        for (std::size_t i = 0; i < triangle_count_; ++i) {
            const Triangle& t = triangles_[i];
            if (dot(t.normal, corner) - t.offset > slack) {
                toggle_rim_edge(t.corner[0], t.corner[1]);
                toggle_rim_edge(t.corner[1], t.corner[2]);
                toggle_rim_edge(t.corner[2], t.corner[0]);
            } else {
                triangles_[kept++] = t;
            }
        }
        if (kept == triangle_count_) return false;
        triangle_count_ = kept;
        if (rim_count_ < 3 || kept + rim_count_ > face_capacity) return false;
        const auto index = static_cast<Index>(corner_count_);
        corners_[corner_count_++] = corner;
        for (std::size_t i = 0; i < rim_count_; ++i) add(rim_[i][0], rim_[i][1], index);
        return true;
    }

private:
    void add(Index i, Index j, Index k) {
        const Vec3d p = corners_[i], u = corners_[j] - p, v = corners_[k] - p;
        const Vec3d normal = cross(u, v);
        const double l = length(normal);
        Triangle& t = triangles_[triangle_count_++];
        t.corner = {i, j, k};
        if (l * l > 1e-26 * length_squared(u) * length_squared(v)) {
            t.normal = normal * (1 / l);
            t.offset = dot(t.normal, p);
        } else {
            t.normal = {};
            t.offset = infinity;
        }
    }

    /// Adds an edge of a removed triangle to the rim, or removes its twin when both triangles are removed.
    void toggle_rim_edge(Index from, Index to) {
        for (std::size_t i = 0; i < rim_count_; ++i) {
            if (rim_[i][0] == to && rim_[i][1] == from) {
                rim_[i] = rim_[--rim_count_];
                return;
            }
        }
        rim_[rim_count_++] = {from, to};
    }

    Buffer<Vec3d, corner_capacity> corners_;
    Buffer<Triangle, face_capacity> triangles_;
    Buffer<std::array<Index, 2>, 3 * face_capacity> rim_;
    std::size_t corner_count_ = 0, triangle_count_ = 0, rim_count_ = 0;
};

/// Some points of the Minkowski difference, four of which make the first tetrahedron.
struct Cloud {
    Buffer<Vec3d, 20> points;
    std::size_t count = 0;

    void add(Vec3d p) { points[count++] = p; }

    /// Swaps the point of the highest score to `index`; returns the score, 0 when no point has a score above 0.
    template <class Score> double pick(std::size_t index, Score&& score) {
        double best_score = 0;
        std::size_t best = index;
        for (std::size_t i = index; i < count; ++i) {
            const double s = score(points[i]);
            if (s > best_score) {
                best_score = s;
                best = i;
            }
        }
        std::swap(points[index], points[best]);
        return best_score;
    }
};

/// The support function of the Minkowski difference a - b, in a's frame.
struct DifferenceSupport {
    const CoreView& a;
    const CoreView& b;
    const TransformD& b_in_a;

    Vec3d operator()(Vec3d direction) const {
        return a.support(direction) - transform(b_in_a, b.support(transpose_times(b_in_a.rotation, -direction)));
    }
};

/// The first tetrahedron: the first four points of the cloud. Not `solid`: the points are in the plane of normal
/// `plane`, or on a line when that is 0.
struct Start {
    bool solid = false;
    Vec3d plane;
    double scale = 0;  ///< distance of the first two points; 0: all points are equal
};

/// Moves four points of a large tetrahedron to the front of the cloud; adds support points where needed.
Start find_start(const DifferenceSupport& support, Cloud& cloud) {
    const auto& p = cloud.points;
    const double length_01 = cloud.pick(1, [&](Vec3d q) { return length_squared(q - p[0]); });
    if (!(length_01 > 0)) return {};
    Start start;
    start.scale = std::sqrt(length_01);
    const double area = cloud.pick(2, [&](Vec3d q) { return length_squared(cross(p[1] - p[0], q - p[0])); });
    if (!(area > 0)) {
        const Vec3d side = any_perpendicular(normalized(p[1] - p[0]));
        cloud.add(support(side));
        cloud.add(support(-side));
        cloud.pick(2, [&](Vec3d q) { return length_squared(cross(p[1] - p[0], q - p[0])); });
    }
    start.plane = cross(p[1] - p[0], p[2] - p[0]);
    cloud.add(support(start.plane));
    cloud.add(support(-start.plane));
    const double volume = cloud.pick(3, [&](Vec3d q) { return std::abs(dot(start.plane, q - p[0])); });
    start.solid = volume > 1e-14 * length(start.plane) * start.scale;
    return start;
}

/// Improves `best` for a flat Minkowski difference: the depth perpendicular to its plane is about 0.
void try_flat_normals(const DifferenceSupport& support, Vec3d plane, double bias, Penetration& best) {
    const Vec3d normal = normalized(plane);
    for (const Vec3d direction : {normal, -normal}) {
        const double depth = dot(direction, support(direction));
        if (length_squared(direction) > 0 && depth + bias < best.depth) {
            best = {direction, depth, Penetration::Source::Curve, Penetration::State::Limit};
        }
    }
}

}  // namespace

Penetration epa(const CoreView& a, const CoreView& b, const TransformD& b_in_a, const Simplex& start,
                const Penetration& known, const EpaOptions& options) {
    const DifferenceSupport support{a, b, b_in_a};
    Penetration best = known;
    best.state = Penetration::State::Limit;
    const bool has_known = known.depth < infinity;
    if (!has_known) {
        best.normal = {0, 1, 0};
        best.depth = dot(best.normal, support(best.normal));
    }

    Cloud cloud;
    for (int i = 0; i < start.count; ++i) cloud.add(start.corners[static_cast<std::size_t>(i)].difference);
    // Points around the known direction: it is usually the answer, and these points prove it.
    const Vec3d n = best.normal, u = any_perpendicular(n), w = cross(n, u);
    for (const Vec3d direction : {n + u, n - u, n + w, n - w, n, -n}) cloud.add(support(direction));
    const Start first = find_start(support, cloud);
    if (!(first.scale > 0)) return best;
    if (!first.solid) {
        try_flat_normals(support, first.plane, options.bias, best);
        return best;
    }

    const double slack = 1e-14 * first.scale;
    const auto& p = cloud.points;
    Polytope polytope;
    polytope.start({p[0], p[1], p[2], p[3]});
    for (std::size_t i = 4; i < cloud.count; ++i) polytope.expand(p[i], slack);
    const auto max_corners = static_cast<std::size_t>(options.max_corners) + 4;
    while (true) {
        const Triangle nearest = polytope.triangle(polytope.nearest());
        if (!(nearest.offset < infinity)) return best;
        if (best.depth - nearest.offset <=
            options.tolerance + (best.source == Penetration::Source::Curve ? 0 : options.bias)) {
            best.state = Penetration::State::Close;
            return best;
        }
        const Vec3d corner = support(nearest.normal);
        const double depth = dot(nearest.normal, corner);
        const double bias = best.source == Penetration::Source::Curve ? 0 : options.bias;
        if (depth + bias < best.depth) {
            best = {nearest.normal, depth, Penetration::Source::Curve, Penetration::State::Limit};
        }
        if (depth - nearest.offset <= options.tolerance) {
            best.state = Penetration::State::Close;
            return best;
        }
        if (polytope.corners() >= max_corners || !polytope.expand(corner, slack)) return best;
    }
}

}  // namespace fase::narrow
