/// Mass, centre and inertia: of solids by formula, of hulls by tetrahedra, of several parts by Steiner's theorem.
#include "fase/geometry/mass.hpp"

namespace fase {
namespace {

constexpr double pi = 3.14159265358979323846;

/// The same in double, for sums.
struct Solid {
    double mass = 0;
    Vec3d centre;
    Mat3d inertia;  ///< about `centre`
};

MassProperties rounded(const Solid& s) { return {static_cast<float>(s.mass), to_float(s.centre), to_float(s.inertia)}; }

Mat3d outer_product(Vec3d a, Vec3d b) { return {a * b.x, a * b.y, a * b.z}; }

/// What a point mass at `at` adds to the inertia about the origin.
Mat3d point_inertia(double mass, Vec3d at) {
    const double square = length_squared(at);
    return (Mat3d::diagonal({square, square, square}) - outer_product(at, at)) * mass;
}

Solid solid_of(const Sphere& s, double density) {
    const double r = s.radius;
    const double mass = density * (4.0 / 3.0) * pi * r * r * r;
    const double i = 0.4 * mass * r * r;
    return {mass, {}, Mat3d::diagonal({i, i, i})};
}

Solid solid_of(const Box& box, double density) {
    const Vec3d h = to_double(box.half);
    const double mass = density * 8 * h.x * h.y * h.z;
    const Vec3d square = multiply(h, h) * (mass / 3);
    return {mass, {}, Mat3d::diagonal({square.y + square.z, square.z + square.x, square.x + square.y})};
}

Solid solid_of(const Cylinder& c, double density) {
    const double r2 = double(c.radius) * c.radius, h = c.half_height;
    const double mass = density * pi * r2 * 2 * h;
    const double across = mass * (r2 / 4 + h * h / 3);
    return {mass, {}, Mat3d::diagonal({across, mass * r2 / 2, across})};
}

/// A cylinder and two half balls, the centre of each 3/8 of the radius beyond its disc.
Solid solid_of(const Capsule& c, double density) {
    const double r = c.radius, h = c.half_length;
    const double barrel = density * pi * r * r * 2 * h;
    const double caps = density * (4.0 / 3.0) * pi * r * r * r;
    const double along = barrel * r * r / 2 + caps * 0.4 * r * r;
    const double across = barrel * (r * r / 4 + h * h / 3) + caps * (0.4 * r * r + h * h + 0.75 * h * r);
    return {barrel + caps, {}, Mat3d::diagonal({across, along, across})};
}

/// Sums the tetrahedra between the first vertex and the triangles of every face. For a tetrahedron with one corner at
/// the origin and the others at a, b, c the integral of p pᵀ is det(a, b, c) / 120 · (s sᵀ + a aᵀ + b bᵀ + c cᵀ) with
/// s = a + b + c.
Solid solid_of(const ConvexHull& hull, double density) {
    if (hull.vertices.empty()) return {};
    const Vec3d start = to_double(hull.vertices[0]);
    const auto corner = [&](std::uint32_t i) { return to_double(hull.vertices[hull.face_vertices[i]]) - start; };
    double six_volumes = 0;
    Vec3d moment;   // 24 times the integral of p
    Mat3d squares;  // 120 times the integral of p pᵀ
    for (const ConvexHull::Face& face : hull.faces) {
        const Vec3d a = corner(face.first);
        for (std::uint32_t i = 1; i + 1 < face.count; ++i) {
            const Vec3d b = corner(face.first + i), c = corner(face.first + i + 1);
            const double d = dot(a, cross(b, c));
            const Vec3d s = a + b + c;
            six_volumes += d;
            moment += s * d;
            squares =
                squares + (outer_product(s, s) + outer_product(a, a) + outer_product(b, b) + outer_product(c, c)) * d;
        }
    }
    if (!(six_volumes > 0)) return {};
    const double mass = density * six_volumes / 6;
    const Vec3d centre = moment * (1 / (4 * six_volumes));
    const Mat3d second = squares * (density / 120);
    const double trace = second.x.x + second.y.y + second.z.z;
    const Mat3d about_start = Mat3d::diagonal({trace, trace, trace}) - second;
    return {mass, start + centre, about_start - point_inertia(mass, centre)};
}

Solid solid_of(const HalfSpace&, double) { return {}; }

}  // namespace

MassProperties mass_properties(const Shape& shape, float density) {
    return rounded(std::visit([density](const auto& s) { return solid_of(s, density); }, shape));
}

MassProperties moved(const MassProperties& properties, const LocalPose& placed) {
    const Mat3d r = to_matrix(normalized(to_double(placed.rotation)));
    const Vec3d centre = to_double(placed.position) + r * to_double(properties.centre);
    return {properties.mass, to_float(centre), to_float(r * to_double(properties.inertia) * transpose(r))};
}

MassProperties combined(std::span<const MassProperties> parts) {
    Solid whole;
    for (const MassProperties& part : parts) {
        whole.mass += part.mass;
        whole.centre += to_double(part.centre) * double(part.mass);
    }
    if (!(whole.mass > 0)) return {};
    whole.centre *= 1 / whole.mass;
    for (const MassProperties& part : parts) {
        whole.inertia =
            whole.inertia + to_double(part.inertia) + point_inertia(part.mass, to_double(part.centre) - whole.centre);
    }
    return rounded(whole);
}

}  // namespace fase
