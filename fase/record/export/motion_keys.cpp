/// Distances from interpolated values.
#include "fase/record/export/motion_keys.hpp"

#include <cmath>

namespace fase::record {
namespace {

double dot4(Quatd a, Quatd b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
Quatd mix4(Quatd a, double s, Quatd b, double t) {
    return {a.x * s + b.x * t, a.y * s + b.y * t, a.z * s + b.z * t, a.w * s + b.w * t};
}

}  // namespace

double distance_between(Vec3d a, Vec3d b, double share, Vec3d value) { return length(a + (b - a) * share - value); }

double distance_between(Quatd a, Quatd b, double share, Quatd value) {
    double cosine = dot4(a, b);
    if (cosine < 0) {
        b = {-b.x, -b.y, -b.z, -b.w};
        cosine = -cosine;
    }
    Quatd between = mix4(a, 1 - share, b, share);
    if (cosine < 0.9999) {
        const double angle = std::acos(cosine);
        between = mix4(a, std::sin((1 - share) * angle), b, std::sin(share * angle));
    }
    const Quatd missed = conjugate(normalized(between)) * value;
    return 2 * std::atan2(length(missed.vector()), std::abs(missed.w));
}

}  // namespace fase::record
