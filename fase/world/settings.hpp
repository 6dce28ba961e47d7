#pragma once
/// Every number that steers a world, with its default, its unit and what it does.
#include <string>

#include "fase/core/result.hpp"
#include "fase/core/tasks.hpp"
#include "fase/math/vec3.hpp"

namespace fase {

/// How a world steps. All can be changed between steps by World::set_settings(). Lengths are in metres and suit bodies
/// of 0.05 to 50 m; scale those marked (length) for worlds of another size.
struct Settings {
    Vec3 gravity{0, -9.81f, 0};   ///< m/s²
    float time_step = 1.0f / 60;  ///< seconds a step(); above 0, at most 1
    int sub_steps = 4;            ///< 1..64; more: stiffer stacks, less energy ripple, more time

    // Contacts. Soft contacts are springs in time, so they act alike at any mass. Source: Catto 2011, Soft constraints;
    // Catto 2024, Solver2D ("soft step").
    float contact_frequency = 45;          ///< Hz, at most a quarter of the sub-step rate is used; higher: harder
    float contact_damping_ratio = 10;      ///< 1 is critical; above: sinks out slowly without bounce
    float push_out_speed = 3;              ///< m/s at most, at which overlap is undone (length)
    float restitution_threshold = 0.1f;    ///< m/s of approach below which nothing bounces (length)
    float speculative_distance = 0.02f;    ///< contacts are made this far before touch (length)
    float linear_slop = 0.005f;            ///< what counts as touching (length)
    float contact_reuse_distance = 0.01f;  ///< a manifold of several points is kept while its bodies moved less against
                                           ///< each other (length); 0: made anew each step

    // The broad phase.
    float box_margin =
        0.05f;  ///< boxes are grown by it, so that pairs are sought only when a body left its grown box (length)

    // Sleep.
    bool sleep = true;                 ///< islands at rest fall asleep
    float sleep_linear_speed = 0.15f;  ///< m/s, a body slower than this …
    float sleep_angular_speed = 0.3f;  ///< … and this (rad/s) …
    float sleep_distance = 0.01f;   ///< m; net motion: a tremble about one place is rest, a slow slide is not (length)
    float sleep_tolerance = 0.02f;  ///< share of an island that may still be restless, up to twice the speeds above
    float time_to_sleep = 0.5f;  ///< … for so many seconds, and all its points within sleep_distance of one place, may
                                 ///< sleep when its island may

    // Caps: clamped and counted in the report, never exceeded.
    float max_linear_speed = 1000;   ///< m/s
    float max_angular_speed = 1000;  ///< rad/s
    int max_pairs = 1 << 22;         ///< pairs kept; beyond, the last in order are dropped and counted. 0: no limit
};

/// An error that names the field unless every number is finite and in the range its comment gives.
Result<void> check(const Settings& settings);

/// What is fixed when a world is made.
struct Setup {
    std::string structure = "auto";  ///< the broad phase: a name of broad/registry.hpp, or "auto"
    int threads = 1;                 ///< 0: all cores; the results are the same for any number
    TaskRunner* tasks = nullptr;     ///< the user's own scheduler instead; must outlive the world
};

}  // namespace fase
