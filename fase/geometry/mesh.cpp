/// Triangle meshes and surface points of shapes.
#include "fase/geometry/mesh.hpp"

namespace fase {

TriangleMesh triangles(const Shape& shape, int detail) {
    const int segments = detail < 4 ? 4 : (detail + 3) / 4 * 4;
    return std::visit([segments](const auto& s) { return detail::mesh_of(s, segments); }, shape);
}

std::vector<Vec3> sample_points(const Shape& shape, int detail) { return triangles(shape, detail).positions; }

}  // namespace fase
