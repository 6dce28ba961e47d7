/// Computes normals with creases.
#include "fase/record/export/creased_mesh.hpp"

#include <cmath>
#include <utility>

namespace fase::record {

RecordedMesh with_normals(std::span<const Vec3> vertices, std::span<const Triangle> triangles, float crease) {
    const float min_cosine = std::cos(crease);
    std::vector<Vec3> area_normals(triangles.size());  // normal × twice the area
    std::vector<std::vector<std::uint32_t>> around(vertices.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const Triangle& corners = triangles[t];
        const Vec3 a = vertices[corners[0]];
        area_normals[t] = cross(vertices[corners[1]] - a, vertices[corners[2]] - a);
        if (!(length(area_normals[t]) > 0)) continue;
        for (const std::uint32_t corner : corners) around[corner].push_back(static_cast<std::uint32_t>(t));
    }
    RecordedMesh mesh;
    std::vector<std::vector<std::uint32_t>> copies(vertices.size());  // indices in the result, by input vertex
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const Vec3 face_normal = normalized(area_normals[t]);
        if (!(length(face_normal) > 0)) continue;
        Triangle corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = triangles[t][k];
            Vec3 sum;
            for (const std::uint32_t other : around[vertex]) {
                if (dot(normalized(area_normals[other]), face_normal) >= min_cosine) sum += area_normals[other];
            }
            const Vec3 normal = normalized(sum);
            bool found = false;
            for (const std::uint32_t candidate : copies[vertex]) {
                if (!(dot(mesh.normals[candidate], normal) > 0.9999f)) continue;
                corners[k] = candidate;
                found = true;
                break;
            }
            if (found) continue;
            corners[k] = static_cast<std::uint32_t>(mesh.vertices.size());
            copies[vertex].push_back(corners[k]);
            mesh.vertices.push_back(vertices[vertex]);
            mesh.normals.push_back(normal);
        }
        mesh.triangles.push_back(corners);
    }
    return mesh;
}

}  // namespace fase::record
