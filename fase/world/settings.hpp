#pragma once
/// The settings of a world: defaults, units, and what each number controls.
#include <string>

#include "fase/core/result.hpp"
#include "fase/core/tasks.hpp"
#include "fase/math/vec3.hpp"

namespace fase {

/// Parameters of the simulation. World::set_settings() changes them between steps. Lengths are in metres and suit
/// bodies of 0.05 to 50 m; scale the values marked (length) for worlds of another size.
struct Settings {
    Vec3 gravity{0, -9.81f, 0};   ///< m/s²
    float time_step = 1.0f / 60;  ///< seconds per step(); above 0, at most 1
    int sub_steps = 4;            ///< 1..64; more sub-steps give stiffer stacks and less energy ripple, and cost more

    // Contacts. Soft contacts are mass-independent springs. Source: Catto 2011, Soft constraints; Catto 2024, Solver2D
    // ("soft step").
    /// Hz; higher is harder. At most a tenth of the sub-step rate acts: 24 Hz at 60 steps per second and 4 sub-steps,
    /// 48 Hz at 8.
    float contact_frequency = 60;
    float contact_damping_ratio = 10;    ///< 1 is critical; above 1, overlap is resolved slowly without bounce
    float push_out_speed = 3;            ///< m/s; the largest speed at which overlap is resolved (length)
    float restitution_threshold = 0.1f;  ///< m/s; a slower approach does not bounce (length)
    float speculative_distance = 0.02f;  ///< m; contacts are created at this distance before the shapes touch (length)
    float linear_slop = 0.005f;          ///< m; shapes closer than this count as touching (length)
    /// m; a manifold of three or four points is reused while each point moved less than this between its bodies
    /// (length). 0 computes every manifold in every step.
    float contact_reuse_distance = 0.01f;

    // The broad phase.
    /// m; margin of the boxes of bodies that move less than a fifth of it in a step: they query pairs only after they
    /// left their enlarged box (length). Pairs are cheap to find and dear to collide, so faster bodies get none.
    float box_margin = 0.005f;

    // Sleep. A body is at rest when for `time_to_sleep` seconds it was slower than both speeds, and the net motion of
    // its points stayed below `sleep_distance`. An island falls asleep when all its bodies are at rest, except for a
    // share of `sleep_tolerance`; parts of it that have rested for twice that time, when little else moves.
    bool sleep = true;                 ///< false: dynamic bodies never fall asleep
    float sleep_linear_speed = 0.15f;  ///< m/s
    float sleep_angular_speed = 0.3f;  ///< rad/s
    float sleep_distance = 0.01f;   ///< m; net motion: vibration about one place is rest, a slow slide is not (length)
    float sleep_tolerance = 0.02f;  ///< share of an island that need not be at rest, below twice the speeds above
    float time_to_sleep = 0.5f;     ///< seconds

    // Limits: never exceeded; the report counts what was clamped or dropped.
    float max_linear_speed = 1000;   ///< m/s
    float max_angular_speed = 1000;  ///< rad/s
    int max_pairs = 1 << 22;         ///< active pairs; the last in order are dropped. 0: no limit
};

/// Checks that every number is finite and in range. The error names the first field that is not.
Result<void> check(const Settings& settings);

/// What World::create() fixes for the lifetime of a world.
struct Setup {
    std::string structure = "auto";  ///< broad-phase structure: a name from broad/registry.hpp, or "auto"
    int threads = 1;                 ///< 0: all cores; the results are the same for any number
    TaskRunner* tasks = nullptr;  ///< the application's task scheduler, used instead of threads; must outlive the world
};

}  // namespace fase
