/// Collision meshes: what is left out, the tree, sizes, hostile input.
#include "fase/geometry/collision_mesh.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <set>

#include "fase/geometry/bounds.hpp"
#include "fase/geometry/mass.hpp"
#include "fase/geometry/scaled.hpp"
#include "tests/geometry/random_shapes.hpp"

namespace fase {
namespace {

using MeshPointer = std::shared_ptr<const CollisionMesh>;

/// Triangles of random places and sizes.
MeshPointer random_mesh(Random& random, std::size_t count, float size = 1) {
    std::vector<Vec3> positions;
    for (std::size_t t = 0; t < count; ++t) {
        const Vec3 at = test::random_vector(random, 10);
        const float reach = random.below(20) == 0 ? 10 * size : size;
        for (int k = 0; k < 3; ++k) positions.push_back(at + test::random_vector(random, reach));
    }
    std::vector<std::uint32_t> indices(positions.size());
    std::iota(indices.begin(), indices.end(), 0u);
    return *CollisionMesh::build(positions, indices);
}

Aabb box_of(const CollisionMesh& mesh, std::size_t place) {
    Aabb box;
    for (const Vec3 corner : mesh.triangle(place)) box = merge(box, {corner, corner});
    return box;
}

TEST(CollisionMesh, the_tree_finds_every_triangle_that_touches_a_box) {
    Random random(1);
    for (const std::size_t count : {1, 2, 3, 4, 5, 8, 9, 33, 300, 5000}) {
        const MeshPointer mesh = random_mesh(random, count, count % 2 == 0 ? 1 : 0.01f);
        for (int round = 0; round < 200; ++round) {
            const Vec3 at = test::random_vector(random, 12), half = abs(test::random_vector(random, 3));
            const Aabb box = round % 10 == 0 ? Aabb{at, at} : Aabb{at - half, at + half};
            std::set<std::uint32_t> found;
            mesh->tree().visit(box, [&](std::uint32_t place) { ASSERT_TRUE(found.insert(place).second) << "twice"; });
            for (std::size_t place = 0; place < mesh->size(); ++place)
                if (overlaps(box, box_of(*mesh, place))) ASSERT_TRUE(found.contains(static_cast<std::uint32_t>(place)));
        }
    }
}

TEST(CollisionMesh, coincident_triangles_do_not_make_the_tree_deep) {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        const float height = static_cast<float>(i) * 1e-7f;  // centres that no plane of bins separates
        positions.insert(positions.end(), {Vec3{0, height, 0}, {0, height, 1}, {1, height, 0}});
        indices.insert(indices.end(), {3 * i, 3 * i + 1, 3 * i + 2});
    }
    const MeshPointer mesh = *CollisionMesh::build(positions, indices);
    std::size_t found = 0;
    mesh->tree().visit(Aabb::everything(), [&](std::uint32_t) { ++found; });
    EXPECT_EQ(found, mesh->size());
}

TEST(CollisionMesh, keeps_numbers_and_materials_of_its_triangles) {
    const std::vector<Vec3> square{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 0, 1}};
    const std::vector<std::uint32_t> indices{0, 0, 1, 0, 1, 2, 1, 2, 0, 2, 1, 3, 0, 1, 3};
    const std::vector<std::uint8_t> materials{9, 4, 8, 5, 6};
    const MeshPointer mesh = *CollisionMesh::build(square, indices, {.materials = materials});
    ASSERT_EQ(mesh->size(), 3u);
    EXPECT_EQ(mesh->report().degenerate, 1u);
    EXPECT_EQ(mesh->report().duplicate, 1u);
    for (std::size_t place = 0; place < mesh->size(); ++place)
        EXPECT_EQ(mesh->material(place), materials[mesh->number(place)]);
}

TEST(CollisionMesh, equal_positions_are_one_vertex_and_edges_are_counted) {
    const TriangleMesh cube = triangles(Box{{1, 1, 1}});
    std::vector<Vec3> soup;
    for (const std::uint32_t i : cube.indices) soup.push_back(cube.positions[i]);
    std::vector<std::uint32_t> indices(soup.size());
    std::iota(indices.begin(), indices.end(), 0u);
    const MeshPointer mesh = *CollisionMesh::build(soup, indices);
    EXPECT_EQ(mesh->vertices().size(), 8u);
    EXPECT_EQ(mesh->report().open_edges, 0u);
    EXPECT_EQ(mesh->report().non_manifold_edges, 0u);
    indices.resize(indices.size() - 3);
    EXPECT_EQ((*CollisionMesh::build(soup, indices))->report().open_edges, 3u);
}

