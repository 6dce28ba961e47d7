#pragma once
/// Two capsules.
#include "fase/geometry/shapes/capsule.hpp"
#include "fase/narrow/pairs/round.hpp"

namespace fase::narrow {

/// Two points, at the ends of the interval that both share, when the axes are within some 3° of parallel and both ends
/// are within the margin; else one, between the closest points. Axes that cross: the normal is perpendicular to both.
/// Features: 0 the single point, 1 and 2 the lower and upper end of the interval along a.
/// Source: Ericson 2005, Real-Time Collision Detection, 5.1.9.
[[nodiscard]] inline Manifold collide(const Capsule& a, const Capsule& b, const LocalPose& b_in_a, float margin) {
    // Along a: (0, s, 0), |s| <= ha. Along b: centre + axis * t, |t| <= hb.
    const Vec3 axis = rotate(b_in_a.rotation, Vec3{0, 1, 0}), centre = b_in_a.position;
    const float ha = a.half_length, hb = b.half_length;
    const float aligned = axis.y, off_axis = axis.x * axis.x + axis.z * axis.z;
    const float along_b = dot(centre, axis);
    constexpr float no_direction = 1e-6f;
    // Nearly parallel lines: start from the middle of the shared interval.
    float s;
    if (off_axis > no_direction) {
        s = clamp_to((centre.y - aligned * along_b) / off_axis, ha);
    } else {
        const float lo = centre.y - hb > -ha ? centre.y - hb : -ha, hi = centre.y + hb < ha ? centre.y + hb : ha;
        s = clamp_to((lo + hi) * 0.5f, ha);
    }
    const float t = clamp_to(s * aligned - along_b, hb);
    s = clamp_to(centre.y + aligned * t, ha);
    const auto on_a = [](float along) { return Vec3{0, along, 0}; };
    const auto on_b = [&](float along) { return centre + axis * along; };
    const Vec3 crossing = cross(Vec3{0, 1, 0}, axis);
    Vec3 sideways = off_axis > no_direction ? normalized(crossing) : any_perpendicular(Vec3{0, 1, 0});
    if (dot(sideways, centre) < 0) sideways = -sideways;
    Manifold manifold = touch_round(on_a(s), a.radius, on_b(t), b.radius, margin, sideways, 0);
    constexpr float parallel = 2.5e-3f;
    if (manifold.count == 0 || off_axis > parallel) return manifold;

    const float end_1 = centre.y - aligned * hb, end_2 = centre.y + aligned * hb;
    const float low = end_1 < end_2 ? end_1 : end_2, high = end_1 < end_2 ? end_2 : end_1;
    const float lo = low > -ha ? low : -ha, hi = high < ha ? high : ha;
    if (!(hi - lo > 0.05f * (a.radius + b.radius))) return manifold;
    const auto point = [&](float along, std::uint32_t feature) {
        const Vec3 core_b = on_b(clamp_to((along - centre.y) / aligned, hb));
        const float distance = length(core_b - on_a(along));
        return ManifoldPoint{on_a(along) + manifold.normal * ((a.radius + distance - b.radius) * 0.5f),
                             distance - a.radius - b.radius, feature};
    };
    use_both_ends(point(lo, 1), point(hi, 2), margin, a.radius < b.radius ? a.radius : b.radius, manifold);
    return manifold;
}

}  // namespace fase::narrow
