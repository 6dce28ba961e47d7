/// How a mesh is laid out for rays.
#include "fase/query/ray_mesh.hpp"

#include <fmt/format.h>

#include <cmath>

#include "fase/query/detail/ray_mesh_kernels.hpp"

namespace fase::query {
namespace {

constexpr float largest = broad::largest_built;

Error refused(std::string found, const char* needed) {
    return {Status::BadArgument, "ray mesh", fmt::format("found {}, need {}", found, needed), {}};
}

}  // namespace

Aabb roomy_box(const TriangleBlock& block, std::uint32_t lane, float room) {
    Aabb box;
    for (const auto& corner : block.corner) {
        const Vec3 at{corner[0][lane], corner[1][lane], corner[2][lane]};
        box = merge(box, {at, at});
    }
    return grown(box, room);
}

Result<RayMesh> RayMesh::of(std::span<const Vec3> positions, std::span<const std::uint32_t> indices) {
    if (indices.size() % 3 != 0) return refused(fmt::format("{} indices", indices.size()), "three a triangle");
    if (indices.size() / 3 >= broad::wide::leaf_bit - 1)
        return refused(fmt::format("{} triangles", indices.size() / 3), "less than 2147483647");
    for (std::size_t i = 0; i < indices.size(); ++i) {
        if (indices[i] >= positions.size())
            return refused(fmt::format("index {} at {}", indices[i], i), "an index of a position");
    }
    float size = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            const float x = std::abs(positions[i][axis]);
            if (!(x <= largest / 2)) return refused(fmt::format("position {} out of reach", i), "finite numbers");
            size = x > size ? x : size;
        }
    }
    RayMesh mesh;
    mesh.room_ = size * 0x1p-20f;
    std::vector<broad::Move> boxes(indices.size() / 3);
    for (std::size_t t = 0; t < boxes.size(); ++t) {
        boxes[t].proxy = static_cast<Proxy>(t);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 corner = positions[indices[3 * t + k]];
            boxes[t].box = merge(boxes[t].box, {corner, corner});
        }
    }
    broad::WideBvh triangles;  // its leaves are groups of up to eight
    triangles.build(boxes);
    mesh.places_.resize(boxes.size());
    std::vector<broad::Move> blocks;
    triangles.for_each_leaf([&](const broad::Leaf& leaf) {
        const auto number = static_cast<std::uint32_t>(mesh.triangles_.size());
        TriangleBlock& block = mesh.triangles_.emplace_back();
        block = {};
        for (std::uint32_t& triangle : block.triangle) triangle = nothing;
        Aabb bounds;
        for (std::uint32_t lane = 0; lane < leaf.proxies.size(); ++lane) {
            const Proxy t = leaf.proxies[lane];
            block.triangle[lane] = t;
            mesh.places_[t] = 8 * number + lane;
            for (std::size_t k = 0; k < 3; ++k)
                for (int axis = 0; axis < 3; ++axis) block.corner[k][axis][lane] = positions[indices[3 * t + k]][axis];
            bounds = merge(bounds, roomy_box(block, lane, mesh.room_));
        }
        blocks.push_back({number, bounds});
    });
    mesh.blocks_.build(blocks);
    return mesh;
}

std::optional<Hit> RayMesh::nearest_hit(const Ray& ray) const {
    const Hit hit = cast_at_blocks({blocks_, triangles_.data(), room_}, ray, false);
    return hit.met() ? std::optional(hit) : std::nullopt;
}

bool RayMesh::any_hit(const Ray& ray) const {
    return cast_at_blocks({blocks_, triangles_.data(), room_}, ray, true).met();
}

Vec3 RayMesh::normal(std::uint32_t triangle) const {
    const TriangleBlock& block = triangles_[places_[triangle] / 8];
    const std::uint32_t lane = places_[triangle] % 8;
    const auto corner = [&](int k) {
        return Vec3d{double(block.corner[k][0][lane]), double(block.corner[k][1][lane]),
                     double(block.corner[k][2][lane])};
    };
    const Vec3d n = cross(corner(1) - corner(0), corner(2) - corner(0));
    const double size = length(n);
    return size > 0 ? to_float(n * (1 / size)) : Vec3{};
}

}  // namespace fase::query
