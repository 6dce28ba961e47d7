#pragma once
/// The values of Settings that the solver uses.
#include "fase/dynamics/solver/integrate.hpp"

namespace fase::dynamics {

struct SolverSettings {
    Vec3 gravity;
    float time_step = 0;
    int sub_steps = 4;
    float warm_start_scale = 1;  ///< length of this sub-step over that of the last step
    float contact_frequency = 30;
    float contact_damping_ratio = 10;
    float push_out_speed = 3;
    float restitution_threshold = 0.1f;
    float resting_gap = 0.005f;  ///< m; contacts that are closer carry a load
    SpeedLimits speed_limits;

    [[nodiscard]] float sub_step() const { return time_step / static_cast<float>(sub_steps); }
};

}  // namespace fase::dynamics
