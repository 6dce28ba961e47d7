/// Shapes under linear maps.
#include "fase/geometry/scaled.hpp"

#include <fmt/format.h>

#include "fase/geometry/hull_builder.hpp"
#include "fase/geometry/mass.hpp"
#include "fase/geometry/mesh.hpp"

namespace fase {
namespace {

constexpr double alike = 1e-4;
constexpr int detail_of_hulls = 20;

bool equal(double a, double b) {
    const double largest = a > b ? a : b;
    return a - b <= alike * largest && b - a <= alike * largest;
}

/// A map taken apart into what it does to the axes of the shape.
struct Parts {
    Vec3d scale;               ///< lengths of the mapped axes
    Mat3d turn;                ///< their directions, right-handed; a mirrored map has one turned about
    bool right_angles = true;  ///< whether they still are at right angles
};

Parts take_apart(const Mat3d& map) {
    Parts parts;
    parts.scale = {length(map.x), length(map.y), length(map.z)};
    const Vec3d x = map.x * (1 / parts.scale.x), y = map.y * (1 / parts.scale.y), z = map.z * (1 / parts.scale.z);
    for (const double cosine : {dot(x, y), dot(y, z), dot(z, x)}) {
        if (!(cosine <= alike && cosine >= -alike)) parts.right_angles = false;
    }
    // Every shape that uses the turn is its own mirror image in each of its planes, so the sign of a column is free.
    // The last column is made from the others; what is left askew (1e-4 at most) is shared by to_quat().
    const Vec3d across = normalized(y - x * dot(x, y));
    parts.turn = {x, across, cross(x, across)};
    return parts;
}

/// The hull of the mapped points of the surface.
Result<TurnedShape> hull_of(const Shape& shape, const Mat3d& map, int max_vertices) {
    std::vector<Vec3> points = sample_points(shape, detail_of_hulls);
    for (Vec3& p : points) p = to_float(map * to_double(p));
    Result<ConvexHull> hull = build_convex_hull(points, {max_vertices});
    if (!hull) return hull.error();
    return TurnedShape{std::move(*hull), {}};
}

struct Mapper {
    const Shape& whole;
    const Mat3d& map;
    Parts parts = take_apart(map);

    [[nodiscard]] bool uniform() const {
        return parts.right_angles && equal(parts.scale.x, parts.scale.y) && equal(parts.scale.y, parts.scale.z) &&
               equal(parts.scale.z, parts.scale.x);
    }
    [[nodiscard]] float mean_scale() const { return float((parts.scale.x + parts.scale.y + parts.scale.z) / 3); }
    [[nodiscard]] Quat rotation() const { return to_float(to_quat(parts.turn)); }

    Result<TurnedShape> operator()(const Sphere& s) const {
        if (!uniform()) return hull_of(whole, map, 255);
        return TurnedShape{Sphere{s.radius * mean_scale()}, rotation()};
    }
    Result<TurnedShape> operator()(const Box& box) const {
        if (!parts.right_angles) return hull_of(whole, map, 8);
        return TurnedShape{Box{multiply(box.half, to_float(parts.scale))}, rotation()};
    }
    Result<TurnedShape> operator()(const Capsule& c) const {
        if (!uniform()) return hull_of(whole, map, 255);
        return TurnedShape{Capsule{c.radius * mean_scale(), c.half_length * mean_scale()}, rotation()};
    }
    Result<TurnedShape> operator()(const Cylinder& c) const {
        if (!parts.right_angles || !equal(parts.scale.x, parts.scale.z)) return hull_of(whole, map, 255);
        const float across = float((parts.scale.x + parts.scale.z) / 2);
        return TurnedShape{Cylinder{c.radius * across, c.half_height * float(parts.scale.y)}, rotation()};
    }
    Result<TurnedShape> operator()(const ConvexHull& hull) const {
        return hull_of(whole, map, static_cast<int>(hull.vertices.size()));
    }
    /// The image of the plane's normal is a column of the matrix of cofactors.
    Result<TurnedShape> operator()(const HalfSpace&) const {
        const Vec3d up = normalized(cross(map.z, map.x) * (determinant(map) < 0 ? -1.0 : 1.0));
        const Vec3d side = parts.turn.x;  // in the plane, so at right angles to up
        return TurnedShape{HalfSpace{}, to_float(to_quat(Mat3d{side, up, cross(side, up)}))};
    }
};

Error bad(std::string problem) { return {Status::BadArgument, "scale", std::move(problem), ""}; }

}  // namespace

Result<TurnedShape> transformed(const Shape& shape, const Mat3& map) {
    if (!is_finite(map.x) || !is_finite(map.y) || !is_finite(map.z)) return bad("found a number that is not finite");
    const Mat3d wide = to_double(map);
    const double size = length(wide.x) * length(wide.y) * length(wide.z);
    const double volume = determinant(wide);
    if (!(volume > 1e-12 * size || volume < -1e-12 * size)) {
        return bad(fmt::format("found a determinant of {}, need a map that leaves a solid", volume));
    }
    Result<TurnedShape> result = std::visit(Mapper{shape, wide}, shape);
    if (!result) return result;
    if (Result<void> fit = check(result->shape); !fit) return fit.error();
    return result;
}

Result<Shape> scaled(const Shape& shape, Vec3 scale) {
    Result<TurnedShape> image = transformed(shape, Mat3::diagonal(scale));
    if (!image) return image.error();
    if (std::holds_alternative<HalfSpace>(shape) && scale.y < 0) {
        return Error{Status::Unsupported, "scale", fmt::format("a half-space with a scale of y of {}", scale.y),
                     "turn its node instead"};
    }
    // Along the axes of its own frame a mirrored round shape or box looks as before.
    return std::move(image->shape);
}

}  // namespace fase
