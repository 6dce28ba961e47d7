/// World boxes of the shapes, and the balls around and inside them.
#include "fase/geometry/bounds.hpp"

#include "fase/geometry/mass.hpp"

namespace fase {
namespace {

/// The exact rotation of q / |q|, to a few units in the last place of a double. A quaternion whose length is a few
/// float roundings off 1 would otherwise turn and stretch, and a stretched shape leaves its box.
Mat3d rotation_matrix(Quat q) {
    const double x = q.x, y = q.y, z = q.z, w = q.w;
    const double s = 2 / (x * x + y * y + z * z + w * w);
    const double sx = s * x, sy = s * y, sz = s * z;
    return {{1 - (sy * y + sz * z), sx * y + sz * w, sx * z - sy * w},
            {sx * y - sz * w, 1 - (sx * x + sz * z), sy * z + sx * w},
            {sx * z + sy * w, sy * z - sx * w, 1 - (sx * x + sy * y)}};
}

/// The y column of rotation_matrix(): where the axis of a round shape points.
Vec3d rotated_y(Quat q) {
    const double x = q.x, y = q.y, z = q.z, w = q.w;
    const double s = 2 / (x * x + y * y + z * z + w * w);
    return {s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w)};
}

/// Float at or below v, at most two units in the last place away; v's own error is the caller's affair.
/// Why: rounding to nearest moves a double w by at most |w| 2^-24 (or 2^-150 where floats are denormal). With
/// w = v - |v| k, k = 2^-24 (1 + 2^-20), that is at most |v| (1 + k) 2^-24 < |v| k: never back above v. Where |v| is so
/// small that floats are denormal, the slack of placed(), far above them, covers the rest.
float float_below(double v) {
    constexpr double k = 0x1p-24 * (1 + 0x1p-20);
    return static_cast<float>(v - (v < 0 ? -v : v) * k);
}
float float_above(double v) { return -float_below(-v); }

/// The box from position + lo to position + hi in float. An entry of the matrix is off by at most 16 roundings of 2^-53
/// (12 from its two products, which add up to at most 2, the rest from the sums), the sums over it by three more, each
/// times the size of the shape, which the three reaches together are never below: 2^-47 of them holds that twice. The
/// sum with the position adds 2^-53 of |position| + reach. All is laid on top before the rounding to float.
Aabb placed(const Vec3d& position, const Vec3d& lo, const Vec3d& hi) {
    const Vec3d reach = max(abs(lo), abs(hi));
    const double slack = (reach.x + reach.y + reach.z) * 0x1p-47;
    const Vec3d out = abs(position) * 0x1p-52 + Vec3d{slack, slack, slack};
    const Vec3d low = position + lo - out, high = position + hi + out;
    return {{float_below(low.x), float_below(low.y), float_below(low.z)},
            {float_above(high.x), float_above(high.y), float_above(high.z)}};
}
/// For shapes that look the same from both sides.
Aabb placed(const Vec3d& position, const Vec3d& half) { return placed(position, -half, half); }

Aabb box_of(const Sphere& s, const Pose& pose) { return placed(pose.position, Vec3d{s.radius, s.radius, s.radius}); }

Aabb box_of(const Box& box, const Pose& pose) {
    return placed(pose.position, abs(rotation_matrix(pose.rotation)) * to_double(box.half));
}

Aabb box_of(const Capsule& c, const Pose& pose) {
    const double r = c.radius;
    return placed(pose.position, abs(rotated_y(pose.rotation)) * double(c.half_length) + Vec3d{r, r, r});
}

/// A disc of radius r reaches r sqrt(1 - a²) along a world axis on which its unit normal has component a; written with
/// the two other components, for 1 - a² loses half its digits near 1.
Aabb box_of(const Cylinder& c, const Pose& pose) {
    const Vec3d a = rotated_y(pose.rotation);
    const Vec3d square = multiply(a, a);
    const Vec3d disc{std::sqrt(square.y + square.z), std::sqrt(square.z + square.x), std::sqrt(square.x + square.y)};
    return placed(pose.position, abs(a) * double(c.half_height) + disc * double(c.radius));
}

/// Vertices are turned in float, four lanes at a time (the last idle). An entry of the rounded matrix is off by at most
/// 2^-25, the three products and two sums by 3 · 2^-24 of the sum of their sizes: together less than 2^-22 |v|₁ a
/// coordinate. |v|₁ <= sqrt(3) |v|, and no |v| exceeds the sum of the three reaches found (plus that same error), so
/// that 2^-21 of that sum holds all of it: at the size of the hull, four units in the last place.
Aabb box_of(const ConvexHull& hull, const Pose& pose) {
    const Mat3 m = to_float(rotation_matrix(pose.rotation));
    const float mx[4] = {m.x.x, m.x.y, m.x.z, 0}, my[4] = {m.y.x, m.y.y, m.y.z, 0}, mz[4] = {m.z.x, m.z.y, m.z.z, 0};
    constexpr float inf = Aabb::infinity;
    float lo[4] = {inf, inf, inf, inf}, hi[4] = {-inf, -inf, -inf, -inf};
    for (const Vec3 v : hull.vertices) {
        for (int i = 0; i < 4; ++i) {
            const float along = mx[i] * v.x + my[i] * v.y + mz[i] * v.z;
            lo[i] = along < lo[i] ? along : lo[i];
            hi[i] = along > hi[i] ? along : hi[i];
        }
    }
    const Vec3d low{lo[0], lo[1], lo[2]}, high{hi[0], hi[1], hi[2]};
    const Vec3d reach = max(abs(low), abs(high));
    const double slack = (reach.x + reach.y + reach.z) * 0x1p-21;
    const Vec3d out{slack, slack, slack};
    return placed(pose.position, low - out, high + out);
}

/// Bounded only when the plane's normal lies exactly on a world axis. The three numbers are the normal times |q|²; the
/// products of floats are exact in double, so a difference is 0 only where it is 0.
Aabb box_of(const HalfSpace&, const Pose& pose) {
    const double x = pose.rotation.x, y = pose.rotation.y, z = pose.rotation.z, w = pose.rotation.w;
    const double nx = x * y - z * w, ny = (w * w - z * z) + (y * y - x * x), nz = y * z + x * w;
    const Aabb at = rounded_outward(pose.position, pose.position);
    Aabb box = Aabb::everything();
    if (nx == 0 && nz == 0) {
        (ny > 0 ? box.hi.y : box.lo.y) = ny > 0 ? at.hi.y : at.lo.y;
    } else if (ny == 0 && nz == 0) {
        (nx > 0 ? box.hi.x : box.lo.x) = nx > 0 ? at.hi.x : at.lo.x;
    } else if (nx == 0 && ny == 0) {
        (nz > 0 ? box.hi.z : box.lo.z) = nz > 0 ? at.hi.z : at.lo.z;
    }
    return box;
}

struct OuterRadius {
    float operator()(const Sphere& s) const { return s.radius; }
    float operator()(const Box& b) const { return float_above(length(to_double(b.half))); }
    float operator()(const Capsule& c) const { return float_above(double(c.half_length) + c.radius); }
    float operator()(const Cylinder& c) const {
        return float_above(std::sqrt(double(c.radius) * c.radius + double(c.half_height) * c.half_height));
    }
    float operator()(const ConvexHull& hull) const {
        double farthest = 0;
        for (const Vec3 v : hull.vertices) {
            const double square = length_squared(to_double(v));
            farthest = square > farthest ? square : farthest;
        }
        return float_above(std::sqrt(farthest));
    }
    float operator()(const HalfSpace&) const { return Aabb::infinity; }
};

struct InnerRadius {
    float operator()(const Sphere& s) const { return s.radius; }
    float operator()(const Box& b) const { return min_of(min_of(b.half.x, b.half.y), b.half.z); }
    float operator()(const Capsule& c) const { return c.radius; }
    float operator()(const Cylinder& c) const { return min_of(c.radius, c.half_height); }
    float operator()(const ConvexHull& hull) const {
        const Vec3 middle = mass_properties(hull, 1).centre;
        float least = Aabb::infinity;
        for (const ConvexHull::Face& face : hull.faces) least = min_of(least, -signed_distance(face.plane, middle));
        return least > 0 && least < Aabb::infinity ? least : 0;
    }
    float operator()(const HalfSpace&) const { return 0; }
    static float min_of(float a, float b) { return a < b ? a : b; }
};

}  // namespace

Aabb bounds(const Shape& shape, const Pose& pose) {
    return std::visit([&pose](const auto& s) { return box_of(s, pose); }, shape);
}

float outer_radius(const Shape& shape) { return std::visit(OuterRadius{}, shape); }

float inner_radius(const Shape& shape) { return std::visit(InnerRadius{}, shape); }

}  // namespace fase
