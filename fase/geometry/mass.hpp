#pragma once
/// Mass, centre and inertia of shapes and of bodies made of several.
#include <span>

#include "fase/core/result.hpp"
#include "fase/geometry/shapes.hpp"
#include "fase/math/pose.hpp"

namespace fase {

/// How heavy, where the centre lies, how hard to turn. `inertia` is about `centre`, along the axes of the frame that
/// `centre` is given in, kg m².
struct MassProperties {
    float mass = 0;  ///< kg
    Vec3 centre;     ///< metres
    Mat3 inertia;
};

/// Of a solid of even density (kg/m³). All zero for a half-space. Source for hulls: Mirtich 1996, Fast and accurate
/// computation of polyhedral mass properties (here by signed tetrahedra, in double).
[[nodiscard]] MassProperties mass_properties(const Shape& shape, float density);

/// The same seen from another frame: `placed` takes points of the old frame to the new.
[[nodiscard]] MassProperties moved(const MassProperties& properties, const LocalPose& placed);

/// Several parts that share a frame, as one. No part, or no mass: all zero.
[[nodiscard]] MassProperties combined(std::span<const MassProperties> parts);

/// Principal moments (kg m²) and the rotation whose columns are their axes: inertia = R diag(moments) Rᵀ.
struct PrincipalInertia {
    Vec3 moments;
    Quat axes;
};
/// By cyclic Jacobi rotations in double (Golub, Van Loan 2013, Matrix Computations, 8.5). A diagonal matrix gives
/// exactly its diagonal and no rotation. Moments come in the order that needs the least turning.
[[nodiscard]] PrincipalInertia principal(const Mat3& inertia);

/// An error that names what is wrong unless: mass finite and above 0, inertia finite, symmetric, positive definite, and
/// each principal moment at most the sum of the other two (no solid has others), within 1e-4 of their sum.
Result<void> check(const MassProperties& properties);

/// An error that names the field unless every size is finite, in range (1e-4 m to 1e5 m; 0 allowed where the shape says
/// so) and a hull is closed, convex and of volume above 0.
Result<void> check(const Shape& shape);

}  // namespace fase
