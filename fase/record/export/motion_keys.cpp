/// Computes distances from interpolated values.
#include "fase/record/export/motion_keys.hpp"

#include <cmath>

namespace fase::record {
namespace {

double dot4(Quatd a, Quatd b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
Quatd mix4(Quatd a, double s, Quatd b, double t) {
    return {a.x * s + b.x * t, a.y * s + b.y * t, a.z * s + b.z * t, a.w * s + b.w * t};
}

}  // namespace

double distance_between(Vec3d a, Vec3d b, double fraction, Vec3d value) {
    return length(a + (b - a) * fraction - value);
}

double distance_between(Quatd a, Quatd b, double fraction, Quatd value) {
    double cosine = dot4(a, b);
    if (cosine < 0) {
        b = {-b.x, -b.y, -b.z, -b.w};
        cosine = -cosine;
    }
    Quatd between = mix4(a, 1 - fraction, b, fraction);
    if (cosine < 0.9999) {
        const double angle = std::acos(cosine);
        between = mix4(a, std::sin((1 - fraction) * angle), b, std::sin(fraction * angle));
    }
    const Quatd difference = conjugate(normalized(between)) * value;
    return 2 * std::atan2(length(difference.vector()), std::abs(difference.w));
}

}  // namespace fase::record
