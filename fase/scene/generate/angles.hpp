#pragma once
/// Sine and cosine with the same bits on every machine, so that generated scenes are reproducible.
#include "fase/math/quat.hpp"

namespace fase::scene {

inline constexpr double pi = 3.14159265358979323846;

/// Sine and cosine of one angle.
struct SinCos {
    double sin = 0, cos = 1;
};

/// Returns sine and cosine of an angle in radians, accurate to 1e-13 for |angle| up to 100. Reduces the angle to ±pi/4
/// and sums the Taylor series. Uses only additions, multiplications and divisions, so it does not depend on a math
/// library.
[[nodiscard]] constexpr SinCos sin_cos(double angle) {
    const double quarters = angle * (2 / pi);
    const int turns = static_cast<int>(quarters + (quarters < 0 ? -0.5 : 0.5));
    const double x = angle - turns * (pi / 2);
    const double squared = x * x;
    double sine = 0, cosine = 0;
    for (int n = 18; n >= 2; n -= 2) {
        cosine = -squared * (1 + cosine) / (n * (n - 1));
        sine = -squared * (1 + sine) / ((n + 1) * n);
    }
    sine = x * (1 + sine);
    cosine += 1;
    switch (turns & 3) {
        case 0: return {sine, cosine};
        case 1: return {cosine, -sine};
        case 2: return {-sine, -cosine};
        default: return {-cosine, sine};
    }
}

/// Returns the rotation by `angle` radians about a unit axis.
[[nodiscard]] constexpr Quat rotation_about(Vec3 axis, double angle) {
    const SinCos half = sin_cos(angle / 2);
    const float s = static_cast<float>(half.sin);
    return {axis.x * s, axis.y * s, axis.z * s, static_cast<float>(half.cos)};
}

}  // namespace fase::scene
