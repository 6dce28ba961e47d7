/// Sensors in the suite `rest`: over sleeping bodies, and the step in which the end of an overlap is told.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "bench/checks/check_world.hpp"
#include "bench/checks/rest_cases.hpp"
#include "fase/world/query.hpp"

namespace fase::checks {
namespace {

const Box zone{{2, 1, 2}};
const ColliderDef sensor{.sensor = true};

/// Events of sensors in some steps.
struct Told {
    double begun = 0, ended = 0;
};
Told events_in(CheckWorld& world, double seconds) {
    Told told;
    for (int i = world.steps_in(seconds); i > 0 && world.step(); --i) {
        told.begun += static_cast<double>(world->events().sensors_begun.size());
        told.ended += static_cast<double>(world->events().sensors_ended.size());
    }
    return told;
}

using Change = void (*)(CheckWorld& world, BodyId sensor);
struct Scene {
    std::string name;
    Told expected;
    bool visitor_asleep = false;     ///< made asleep, instead of fallen asleep
    bool visitor_kinematic = false;  ///< a resting kinematic body
    Vec3d sensor_at{0, 1, 0};        ///< at the start
    Change change = nullptr;         ///< what happens after 3 s
    bool sensor_from_start = true;   ///< false: the change makes it
    BodyKind sensor_kind = BodyKind::Static;
};

template <int x_in_millimetres> void move_sensor(CheckWorld& world, BodyId body) {
    world.succeeds(world->set_pose(body, {{x_in_millimetres / 1000.0, 1, 0}, {}}));
}
void make_sensor(CheckWorld& world, BodyId) {
    world.add({.kind = BodyKind::Static, .position = {0, 1, 0}}, zone, sensor);
}
void enlarge_sensor(CheckWorld& world, BodyId body) {
    world.succeeds(world->add_collider(body, Box{{10, 1, 2}}, sensor));
}

std::vector<Scene> scenes() {
    const Vec3d over{0, 1, 0}, away{8, 1, 0};
    return {{.name = "made_over_sleeper", .expected = {1, 0}, .change = make_sensor, .sensor_from_start = false},
            {.name = "moved_onto_sleeper", .expected = {1, 0}, .sensor_at = away, .change = move_sensor<0>},
            {.name = "moved_2_cm_off_sleeper", .expected = {0, 1}, .sensor_at = over, .change = move_sensor<2520>},
            {.name = "enlarged_over_sleeper", .expected = {1, 0}, .sensor_at = away, .change = enlarge_sensor},
            {.name = "moved_onto_resting_kinematic",
             .expected = {1, 0},
             .visitor_kinematic = true,
             .sensor_at = away,
             .change = move_sensor<0>},
            {.name = "kinematic_moved_onto_sleeper",
             .expected = {1, 0},
             .sensor_at = away,
             .change = move_sensor<0>,
             .sensor_kind = BodyKind::Kinematic},
            {.name = "over_body_made_asleep", .expected = {1, 0}, .visitor_asleep = true}};
}

Case told_of_sleeper(const Scene& scene) {
    return {"sensor_" + scene.name,
            {exactly("begun", scene.expected.begun), exactly("ended", scene.expected.ended)},
            false,
            [=](Context& context) -> std::vector<double> {
                CheckWorld world(context);
                world.add_ground();
                BodyId body{};
                if (scene.sensor_from_start)
                    body = world.add({.kind = scene.sensor_kind, .position = scene.sensor_at}, zone, sensor);
                world.add({.kind = scene.visitor_kinematic ? BodyKind::Kinematic : BodyKind::Dynamic,
                           .position = {0, 0.5, 0},
                           .awake = !scene.visitor_asleep},
                          Box{});
                if (scene.change != nullptr) {
                    if (!world.run(3)) return {};
                    scene.change(world, body);
                }
                const Told told = events_in(world, 1);
                return {told.begun, told.ended};
            }};
}

/// A box leaves a sensor at some speed, or stops just outside it. The end must be told in the step in which the shapes
/// part, as an overlap query sees them.
Case told_at_once(const std::string& name, float speed, bool stops) {
    return {"sensor_left_" + name,
            {exactly("steps_late", 0), exactly("ended", 1)},
            false,
            [=](Context& context) -> std::vector<double> {
                Settings settings;
                settings.gravity = {};
                CheckWorld world(context, settings);
                const Box cube{{1, 1, 1}};
                world.add({.kind = BodyKind::Static}, cube, sensor);
                const BodyId box = world.add({.position = {1.499, 0, 0}}, Box{});
                if (!world.step()) return {};
                world.succeeds(world->set_velocity(box, {speed, 0, 0}, {}));
                double late = 0, ended = 0;
                int parted = -1, told = -1;
                for (int i = 0; i < world.steps_in(5); ++i) {
                    if (stops && parted >= 0) world.succeeds(world->set_velocity(box, {}, {}));
                    if (!world.step()) return {};
                    std::vector<Found> found;
                    world.succeeds(overlapping(*world, cube, Pose{}, QueryFilter{}, found));
                    if (found.empty() && parted < 0) parted = i;
                    ended += static_cast<double>(world->events().sensors_ended.size());
                    if (ended > 0 && told < 0) told = i;
                }
                late = told < 0 ? world.steps_in(5) : told - parted;
                return {late, ended};
            }};
}

}  // namespace

void append_sensor_cases(std::vector<Case>& cases) {
    for (const Scene& scene : scenes()) cases.push_back(told_of_sleeper(scene));
    cases.push_back(told_at_once("slowly", 0.05f, false));
    cases.push_back(told_at_once("and_stopped", 0.05f, true));
    cases.push_back(told_at_once("at_1_m_per_s", 1, false));
    cases.push_back(told_at_once("at_10_m_per_s", 10, false));
}

}  // namespace fase::checks
