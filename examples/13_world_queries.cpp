// World queries: ray cast, shape cast, overlap, nearest bodies, frustum.
#include <array>
#include <cstdio>

#include "fase/world/query.hpp"

int main() {
    fase::Result<fase::World> world = fase::World::create();
    if (!world) return std::puts(world.error().text().c_str()), 1;
    static_cast<void>(world->add_body({.kind = fase::BodyKind::Static}, fase::HalfSpace{}));
    for (int i = 0; i < 5; ++i)  // a tower of five crates, 10 m down the z axis
        static_cast<void>(world->add_body({.position = {0, 0.5 + i, -10}}, fase::Box{}));
    const auto ball = world->add_body({.position = {0, 1.5, 0}}, fase::Sphere{.radius = 0.3f});
    if (!ball) return std::puts(ball.error().text().c_str()), 1;

    // Queries see the current state of the world; no step is needed first.
    const fase::QueryFilter not_ball{.ignored = *ball};
    const fase::Ray ahead{{0, 1.5, 0}, {0, 0, -1}, 100};
    const auto hit = fase::cast_ray(*world, ahead, not_ball);
    if (!hit) return std::puts(hit.error().text().c_str()), 1;  // the ray is invalid
    if (*hit)
        std::printf("the ray hits body %u after %.2f m\n", (*hit)->body.index, static_cast<double>((*hit)->distance));

    // A shape cast of the ball: it stops one radius before the crates.
    const auto cast = fase::cast_shape(*world, fase::Sphere{0.3f}, {{0, 1.5, 0}, {}}, {0, 0, -1}, 100, not_ball);
    if (cast && *cast)
        std::printf("the ball moves %.2f m, normal z = %.0f\n", static_cast<double>((*cast)->distance),
                    static_cast<double>((*cast)->normal.z));

    // Lists are appended to the caller's buffer, in a deterministic order.
    std::vector<fase::Found> found;
    static_cast<void>(fase::overlapping(*world, fase::Sphere{1.2f}, {{0, 4.5, -10}, {}}, {}, found));
    std::printf("%zu crates within 1.2 m of the top one's middle\n", found.size());
    std::vector<fase::NearHit> near;
    static_cast<void>(fase::nearest(*world, {0, 3, 0}, 2, 50, {}, near));
    for (const fase::NearHit& n : near)
        std::printf("body %u is %.2f m from there\n", n.body.index, static_cast<double>(n.distance));

    // A camera at (0, 3, 0) that looks along -z, 90 degrees wide and high, from 0.1 to 1000 m.
    const std::array<float, 16> view_projection{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.0002f, -1, 0, -3, -0.20002f, 0};
    const auto frustum = fase::frustum_of(view_projection);
    std::vector<fase::Found> seen, partly;
    if (frustum) static_cast<void>(fase::seen_by(*world, *frustum, {}, seen, &partly));
    std::printf("the camera sees %zu of %zu bodies, %zu of them partly\n", seen.size(), world->body_count(),
                partly.size());
    return *hit && *cast && found.size() == 2 && near.size() == 2 && seen.size() == 6 ? 0 : 1;
}
