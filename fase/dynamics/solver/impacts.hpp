#pragma once
/// Impacts: collisions with restitution, solved at the moment of touch.
#include <span>
#include <vector>

#include "fase/core/tasks.hpp"
#include "fase/dynamics/solver/contact_passes.hpp"
#include "fase/dynamics/solver/integrate.hpp"
#include "fase/dynamics/solver/solver_types.hpp"

namespace fase::dynamics {

/// Bodies and limits of one sub-step.
struct ImpactInput {
    std::span<SolverBody> bodies;
    std::span<const SolverMass> masses;
    std::span<SolverMotion> motions;
    float sub_step = 0;
    float threshold = 0.1f;  ///< m/s; a slower approach does not bounce
};

/// Reflects the bodies of all contacts that would touch within a sub-step and have restitution. Call it between the
/// integration of velocities and that of poses, before contacts are solved.
///
/// All points that touch are solved together by Gauss-Seidel until they converge: each leaves with its restitution
/// times its speed at the moment of touch, or faster; so a box that lands flat does not spin. Friction acts inside the
/// cone of these impulses. An impact may start another one (Newton's cradle): rounds follow until nothing approaches.
/// The moment of touch lies inside the sub-step, so the path is corrected by change of velocity times time before
/// touch: with restitution 1, energy is conserved to rounding, whatever the sub-step. A round that would add energy
/// (friction with restitution can: Kane, Levinson 1985, Dynamics: theory and applications) is repeated without
/// friction. Source of rounds before contact: Guendelman, Bridson, Fedkiw 2003, Nonconvex rigid bodies with stacking.
class Impacts {
public:
    /// Solves the contacts that Pass::FindImpacts has marked, once. Returns whether there were any.
    bool solve_round(std::span<Colour> colours, const ImpactInput& input);
    /// Corrects the paths for the time before the impacts of this sub-step. Call after the integration of poses.
    void correct_paths(std::span<SolverBody> bodies, std::span<SolverMotion> motions);
    /// More rounds than this in a sub-step are left to the contacts.
    static constexpr int max_rounds = 16;

private:
    struct Point {
        Vec3 a, b;         // offsets from the centres of mass
        float mass = 0;    // effective, along the normal
        float target = 0;  // m/s along the normal after the impact
        float approach = 0;
        float time = 0;  // seconds from the beginning of the sub-step to the moment of touch
        float impulse = 0;
        int index = 0;  // of the manifold
    };
    struct Hit {
        ContactBlock* block;
        int lane;
        std::uint32_t a, b;
        Vec3 normal, tangent, second;
        Vec3 centre_a, centre_b;
        float friction_mass[3];
        float friction;
        float friction_impulse[2] = {};
        int count = 0;
        Point points[4];
    };
    struct Touched {
        std::uint32_t row;
        Vec3 velocity, spin;  // before the round
        Vec3 moved, rotated;  // correction of the path
    };
    struct Delay {
        std::uint32_t row;
        Vec3 moved, rotated;
    };
    void gather(std::span<Colour> colours, const ImpactInput& input);
    bool add_points(Hit& hit, const ImpactInput& input) const;
    /// Returns the speed along the normal, positive when the bodies separate.
    static float normal_speed(const ImpactInput& input, const Hit& hit, const Point& point);
    static void push(const ImpactInput& input, const Hit& hit, Vec3 impulse, Vec3 a, Vec3 b);
    /// Gives all points of a manifold equal impulses: an even load stays even.
    static void solve_common(const ImpactInput& input, Hit& hit);
    /// Returns by how much the speed of the point missed its target, m/s.
    static float solve_point(const ImpactInput& input, const Hit& hit, Point& point);
    static void solve_friction(const ImpactInput& input, Hit& hit);
    void iterate(const ImpactInput& input, bool with_friction);
    std::vector<Touched>::iterator find_touched(std::uint32_t row);
    [[nodiscard]] double added_energy(const ImpactInput& input);
    void restore_velocities(const ImpactInput& input);
    void finish(const ImpactInput& input);

    std::vector<Hit> hits_;
    std::vector<Touched> touched_;
    std::vector<Delay> delays_;  // of all rounds of the sub-step
};

}  // namespace fase::dynamics
