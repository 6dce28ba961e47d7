#pragma once
/// How each shape is stored in a recording.
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "fase/geometry/mesh.hpp"
#include "fase/geometry/shapes.hpp"
#include "fase/record/tables.hpp"

namespace fase::record {

/// The numbers of a stored shape; unused ones are 0.
using ShapeNumbers = std::array<float, 3>;

/// Stores any shape as the triangles of triangles().
template <class S> struct MeshShapeCode {
    static constexpr ShapeKind kind = ShapeKind::Triangles;
    static RecordedShape encode_mesh(const S& s) {
        const TriangleMesh mesh = triangles(Shape(s));
        RecordedShape shape{kind, {}, mesh.positions, {}};
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            shape.triangles.push_back({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
        }
        return shape;
    }
};

/// Stores the sizes of a shape as numbers, under a kind of its own.
template <SizedShape S, ShapeKind own_kind> struct SizesShapeCode {
    static_assert(S::sizes.size() <= ShapeNumbers{}.size(), "the format has room for three numbers");
    static constexpr ShapeKind kind = own_kind;
    static constexpr std::size_t number_count = S::sizes.size();
    static ShapeNumbers encode(const S& shape) {
        ShapeNumbers numbers{};
        for (std::size_t i = 0; i < number_count; ++i) numbers[i] = S::sizes[i].in(shape);
        return numbers;
    }
    static S decode(const ShapeNumbers& numbers) {
        S shape;
        for (std::size_t i = 0; i < number_count; ++i) S::sizes[i].in(shape) = numbers[i];
        return shape;
    }
};

/// Describes how a shape is stored. A shape without a specialization is stored as triangles. Each has `kind` and either
/// - number_count, encode() and decode(): the shape is stored as its numbers, or
/// - encode_mesh(): the shape is stored as vertices and triangles.
/// format.md specifies the kinds and the order of the numbers.
template <class S> struct ShapeCode : MeshShapeCode<S> {};

/// A shape that is stored as its numbers, not as vertices and triangles.
template <class S>
concept StoredAsNumbers = requires(const S& shape, const ShapeNumbers& numbers) {
    { ShapeCode<S>::encode(shape) } -> std::same_as<ShapeNumbers>;
    { ShapeCode<S>::decode(numbers) } -> std::same_as<S>;
};

template <> struct ShapeCode<Sphere> : SizesShapeCode<Sphere, ShapeKind::Sphere> {};
template <> struct ShapeCode<Box> : SizesShapeCode<Box, ShapeKind::Box> {};
template <> struct ShapeCode<Capsule> : SizesShapeCode<Capsule, ShapeKind::Capsule> {};
template <> struct ShapeCode<Cylinder> : SizesShapeCode<Cylinder, ShapeKind::Cylinder> {};
template <> struct ShapeCode<HalfSpace> : SizesShapeCode<HalfSpace, ShapeKind::HalfSpace> {};
template <> struct ShapeCode<ConvexHull> {
    static constexpr ShapeKind kind = ShapeKind::Hull;
    /// Splits each face into a fan of triangles.
    static RecordedShape encode_mesh(const ConvexHull& hull) {
        RecordedShape shape{kind, {}, hull.vertices, {}};
        for (const ConvexHull::Face& face : hull.faces) {
            const auto corner = [&](std::uint32_t k) { return hull.face_vertices[face.first + k]; };
            for (std::uint32_t k = 2; k < face.count; ++k) {
                shape.triangles.push_back({corner(0), corner(k - 1), corner(k)});
            }
        }
        return shape;
    }
};

}  // namespace fase::record
