/// The suite `ghosts`: bodies move over seams as over one plane, and real obstacles stop them.
#include <algorithm>
#include <cmath>
#include <string>

#include "bench/checks/ghost_cases.hpp"
#include "bench/checks/ghost_scenes.hpp"

namespace fase::checks {
namespace {

constexpr float speeds[]{0.1f, 1, 5, 20, 60};

/// The differences of many runs.
struct Differences {
    std::vector<double> all;
    [[nodiscard]] double percentile(double share) {
        if (all.empty()) return 0;
        std::sort(all.begin(), all.end());
        return all[std::min(all.size() - 1, static_cast<std::size_t>(share * static_cast<double>(all.size())))];
    }
};

/// Steps in which a body at this speed stays on the ground: at most one second.
int steps_at(float speed) { return std::min(60, static_cast<int>(18 / speed * 60)); }

/// The largest difference of velocity, in any step, between a body on the floor and the same one on one box.
/// `horizontal`: leaves out the height, in which the solver does not converge at once after a hard blow.
double difference(CheckWorld& seams, CheckWorld& smooth, Mover mover, const BodyDef& start, float speed,
                  bool horizontal) {
    const BodyId a = add_mover(seams, mover, start), b = add_mover(smooth, mover, start);
    double worst = 0;
    for (int i = 0; i < steps_at(speed); ++i) {
        if (!seams.step() || !smooth.step()) return 0;
        const BodyState over_seams = seams.state(a), over_one = smooth.state(b);
        if (std::max(std::abs(over_one.centre.x), std::abs(over_one.centre.z)) > 11) break;
        Vec3 change = over_seams.linear_velocity - over_one.linear_velocity;
        if (horizontal) change.y = 0;
        worst = std::max(worst, double(length(change)));
    }
    seams.succeeds(seams->remove_body(a));
    smooth.succeeds(smooth->remove_body(b));
    return worst;
}

/// A random start from which the body crosses the middle of the ground.
BodyDef random_start(Mover mover, float speed, Random& random) {
    const Vec3d direction = horizontal_direction(random);
    const Vec3d middle{double(random.between(-1, 1)), 0, double(random.between(-1, 1))};
    return moving_body(mover, middle - direction * std::min(9.0, double(speed) * 0.5), direction, speed, random);
}

/// How a case of differences starts its bodies.
struct Approach {
    std::string_view name;
    bool falls = false;  ///< onto the ground, at 10 to 80 degrees
    bool wall = false;   ///< along a wall, and gravity pulls towards it
};

/// A random start for an approach.
BodyDef approaching(const Approach& approach, Mover mover, float speed, Random& random) {
    BodyDef def = random_start(mover, speed, random);
    if (approach.falls) {
        const double steep = double(random.between(0.17f, 1.4f)), back = double(random.between(0.2f, 2));
        const Vec3d ahead = normalized(to_double(def.linear_velocity));
        const Vec3d way = ahead * std::cos(steep) - Vec3d{0, std::sin(steep), 0};
        def.position -= ahead * (ahead.x * def.position.x + ahead.z * def.position.z) + way * back;
        def.linear_velocity = to_float(way * double(speed));
        def.angular_velocity = {};
    }
    if (approach.wall) {
        const float side = random.unit() < 0.5f ? -1 : 1;
        def.linear_velocity = {side * speed, 0, 0};
        def.angular_velocity = {};
        def.rotation = mover == Mover::LyingCapsule ? about_axis({0, 0, 1}, 1.5707963267948966) : Quat{};
        const double half = mover == Mover::Box || mover == Mover::SpunBox ? 0.35 : mover == Mover::Ball ? 0.25 : 0.2;
        def.position.z = 2 - half;
        def.position.x = -double(side) * std::min(9.0, double(speed) * 0.5) + double(random.between(-1, 1));
    }
    return def;
}

Settings settings_for(const Approach& approach) {
    Settings settings = awake_settings();
    if (approach.wall) settings.gravity = {0, -9.81f, 5};
    return settings;
}

Case over_seams(std::string_view floor_name, Floor floor, const Approach& approach, const MoverKind& kind, double limit,
                double worst) {
    return {std::string(approach.name) + std::string(floor_name) + "_" + std::string(kind.name),
            {at_most("worst", "m/s", worst), at_most("p99", "m/s", limit), shown("kicked", "%")},
            false,
            [floor, approach, mover = kind.mover](Context& context) -> std::vector<double> {
                CheckWorld seams(context, settings_for(approach)), smooth(context, settings_for(approach));
                add_floor(seams, floor, approach.wall);
                add_floor(smooth, Floor::Smooth, approach.wall);
                Differences found;
                const int runs = std::max(1, context.runs / 5);
                int kicked = 0;
                for (const float speed : speeds) {
                    Random random(context.seed, 71 + static_cast<std::uint64_t>(speed * 10));
                    for (int i = 0; i < runs; ++i) {
                        const BodyDef start = approaching(approach, mover, speed, random);
                        found.all.push_back(difference(seams, smooth, mover, start, speed, approach.falls));
                        if (found.all.back() > 0.02 + 0.02 * double(speed)) ++kicked;
                    }
                }
                return {found.percentile(1), found.percentile(0.99),
                        100.0 * kicked / static_cast<double>(found.all.size())};
            }};
}

std::vector<Case> ghost_cases() {
    std::vector<Case> all;
    // The steps of uneven tiles are real, and what a hard blow turns meets them with its edges.
    for (const MoverKind& kind : movers()) {
        all.push_back(over_seams("tiles", Floor::Tiles, {""}, kind, 1e-3, 1e-3));
        all.push_back(over_seams("turned_tiles", Floor::TurnedTiles, {""}, kind, 1e-3, 1e-3));
        all.push_back(over_seams("t_junctions", Floor::TJunctions, {""}, kind, 1e-3, 1e-3));
        all.push_back(over_seams("triangles", Floor::Triangles, {""}, kind, 1e-3, 1e-3));
        all.push_back(over_seams("uneven", Floor::Uneven, {""}, kind, 5e-3, 5e-3));
        all.push_back(over_seams("blocks", Floor::Blocks, {""}, kind, 1e-3, 1e-3));
        all.push_back(over_seams("blocks", Floor::Blocks, {.name = "landing_on_", .falls = true}, kind, 5e-3, 0.1));
        if (kind.mover != Mover::Wheel && kind.mover != Mover::Hull)
            all.push_back(
                over_seams("blocks", Floor::Blocks, {.name = "along_wall_of_", .wall = true}, kind, 1e-3, 1e-3));
    }
    append_obstacle_cases(all);
    return all;
}

}  // namespace

extern const Suite ghosts;
const Suite ghosts{"ghosts", "Bodies move over seams as over one plane, and real obstacles stop them.", ghost_cases};

}  // namespace fase::checks
