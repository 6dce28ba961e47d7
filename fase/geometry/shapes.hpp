#pragma once
/// THE list of shapes. Tables, tests, files and docs loop over it.
#include <concepts>
#include <cstddef>
#include <string_view>
#include <variant>

#include "fase/geometry/shapes/box.hpp"
#include "fase/geometry/shapes/capsule.hpp"
#include "fase/geometry/shapes/convex_hull.hpp"
#include "fase/geometry/shapes/cylinder.hpp"
#include "fase/geometry/shapes/half_space.hpp"
#include "fase/geometry/shapes/mesh.hpp"
#include "fase/geometry/shapes/sphere.hpp"

namespace fase {

/// A type with a name.
template <class S>
concept NamedShape = requires {
    { S::name } -> std::convertible_to<std::string_view>;
};

/// A bounded convex shape: the Minkowski sum of a core with a support function and a sphere of radius core_radius(). A
/// sphere has a point as its core.
template <class S>
concept ConvexShape = NamedShape<S> && requires(const S& shape, Vec3 f, Vec3d d) {
    { shape.core_support(f) } -> std::same_as<Vec3>;
    { shape.core_support(d) } -> std::same_as<Vec3d>;
    { shape.core_radius() } -> std::convertible_to<float>;
};

/// A list of shapes; its order defines the kind indices in tables and files.
template <NamedShape... S> struct ShapeList {
    using Variant = std::variant<S...>;
    static constexpr std::size_t count = sizeof...(S);
};
using AllShapes = ShapeList<Sphere, Box, Capsule, Cylinder, ConvexHull, HalfSpace, Mesh>;

/// Any one shape.
using Shape = AllShapes::Variant;

/// Calls f.operator()<S>() for every shape of the list, in list order.
template <class F, class... S> void for_each_shape(F&& f, ShapeList<S...>) { (f.template operator()<S>(), ...); }
template <class F> void for_each_shape(F&& f) { for_each_shape(f, AllShapes{}); }

/// Returns the name of the shape's kind: "sphere", "box" …
[[nodiscard]] inline std::string_view name_of(const Shape& shape) {
    return std::visit([]<class S>(const S&) { return S::name; }, shape);
}

[[nodiscard]] inline bool is_mesh(const Shape& shape) { return std::holds_alternative<Mesh>(shape); }

/// Whether the shape has a mass and an inside: half-spaces and meshes have none. They move dynamic bodies, but only
/// static and kinematic ones may have them, save as sensors.
[[nodiscard]] inline bool is_solid(const Shape& shape) {
    return !std::holds_alternative<HalfSpace>(shape) && !is_mesh(shape);
}

/// Whether the surface is curved. Contact points keep their place below a curved body when it rolls; those of a
/// polyhedron turn with it.
[[nodiscard]] inline bool is_curved(const Shape& shape) {
    return std::visit([]<class S>(const S&) { return S::is_curved; }, shape);
}

}  // namespace fase
