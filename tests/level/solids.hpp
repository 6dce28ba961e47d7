#pragma once
/// Closed meshes of known shape for tests.
#include <cmath>
#include <utility>
#include <vector>

#include "fase/geometry/mesh.hpp"

namespace fase::level {

/// Appends another mesh, translated.
inline void append(TriangleMesh& mesh, const TriangleMesh& other, Vec3 translation = {}) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& p : other.positions) mesh.positions.push_back(p + translation);
    for (const std::uint32_t i : other.indices) mesh.indices.push_back(base + i);
}

/// Returns the mesh with flipped triangles: inside out.
inline TriangleMesh flipped(TriangleMesh mesh) {
    for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) std::swap(mesh.indices[t], mesh.indices[t + 1]);
    return mesh;
}

/// Returns a torus around the z axis.
inline TriangleMesh torus(float radius, float tube, std::uint32_t around, std::uint32_t across) {
    TriangleMesh mesh;
    const auto angle = [](std::uint32_t i, std::uint32_t n) { return 6.28318530718 * i / n; };
    for (std::uint32_t i = 0; i < around; ++i) {
        for (std::uint32_t k = 0; k < across; ++k) {
            const double out = radius + tube * std::cos(angle(k, across));
            mesh.positions.push_back({static_cast<float>(out * std::cos(angle(i, around))),
                                      static_cast<float>(out * std::sin(angle(i, around))),
                                      static_cast<float>(tube * std::sin(angle(k, across)))});
            const std::uint32_t a = i * across + k, b = (i + 1) % around * across + k;
            const std::uint32_t c = (i + 1) % around * across + (k + 1) % across, d = i * across + (k + 1) % across;
            mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
        }
    }
    return mesh;
}

/// Returns an L of height 1: the square of side 2 without the quarter beyond (1, 1).
inline TriangleMesh concave_l() {
    TriangleMesh mesh;
    constexpr float plan[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    for (const float z : {0.0f, 1.0f})
        for (const auto& p : plan) mesh.positions.push_back({p[0], p[1], z});
    for (std::uint32_t i = 0; i < 6; ++i) {
        const std::uint32_t j = (i + 1) % 6;
        mesh.indices.insert(mesh.indices.end(), {i, j, j + 6, i, j + 6, i + 6});
    }
    for (const auto& [a, b, c] : {std::array<std::uint32_t, 3>{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}) {
        mesh.indices.insert(mesh.indices.end(), {a + 6, b + 6, c + 6});
        mesh.indices.insert(mesh.indices.end(), {a, c, b});
    }
    return mesh;
}

}  // namespace fase::level
