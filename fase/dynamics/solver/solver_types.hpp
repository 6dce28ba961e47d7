#pragma once
/// Data of the contact solver: bodies in 64-byte rows, contacts in blocks of eight lanes.
#include <cstdint>
#include <vector>

#include "fase/math/vec3.hpp"

namespace fase::dynamics {

/// Lanes of a block. Every SIMD width processes them in the same order, so all give the same bits.
inline constexpr int block_lanes = 8;

/// One body in the solver. Row 0 is the static world; the last row receives the writes of unused lanes.
struct alignas(64) SolverBody {
    float velocity[3] = {};
    float inverse_mass = 0;
    float spin[3] = {};
    float unused_0 = 0;
    float moved[3] = {};  ///< metres since the beginning of the step
    float unused_1 = 0;
    float turned[4] = {0, 0, 0, 1};  ///< rotation since the beginning of the step (x, y, z, w)
};
static_assert(sizeof(SolverBody) == 64);

/// A body's inverse inertia in world axes (xx, xy, xz, yy, yz, zz) at the beginning of the step, and its inverse mass.
struct alignas(32) SolverMass {
    float inertia[6] = {};
    float inverse_mass = 0;
    float unused = 0;
};
static_assert(sizeof(SolverMass) == 32);

/// Eight contacts that share no dynamic body. The normal velocity is affine in the two tangent coordinates of a point,
/// so a contact stores one frame and a symmetric 3 x 3 matrix instead of one Jacobian per point, and each body receives
/// one impulse per pass.
struct alignas(64) ContactBlock {
    std::uint32_t a[8], b[8];  ///< rows of SolverBody; b is always dynamic (or the last row)
    std::uint32_t contact[8];  ///< index of the Contact; no_index in unused lanes
    float normal[3][8], tangent[3][8];
    float offset_a[3][8], offset_b[3][8];
    float x[4][8], y[4][8];
    float separation[4][8];  ///< at the beginning of the step; huge for absent points
    float impulse[4][8];
    float point_mass[4][8];     ///< effective mass along the normal; 0: absent point
    float coupling[6][8];       ///< the symmetric 3 x 3: 00 01 02 11 12 22
    float friction_mass[3][8];  ///< inverse of the tangent 2 x 2: 00 01 11
    float twist_mass[8];
    float twist_coupling[2][8];  ///< tangent velocity from a twist impulse of 1
    float friction_impulse[2][8];
    float twist_impulse[8];
    float lever[4][8];  ///< distance of the points from the centre
    float friction[8];
    float restitution[8];              ///< 0: skipped by the restitution pass
    float approach[4][8];              ///< m/s at the beginning of the step, positive when closing
    float closing[8];                  ///< m/s of closing velocity that gravity and forces add per sub-step
    float turn_a[4][8], turn_b[4][8];  ///< rotation of the bodies since the manifold was computed
    float shift[3][8];                 ///< relative motion of the centres since then
};

/// Coefficients of a soft constraint. Source: Catto 2011, Soft constraints.
struct Softness {
    float bias_rate = 0, mass_scale = 1, impulse_scale = 0;
};
/// Returns the coefficients of a spring: `frequency` in Hz, `sub_step` in seconds. A frequency of 0 gives a rigid one.
[[nodiscard]] Softness make_softness(float frequency, float damping_ratio, float sub_step);

/// Blocks that can be solved in parallel: no dynamic body is in two of them.
struct Colour {
    std::vector<ContactBlock> blocks;
    std::uint32_t contacts = 0;
    bool one_sided = false;  ///< every a is static or kinematic: it is read, never written
};

/// The arguments of a pass apart from the blocks.
struct PassInput {
    SolverBody* bodies = nullptr;
    const SolverMass* masses = nullptr;
    float sub_step = 0;
    Softness softness;  ///< stiffer for one-sided colours
    float push_out_speed = 3;
};

}  // namespace fase::dynamics
