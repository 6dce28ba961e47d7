/// Tests the stored form of every shape.
#include "fase/record/recording/shape_code.hpp"

#include <gtest/gtest.h>

#include <set>

#include "fase/geometry/hull_builder.hpp"

namespace fase::record {
namespace {

TEST(ShapeCode, DecodesEveryShapeThatIsStoredAsNumbers) {
    for_each_shape([]<class S>() {
        if constexpr (StoredAsNumbers<S>) {
            const RecordedShape stored = recorded(S{});
            EXPECT_EQ(stored.kind, ShapeCode<S>::kind);
            EXPECT_TRUE(stored.vertices.empty());
            const std::optional<Shape> shape = shape_of(stored);
            ASSERT_TRUE(shape) << S::name;
            EXPECT_EQ(*shape, Shape(S{})) << S::name;
        }
    });
}

TEST(ShapeCode, KindsOfShapesAreDistinct) {
    std::set<ShapeKind> kinds;
    for_each_shape([&]<class S>() {
        if constexpr (StoredAsNumbers<S>) {
            EXPECT_TRUE(kinds.insert(ShapeCode<S>::kind).second) << S::name;
        }
    });
    EXPECT_FALSE(kinds.contains(ShapeKind::Hull));
    EXPECT_FALSE(kinds.contains(ShapeKind::Triangles));
}

TEST(ShapeCode, EveryShapeReadsBackAsWritten) {
    const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    std::vector<RecordedShape> shapes{recorded(*build_convex_hull(corners))};
    for_each_shape([&]<class S>() {
        if constexpr (StoredAsNumbers<S>) shapes.push_back(recorded(S{}));
    });
    shapes.push_back(MeshShapeCode<Sphere>::encode_mesh({}));
    ByteWriter out;
    out.put(static_cast<std::uint32_t>(shapes.size()));
    for (const RecordedShape& shape : shapes) write(out, shape);
    Tables tables;
    const Result<void> read = read_rows(shapes_chunk, out.bytes(), tables);
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(tables.shapes, shapes);
    EXPECT_FALSE(shape_of(shapes.front())) << "a hull is stored as vertices and triangles";
}

TEST(ShapeCode, RejectsAnUnknownKind) {
    ByteWriter out;
    out.put(std::uint32_t{1});
    out.put(static_cast<std::uint8_t>(static_cast<int>(ShapeKind::Triangles) + 1));
    Tables tables;
    EXPECT_EQ(read_rows(shapes_chunk, out.bytes(), tables).status(), Status::Format);
}

}  // namespace
}  // namespace fase::record
