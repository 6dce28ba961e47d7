#pragma once
/// Mass, centre and inertia of shapes and of compound bodies.
#include <span>

#include "fase/core/result.hpp"
#include "fase/geometry/shapes.hpp"
#include "fase/math/pose.hpp"

namespace fase {

/// Mass, centre of mass and inertia tensor. `inertia` is about `centre`, in the frame of `centre`, kg m².
struct MassProperties {
    float mass = 0;  ///< kg
    Vec3 centre;     ///< metres
    Mat3 inertia;
};

/// Returns the mass properties of a solid of uniform density (kg/m³). All zero for a half-space. Source for hulls:
/// Mirtich 1996, Fast and accurate computation of polyhedral mass properties (here by signed tetrahedra, in double).
[[nodiscard]] MassProperties mass_properties(const Shape& shape, float density);

/// Returns the mass properties in another frame: `pose` maps points of the old frame to the new one.
[[nodiscard]] MassProperties transformed(const MassProperties& properties, const LocalPose& pose);

/// Combines several parts in one frame. All zero when there is no part or no mass.
[[nodiscard]] MassProperties combined(std::span<const MassProperties> parts);

/// Principal moments (kg m²) and the rotation whose columns are their axes: inertia = R diag(moments) Rᵀ.
struct PrincipalInertia {
    Vec3 moments;
    Quat axes;
};
/// Diagonalises by cyclic Jacobi rotations in double (Golub, Van Loan 2013, Matrix Computations, 8.5). A diagonal
/// matrix gives exactly its diagonal and the identity rotation. The order of the moments minimises the rotation angle.
[[nodiscard]] PrincipalInertia principal(const Mat3& inertia);

/// Returns an error that names the fault unless mass is finite and above 0, and inertia is finite, symmetric, positive
/// definite, and each principal moment is at most the sum of the other two (true for every solid), within 1e-4 of their
/// sum.
Result<void> check(const MassProperties& properties);

/// Returns an error that names the field unless every size is finite and in range (1e-4 m to 1e5 m; 0 where the shape
/// allows it), and a hull is closed, convex and of volume above 0.
Result<void> check(const Shape& shape);

}  // namespace fase
