#pragma once
/// Mass, centre and inertia in double.
#include "fase/geometry/mass.hpp"

namespace fase::detail {

constexpr double pi = 3.14159265358979323846;

/// MassProperties in double, for sums.
struct Solid {
    double mass = 0;
    Vec3d centre;
    Mat3d inertia;  ///< about `centre`
};

inline MassProperties rounded(const Solid& s) {
    return {static_cast<float>(s.mass), to_float(s.centre), to_float(s.inertia)};
}

inline Mat3d outer_product(Vec3d a, Vec3d b) { return {a * b.x, a * b.y, a * b.z}; }

/// Returns the inertia of a point mass at `position` about the origin.
inline Mat3d point_inertia(double mass, Vec3d position) {
    const double square = length_squared(position);
    return (Mat3d::diagonal({square, square, square}) - outer_product(position, position)) * mass;
}

}  // namespace fase::detail
