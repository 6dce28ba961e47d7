/// Random rotations and shapes for checks, from a seeded stream.
#include "bench/checks/random_scenes.hpp"

#include <vector>

#include "fase/geometry/hull_builder.hpp"

namespace fase::checks {

Quat random_rotation(Random& random) {
    Quat q;
    do {
        const auto part = [&] { return random.between(-1, 1); };
        q.x = part();
        q.y = part();
        q.z = part();
        q.w = part();
    } while (length_squared(q) < 0.1f || length_squared(q) > 1);
    return normalized(q);
}

Shape random_shape(Random& random, float size) {
    const float a = random.between(0.7f, 1.2f) * size, b = random.between(0.7f, 1.2f) * size;
    switch (random.below(5)) {
        case 0: return Sphere{a};
        case 1: return Box{{a, b, size}};
        case 2: return Capsule{0.6f * a, 0.6f * b};
        case 3: return Cylinder{a, b};
        default: break;
    }
    std::vector<Vec3> points;
    for (int i = 0; i < 12; ++i) points.push_back(a * rotate(random_rotation(random), Vec3{1, 0, 0}));
    if (const Result<ConvexHull> hull = build_convex_hull(points)) return *hull;
    return Box{{a, b, size}};
}

Shape random_mesh(Random& random, float size) {
    constexpr std::uint32_t cells = 4;
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;
    const auto at = [&](std::uint32_t i) { return (static_cast<float>(i) / cells - 0.5f) * size; };
    for (std::uint32_t i = 0; i <= cells; ++i)
        for (std::uint32_t k = 0; k <= cells; ++k)
            positions.push_back({at(i), random.between(-0.1f, 0.1f) * size, at(k)});
    for (std::uint32_t i = 0; i < cells; ++i)
        for (std::uint32_t k = 0; k < cells; ++k) {
            const std::uint32_t a = i * (cells + 1) + k, b = a + 1, c = a + cells + 1;
            indices.insert(indices.end(), {a, b, c, c, b, c + 1});
        }
    const auto mesh = CollisionMesh::build(positions, indices, {.two_sided = random.below(2) == 0});
    return mesh ? Shape(Mesh{*mesh}) : Shape(Box{{size, 0.1f * size, size}});
}

}  // namespace fase::checks
