/// Extraction of frusta from matrices, and frustum-box tests.
#include "fase/geometry/frustum.hpp"

#include "fase/core/detail/text.hpp"

namespace fase {
namespace {

/// Converts a·x + b·y + c·z + d >= 0 (inside) to a side with a unit outward normal.
Frustum::Side side_of(const std::array<double, 4>& row) {
    const Vec3d inward{row[0], row[1], row[2]};
    const double size = length(inward);
    if (!(size > 0)) return {{}, row[3]};
    return {inward * (-1 / size), row[3] / size};
}

/// Returns the maximum of dot(normal, p) over the box. An axis with a zero component gives 0, not 0 · infinity.
double farthest_along(Vec3d normal, const Aabb& box) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
        if (normal[i] != 0) sum += normal[i] * double(normal[i] > 0 ? box.hi[i] : box.lo[i]);
    }
    return sum;
}

}  // namespace

Result<Frustum> frustum_of(std::span<const float, 16> view_projection, ClipDepth depth) {
    const auto row = [&](std::size_t r) {
        return std::array<double, 4>{view_projection[r], view_projection[4 + r], view_projection[8 + r],
                                     view_projection[12 + r]};
    };
    const auto add = [](const std::array<double, 4>& a, const std::array<double, 4>& b, double sign) {
        return std::array<double, 4>{a[0] + sign * b[0], a[1] + sign * b[1], a[2] + sign * b[2], a[3] + sign * b[3]};
    };
    for (std::size_t i = 0; i < 16; ++i) {
        if (std::isfinite(view_projection[i])) continue;
        return Error{Status::BadArgument, "view_projection", detail::format("element {} is not finite", i), ""};
    }
    const auto x = row(0), y = row(1), z = row(2), w = row(3);
    Frustum frustum;
    frustum.sides[0] = side_of(add(w, x, 1));
    frustum.sides[1] = side_of(add(w, x, -1));
    frustum.sides[2] = side_of(add(w, y, 1));
    frustum.sides[3] = side_of(add(w, y, -1));
    frustum.sides[4] = side_of(depth == ClipDepth::ZeroToOne ? z : add(w, z, 1));
    frustum.sides[5] = side_of(add(w, z, -1));
    int degenerate = 0;
    for (std::size_t i = 0; i < 6; ++i) {
        const Frustum::Side& side = frustum.sides[i];
        if (length_squared(side.normal) > 0) continue;
        if (i >= 4 && side.offset >= 0 && ++degenerate == 1) continue;
        return Error{Status::BadArgument, "view_projection", "the planes of its frustum enclose no space", ""};
    }
    return frustum;
}

bool overlaps(const Frustum& frustum, const Aabb& box) {
    if (is_empty(box)) return false;
    for (const Frustum::Side& side : frustum.sides) {
        // NaN (infinite in both directions) counts as overlap.
        if (-farthest_along(-side.normal, box) > side.offset) return false;
    }
    return true;
}

bool contains(const Frustum& frustum, const Aabb& box) {
    if (is_empty(box)) return false;
    for (const Frustum::Side& side : frustum.sides) {
        if (!(farthest_along(side.normal, box) <= side.offset)) return false;
    }
    return true;
}

Aabb bounds(const Frustum& frustum) {
    Vec3d lo{Aabb::infinity, Aabb::infinity, Aabb::infinity}, hi = -lo;
    for (std::size_t corner = 0; corner < 8; ++corner) {
        const Frustum::Side& a = frustum.sides[corner & 1];
        const Frustum::Side& b = frustum.sides[2 + ((corner >> 1) & 1)];
        const Frustum::Side& c = frustum.sides[4 + (corner >> 2)];
        const double volume = dot(a.normal, cross(b.normal, c.normal));
        const Vec3d point = (cross(b.normal, c.normal) * a.offset + cross(c.normal, a.normal) * b.offset +
                             cross(a.normal, b.normal) * c.offset) *
                            (1 / volume);
        if (!(volume > 1e-9 || volume < -1e-9) || !is_finite(point)) return Aabb::everything();
        lo = min(lo, point);
        hi = max(hi, point);
    }
    const double slack = 1e-6 * length(hi - lo);
    const Vec3d out{slack, slack, slack};
    return rounded_outward(lo - out, hi + out);
}

}  // namespace fase
