/// Construction of ray meshes.
#include "fase/query/ray_mesh.hpp"

#include <cmath>

#include "fase/core/detail/text.hpp"
#include "fase/query/detail/ray_mesh_kernels.hpp"

namespace fase::query {
namespace {

Error refused(std::string found, const char* expected) {
    return {Status::BadArgument, "ray mesh", detail::format("found {}; expected {}", found, expected), {}};
}

}  // namespace

Aabb triangle_box(const TriangleBlock& block, std::uint32_t lane, float margin) {
    Aabb box;
    for (const auto& corner : block.corner) {
        const Vec3 at{corner[0][lane], corner[1][lane], corner[2][lane]};
        box = merge(box, {at, at});
    }
    return enlarged(box, margin);
}

Result<RayMesh> RayMesh::of(std::span<const Vec3> positions, std::span<const std::uint32_t> indices) {
    if (indices.size() % 3 != 0) return refused(detail::format("{} indices", indices.size()), "three per triangle");
    if (indices.size() / 3 >= broad::wide::leaf_bit - 1)
        return refused(detail::format("{} triangles", indices.size() / 3), "fewer than 2147483647");
    for (std::size_t i = 0; i < indices.size(); ++i) {
        if (indices[i] >= positions.size())
            return refused(detail::format("index {} at {}", indices[i], i), "an index of a position");
    }
    float size = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            const float x = std::abs(positions[i][axis]);
            if (!(x <= broad::largest_built / 2))
                return refused(detail::format("position {} out of range", i), "coordinates within 5e16 m");
            size = x > size ? x : size;
        }
    }
    RayMesh mesh;
    mesh.margin_ = size * 0x1p-20f;
    std::vector<broad::Move> boxes(indices.size() / 3);
    for (std::size_t t = 0; t < boxes.size(); ++t) {
        boxes[t].proxy = static_cast<Proxy>(t);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 corner = positions[indices[3 * t + k]];
            boxes[t].box = merge(boxes[t].box, {corner, corner});
        }
    }
    broad::WideBvh triangles;  // its leaves have up to eight triangles each
    triangles.build(boxes);
    mesh.lane_of_.resize(boxes.size());
    std::vector<broad::Move> blocks;
    triangles.for_each_leaf([&](const broad::Leaf& leaf) {
        const auto number = static_cast<std::uint32_t>(mesh.triangles_.size());
        TriangleBlock& block = mesh.triangles_.emplace_back();
        block = {};
        for (std::uint32_t& triangle : block.triangle) triangle = no_index;
        Aabb bounds;
        for (std::uint32_t lane = 0; lane < leaf.proxies.size(); ++lane) {
            const Proxy t = leaf.proxies[lane];
            block.triangle[lane] = t;
            mesh.lane_of_[t] = 8 * number + lane;
            for (std::size_t k = 0; k < 3; ++k)
                for (int axis = 0; axis < 3; ++axis) block.corner[k][axis][lane] = positions[indices[3 * t + k]][axis];
            bounds = merge(bounds, triangle_box(block, lane, mesh.margin_));
        }
        blocks.push_back({number, bounds});
    });
    mesh.blocks_.build(blocks);
    return mesh;
}

std::optional<Hit> RayMesh::nearest_hit(const Ray& ray) const {
    const Hit hit = cast_at_blocks({blocks_, triangles_.data(), margin_}, ray, false);
    return hit.is_hit() ? std::optional(hit) : std::nullopt;
}

bool RayMesh::any_hit(const Ray& ray) const {
    return cast_at_blocks({blocks_, triangles_.data(), margin_}, ray, true).is_hit();
}

Vec3 RayMesh::normal(std::uint32_t triangle) const {
    const TriangleBlock& block = triangles_[lane_of_[triangle] / 8];
    const std::uint32_t lane = lane_of_[triangle] % 8;
    const auto corner = [&](int k) {
        return Vec3d{double(block.corner[k][0][lane]), double(block.corner[k][1][lane]),
                     double(block.corner[k][2][lane])};
    };
    const Vec3d n = cross(corner(1) - corner(0), corner(2) - corner(0));
    const double size = length(n);
    return size > 0 ? to_float(n * (1 / size)) : Vec3{};
}

}  // namespace fase::query
