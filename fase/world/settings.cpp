/// Range checks of the settings.
#include "fase/world/settings.hpp"
#include "fase/core/detail/text.hpp"
#include "fase/world/check_values.hpp"

#include <cmath>

namespace fase {
namespace {

Error refused(const char* field, const std::string& found, const std::string& expected) {
    return {Status::BadArgument, std::string("Settings.") + field, "found " + found + "; expected " + expected, ""};
}

}  // namespace

Result<void> check(const Settings& s) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::fabs(s.gravity[axis]) <= limits::acceleration))
            return refused(axis == 0   ? "gravity.x"
                           : axis == 1 ? "gravity.y"
                                       : "gravity.z",
                           detail::found_text(s.gravity[axis]), "-1e6 to 1e6 m/s²");
    if (!(s.time_step > 0 && s.time_step <= 1))
        return refused("time_step", detail::found_text(s.time_step), "above 0, at most 1");
    if (s.sub_steps < 1 || s.sub_steps > 64) return refused("sub_steps", std::to_string(s.sub_steps), "1 to 64");
    if (s.max_pairs < 0) return refused("max_pairs", std::to_string(s.max_pairs), "0 or more");
    const struct {
        const char* field;
        float value, min, max;
    } ranges[] = {
        {"contact_frequency", s.contact_frequency, 0.01f, 1e6f},
        {"contact_damping_ratio", s.contact_damping_ratio, 0.0f, 1e6f},
        {"push_out_speed", s.push_out_speed, 0.0f, 1e6f},
        {"restitution_threshold", s.restitution_threshold, 0.0f, 1e6f},
        {"speculative_distance", s.speculative_distance, 0.0f, 1e3f},
        {"linear_slop", s.linear_slop, 0.0f, 1e3f},
        {"contact_reuse_distance", s.contact_reuse_distance, 0.0f, 1e3f},
        {"box_margin", s.box_margin, 0.0f, 1e3f},
        {"sleep_linear_speed", s.sleep_linear_speed, 0.0f, 1e6f},
        {"sleep_angular_speed", s.sleep_angular_speed, 0.0f, 1e6f},
        {"sleep_distance", s.sleep_distance, 0.0f, 1e3f},
        {"sleep_tolerance", s.sleep_tolerance, 0.0f, 1.0f},
        {"time_to_sleep", s.time_to_sleep, 0.0f, 1e6f},
        {"max_linear_speed", s.max_linear_speed, 1e-3f, 1e6f},
        {"max_angular_speed", s.max_angular_speed, 1e-3f, 1e5f},
    };
    for (const auto& range : ranges)
        if (!(range.value >= range.min && range.value <= range.max))
            return refused(range.field, detail::found_text(range.value),
                           detail::text_of(range.min) + " to " + detail::text_of(range.max));
    return {};
}

}  // namespace fase
