#pragma once
/// What each shape defines in shapes/NAME.cpp. Its header declares six functions in fase::detail, here for a shape S;
/// the functions of geometry for any Shape call them:
///
/// - Aabb bounds_of(const S&, const Pose&): see bounds().
/// - float outer_radius_of(const S&), float inner_radius_of(const S&): see outer_radius() and inner_radius().
/// - Solid solid_of(const S&, double density): see mass_properties().
/// - TriangleMesh mesh_of(const S&, int segments): see triangles(). `segments` is a multiple of 4, at least 4.
/// - Result<RotatedShape> image_of(const S&, const LinearMap&): see transformed(). The caller checks the sizes.
///
/// A shape without a list of sizes also declares Result<void> check_of(const S&): see check().
#include "fase/geometry/bounds.hpp"
#include "fase/geometry/detail/box_at.hpp"
#include "fase/geometry/detail/lathe.hpp"
#include "fase/geometry/detail/linear_map.hpp"
#include "fase/geometry/detail/solid.hpp"
