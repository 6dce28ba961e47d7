// Ray casts and frustum culling in an octree: nodes that are not visited are never tested.
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "fase/broad/octree.hpp"
#include "fase/core/random.hpp"
#include "fase/query/index.hpp"

struct Balloon {
    fase::Vec3d centre;
    double radius;
};

/// Returns the distance along the ray to the sphere of the balloon; the tree only has its box.
float distance_to(const fase::Ray& ray, const Balloon& b) {
    const fase::Vec3d from = ray.origin - b.centre;
    const double along = fase::dot(from, fase::to_double(ray.direction));
    const double rest = along * along - fase::length_squared(from) + b.radius * b.radius;
    const double distance = rest < 0 ? -1 : -along - std::sqrt(rest);
    return distance < 0 ? fase::broad::infinite_distance : static_cast<float>(distance);
}

/// A camera at (50, 50, 100) that looks along -z, 1 m wide at a distance of 1 m, near 1 m, far 60 m: projection times
/// view, column-major.
constexpr std::array<float, 16> camera{
    2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -61.0f / 59, -1, -100, -100, 6100.0f / 59 - 120.0f / 59, 100};

int main() {
    fase::Index<Balloon, fase::broad::Octree> sky;
    fase::Random random(4);
    for (int i = 0; i < 20'000; ++i) {
        const fase::Vec3 at{random.between(0, 100), random.between(0, 100), random.between(0, 100)};
        sky.insert(fase::enlarged({at, at}, 0.4f), {fase::to_double(at), 0.4});
    }
    sky.commit();

    const fase::Ray arrow{{-5, 50, 50}, fase::normalized(fase::Vec3{1, 0.02f, 0.01f}), 200};
    const auto box = sky.cast_ray(arrow);
    int tested = 0;
    const auto balloon = sky.cast_ray(arrow, [&](const Balloon& b, const fase::Aabb&, float, float) {
        ++tested;
        return distance_to(arrow, b);
    });
    if (!box || !balloon) return 1;
    std::printf("the arrow hits a box after %.3f m and a balloon after %.3f m\n", box->distance, balloon->distance);
    std::printf("%s of %zu balloons were tested\n", tested < 20 ? "fewer than 20" : "too many", sky.size());

    const auto frustum = fase::frustum_of(camera);
    if (!frustum) return std::puts(frustum.error().text().c_str()), 1;
    int visible = 0;
    sky.cull(*frustum, [&](const Balloon&) { ++visible; });
    std::printf("the camera sees %d of them\n", visible);
    for (const auto& near : sky.nearest({50, 50, 50}, 3)) std::printf("%.3f m from the middle\n", near.distance);
}