TEST(CollisionMesh, takes_at_most_40_bytes_per_triangle) {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;
    constexpr std::uint32_t n = 200;
    for (std::uint32_t i = 0; i <= n; ++i)
        for (std::uint32_t k = 0; k <= n; ++k) positions.push_back({float(i), float((i * 7 + k * 3) % 5), float(k)});
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t k = 0; k < n; ++k) {
            const std::uint32_t a = i * (n + 1) + k, b = a + 1, c = a + n + 1;
            indices.insert(indices.end(), {a, b, c, c, b, c + 1});
        }
    const MeshPointer mesh = *CollisionMesh::build(positions, indices);
    EXPECT_LE(mesh->bytes(), 40 * mesh->size());
}

TEST(CollisionMesh, invalid_input_is_refused_with_its_place) {
    constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<Vec3> good{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
    const std::vector<std::uint32_t> one{0, 1, 2};
    const auto problem = [](const std::vector<Vec3>& positions, const std::vector<std::uint32_t>& indices,
                            const MeshOptions& options = {}) {
        const auto mesh = CollisionMesh::build(positions, indices, options);
        return mesh ? std::string() : mesh.error().problem;
    };
    EXPECT_EQ(problem(good, one), "");
    EXPECT_EQ(problem(good, {0, 1}), "found 2 indices; expected three for each triangle");
    EXPECT_EQ(problem(good, {0, 1, 3}), "found index 3 in triangle 0; expected an index below 3");
    EXPECT_EQ(problem(good, {}), "found no triangle with an area; expected one or more");
    EXPECT_EQ(problem(good, {0, 1, 1}), "found no triangle with an area; expected one or more");
    const std::vector<std::uint8_t> materials{1, 2};
    EXPECT_EQ(problem(good, one, {.materials = materials}),
              "found 2 materials; expected one for each of 1 triangles, or none");
    for (const float bad : {inf, -inf, nan, 1e6f})
        EXPECT_EQ(problem({{0, 0, 0}, {0, bad, 1}, {1, 0, 0}}, one),
                  "found position 1 out of range; expected finite coordinates within 1e5 m");
}

TEST(Mesh, is_scaled_and_mirrored_without_new_data) {
    Random random(4);
    const Mesh mesh = test::random_shape<Mesh>(random);
    for (const Vec3 scale : {Vec3{2, 2, 2}, Vec3{-1, 1, 1}, Vec3{0.5f, -3, 2}, Vec3{-1, -1, -1}}) {
        const Result<Shape> image = scaled(mesh, scale);
        ASSERT_TRUE(image) << image.error().text();
        const Mesh& found = std::get<Mesh>(*image);
        EXPECT_EQ(found.data, mesh.data);
        for (std::size_t place = 0; place < mesh.data->size(); ++place) {
            const auto before = mesh.triangle(place), after = found.triangle(place);
            EXPECT_LT(length(after[0] - multiply(before[0], scale)), 1e-6f * length(after[0]));
        }
    }
    EXPECT_EQ(scaled(mesh, {1e-9f, 1, 1}).status(), Status::BadArgument);
    EXPECT_EQ(check(Mesh{}).status(), Status::BadArgument);
}

TEST(Mesh, the_front_of_a_mirrored_mesh_stays_outside) {
    const TriangleMesh cube = triangles(Box{{1, 1, 1}});
    const MeshPointer data = *CollisionMesh::build(cube.positions, cube.indices);
    for (const Vec3 scale : {Vec3{1, 1, 1}, Vec3{-1, 1, 1}, Vec3{1, -2, -1}, Vec3{-1, -1, -1}}) {
        const Mesh mesh{data, scale};
        for (std::size_t place = 0; place < data->size(); ++place) {
            const auto [a, b, c] = mesh.triangle(place);
            EXPECT_GT(dot(cross(b - a, c - a), a + b + c), 0);
        }
    }
}

TEST(Mesh, the_image_under_any_map_has_the_mapped_triangles) {
    Random random(5);
    for (int round = 0; round < 50; ++round) {
        const Mesh mesh = test::random_shape<Mesh>(random);
        const Mat3 map = to_matrix(test::random_rotation(random)) * Mat3::diagonal({2, 0.5f, round % 2 ? -1.0f : 1.0f});
        const Result<RotatedShape> image = transformed(mesh, map);
        ASSERT_TRUE(image) << image.error().text();
        const Mesh& found = std::get<Mesh>(image->shape);
        ASSERT_EQ(found.data->size(), mesh.data->size());
        Vec3d sum, expected;
        for (std::size_t place = 0; place < found.data->size(); ++place) {
            for (const Vec3 corner : found.triangle(place)) sum += to_double(rotate(image->rotation, corner));
            for (const Vec3 corner : mesh.triangle(place)) expected += to_double(map * corner);
        }
        EXPECT_LT(length(sum - expected), 1e-5 * double(found.data->size()) * double(outer_radius(mesh)));
    }
}

}  // namespace
}  // namespace fase
