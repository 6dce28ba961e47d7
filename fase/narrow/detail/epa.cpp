/// Penetration of two cores of which one is curved, by growing a polytope inside their Minkowski difference (EPA).
#include "fase/narrow/detail/epa.hpp"

#include <array>
#include <limits>

namespace fase::narrow {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t corner_capacity = 96;
constexpr std::size_t face_capacity = 2 * corner_capacity;
using Index = std::uint8_t;

/// One triangle of the polytope, counter-clockwise seen from outside. `offset` is signed: below 0 when the origin is
/// outside; infinite for a triangle without area, which is never looked at.
struct Triangle {
    Vec3d normal;
    double offset = 0;
    std::array<Index, 3> corner{};
};

/// A closed surface of triangles that grows by corners.
class Polytope {
public:
    [[nodiscard]] std::size_t corners() const { return corner_count_; }
    [[nodiscard]] const Triangle& triangle(std::size_t i) const { return triangles_[i]; }

    /// The tetrahedron of four corners, in either orientation.
    void start(const std::array<Vec3d, 4>& p) {
        for (const Vec3d& corner : p) corners_[corner_count_++] = corner;
        const bool turned = dot(p[1] - p[0], cross(p[2] - p[0], p[3] - p[0])) > 0;
        const auto put = [&](Index i, Index j, Index k) { turned ? add(i, k, j) : add(i, j, k); };
        put(0, 1, 2);
        put(0, 2, 3);
        put(0, 3, 1);
        put(1, 3, 2);
    }

    /// The triangle nearest to the origin.
    [[nodiscard]] std::size_t nearest() const {
        std::size_t best = 0;
        for (std::size_t i = 1; i < triangle_count_; ++i) {
            if (triangles_[i].offset < triangles_[best].offset) best = i;
        }
        return best;
    }

    /// Grows the surface to the new corner; false when it lies on or inside it, or when there is no room.
    bool grow(Vec3d corner, double slack) {
        if (corner_count_ == corner_capacity) return false;
        std::size_t kept = 0;
        rim_count_ = 0;
        for (std::size_t i = 0; i < triangle_count_; ++i) {
            const Triangle& t = triangles_[i];
            if (dot(t.normal, corner) - t.offset > slack) {
                note(t.corner[0], t.corner[1]);
                note(t.corner[1], t.corner[2]);
                note(t.corner[2], t.corner[0]);
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

    /// An edge of a removed triangle: it belongs to the rim unless its twin is removed too.
    void note(Index from, Index to) {
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

/// A few points of the Minkowski difference, of which four that are not flat make the first tetrahedron.
struct Cloud {
    Buffer<Vec3d, 20> points;
    std::size_t count = 0;

    void add(Vec3d p) { points[count++] = p; }

    /// Moves to place `index` the point that scores highest; the score, which is 0 when none is left.
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

}  // namespace

Penetration epa(const CoreView& a, const CoreView& b, const TransformD& b_in_a, const Simplex& start,
                const Penetration& known, const EpaOptions& options) {
    const auto support = [&](Vec3d direction) {
        return a.support(direction) - transform(b_in_a, b.support(transpose_times(b_in_a.rotation, -direction)));
    };
    Penetration best = known;
    best.state = Penetration::State::Limit;
    const bool has_known = known.depth < infinity;
    if (!has_known) {
        best.normal = {0, 1, 0};
        best.depth = dot(best.normal, support(best.normal));
    }

    Cloud cloud;
    for (int i = 0; i < start.count; ++i) cloud.add(start.corners[static_cast<std::size_t>(i)].difference);
    // Around the way out that is known: mostly it is the answer, and these points prove it.
    const Vec3d n = best.normal, u = any_perpendicular(n), w = cross(n, u);
    for (const Vec3d direction : {n + u, n - u, n + w, n - w, n, -n}) cloud.add(support(direction));
    const auto& p = cloud.points;
    const double length_01 = cloud.pick(1, [&](Vec3d q) { return length_squared(q - p[0]); });
    if (!(length_01 > 0)) return best;
    const double scale = std::sqrt(length_01);
    double area = cloud.pick(2, [&](Vec3d q) { return length_squared(cross(p[1] - p[0], q - p[0])); });
    if (!(area > 0)) {
        const Vec3d side = any_perpendicular(normalized(p[1] - p[0]));
        cloud.add(support(side));
        cloud.add(support(-side));
        area = cloud.pick(2, [&](Vec3d q) { return length_squared(cross(p[1] - p[0], q - p[0])); });
    }
    const Vec3d plane = cross(p[1] - p[0], p[2] - p[0]);
    cloud.add(support(plane));
    cloud.add(support(-plane));
    const double volume = cloud.pick(3, [&](Vec3d q) { return std::abs(dot(plane, q - p[0])); });
    if (!(volume > 1e-14 * length(plane) * scale)) {
        // Flat: the way out at right angles to the plane costs next to nothing.
        const Vec3d normal = normalized(plane);
        for (const Vec3d way : {normal, -normal}) {
            const double depth = dot(way, support(way));
            if (length_squared(way) > 0 && depth + options.bias < best.depth) {
                best = {way, depth, Penetration::Source::Curve, Penetration::State::Limit};
            }
        }
        return best;
    }

    const double slack = 1e-14 * scale;
    Polytope polytope;
    polytope.start({p[0], p[1], p[2], p[3]});
    for (std::size_t i = 4; i < cloud.count; ++i) polytope.grow(p[i], slack);
    const auto most = static_cast<std::size_t>(options.max_corners) + 4;
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
        if (polytope.corners() >= most || !polytope.grow(corner, slack)) return best;
    }
}

}  // namespace fase::narrow
