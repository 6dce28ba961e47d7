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
    float inverse_mass_z = 0;
    float spin[3] = {};
    float unused_0 = 0;
    float moved[3] = {};  ///< metres since the beginning of the step
    float unused_1 = 0;
    float rotated[3] = {};  ///< the integral of the spin since the beginning of the step, radians
    float unused_2 = 0;
};
static_assert(sizeof(SolverBody) == 64);

/// A body's inverse inertia in world axes (xx, xy, xz, yy, yz, zz) at the beginning of the step, and its inverse mass
/// along the world's x and y axes; SolverBody has that along z. A locked axis has an inverse mass of 0.
struct alignas(32) SolverMass {
    float inertia[6] = {};
    float inverse_mass_x = 0, inverse_mass_y = 0;
};
static_assert(sizeof(SolverMass) == 32);

/// Eight contacts that share no dynamic body. The normal velocity is affine in the two tangent coordinates of a point,
/// so a contact stores one frame and a symmetric 3 x 3 matrix instead of one Jacobian per point, and each body receives
/// one impulse per pass.
struct alignas(64) ContactBlock {
    std::uint32_t a[8], b[8];  ///< rows of SolverBody; b is always dynamic (or the last row)
    float normal[3][8], tangent[3][8];
    float offset_a[3][8], offset_b[3][8];
    float x[4][8], y[4][8];
    float separation[4][8];     ///< at the beginning of the step; huge for absent points
    float change[3][8];         ///< of the separations since then: in the centre, and its slopes along x and y
    float impulse[4][8];        ///< of the sub-step
    float total[4][8];          ///< the impulses of all sub-steps and impacts
    float known_load[8];        ///< N s per point and sub-step: the weight that the contact is known to bear
    float point_mass[4][8];     ///< effective mass along the normal; 0: absent point
    float coupling[6][8];       ///< the symmetric 3 x 3: 00 01 02 11 12 22
    float friction_mass[3][8];  ///< inverse of the tangent 2 x 2: 00 01 11
    float twist_mass[8];
    float twist_coupling[2][8];  ///< tangent velocity from a twist impulse of 1
    float friction_impulse[2][8];
    float twist_impulse[8];
    float lever[4][8];  ///< distance of the points from the centre
    float friction[8];
    float restitution[8];          ///< 0: skipped by the impacts
    float turns_a[8], turns_b[8];  ///< 1: the points turn with the body; 0: they stay below it when it rolls
    // Below: not read by the passes of a contact that neither bounces nor belongs to a hub.
    float split[8];        ///< Sides::Hub: lanes of the block that share body a
    float approach[4][8];  ///< m/s at the beginning of the step or before the last impact, positive when closing
    float closing[8];      ///< m/s of closing velocity that gravity and forces add per sub-step
    float impact[8];       ///< 1: a point hits with restitution in this sub-step; set by Pass::FindImpacts
};

/// Coefficients of a soft constraint. Source: Catto 2011, Soft constraints.
struct Softness {
    float bias_rate = 0, mass_scale = 1, impulse_scale = 0;
};
/// Returns the coefficients of a spring: `frequency` in Hz, `sub_step` in seconds. A frequency of 0 gives a rigid one.
[[nodiscard]] Softness make_softness(float frequency, float damping_ratio, float sub_step);

/// Which bodies the contacts of a block may move.
enum class Sides : std::uint8_t {
    Both,
    OnlyB,  ///< every a is static or kinematic: it is read, never written
    Hub,    ///< lanes may share their body a; b is dynamic in one lane only, or static
};

/// Contacts of one colour. Blocks of a colour with Sides::Both or OnlyB can be solved in parallel: no dynamic body is
/// in two of them. Those of a hub are solved in order.
struct Colour {
    std::vector<ContactBlock> blocks;
    std::uint32_t contacts = 0;
    Sides sides = Sides::Both;
    bool on_static = false;    ///< one body of each contact is static or kinematic
    bool on_sleeper = false;   ///< one body of each contact sleeps
    bool restitution = false;  ///< a contact may bounce
};

/// The arguments of a pass apart from the blocks.
struct PassInput {
    SolverBody* bodies = nullptr;
    const SolverMass* masses = nullptr;
    float sub_step = 0;
    Softness softness;  ///< stiffer for one-sided colours
    float push_out_speed = 3;
    float impact_speed = 0.1f;  ///< m/s; a slower approach does not bounce
};

}  // namespace fase::dynamics
