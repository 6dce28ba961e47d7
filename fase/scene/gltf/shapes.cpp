/// Converts JSON to Fase's shapes.
#include "fase/scene/gltf/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "fase/geometry/hull_builder.hpp"
#include "fase/geometry/mass.hpp"
#include "fase/geometry/mesh.hpp"
#include "fase/scene/generate/angles.hpp"

namespace fase::scene::gltf {
namespace {

constexpr float plane_thickness = 0.1f;      ///< of the box that replaces a plane of finite size
constexpr float unlimited_half_size = 1000;  ///< of such a plane along an axis without a limit

/// Sizes of shapes whose parameters are omitted.
struct Defaults {
    double capsule_radius, capsule_height, cylinder_radius, cylinder_height;
};
constexpr Defaults khr_defaults{0.25, 0.5, 0.25, 0.5}, omi_defaults{0.5, 1, 0.5, 2},
    omi_collider_defaults{0.5, 2, 0.5, 2};

Defaults defaults_of(ShapeDialect dialect) {
    if (dialect == ShapeDialect::Omi) return omi_defaults;
    return dialect == ShapeDialect::OmiCollider ? omi_collider_defaults : khr_defaults;
}

double size_in(JsonValue json, std::string_view key, double fallback, bool may_be_zero) {
    const double size = number_in(json, key, fallback);
    if (size < 0 || (size == 0 && !may_be_zero)) {
        refuse(*json.find(key),
               fmt::format("found {}; expected a number {}", size, may_be_zero ? "of 0 or more" : "above 0"));
    }
    return size;
}

/// The two radii of a capsule or cylinder; "radius" sets both in older files.
struct Radii {
    double top, bottom;
    [[nodiscard]] bool equal() const { return top == bottom; }
};
Radii radii_in(JsonValue json, double fallback) {
    const double both = size_in(json, "radius", fallback, false);
    const Radii radii{size_in(json, "radiusTop", both, true), size_in(json, "radiusBottom", both, true)};
    if (radii.top == 0 && radii.bottom == 0) refuse(json, "found two radii of 0; expected at least one above 0");
    return radii;
}

Shape checked_hull(JsonValue json, const std::vector<Vec3>& points) {
    Result<ConvexHull> hull = build_convex_hull(points);
    if (!hull) refuse(json, hull.error().problem);
    return *std::move(hull);
}

Shape tapered_cylinder(JsonValue json, Radii radii, double height) {
    constexpr int sides = 32;
    std::vector<Vec3> points;
    for (const bool top : {false, true}) {
        const double radius = top ? radii.top : radii.bottom;
        const auto y = static_cast<float>(top ? height / 2 : -height / 2);
        for (int i = 0; i < (radius > 0 ? sides : 1); ++i) {
            const SinCos direction = sin_cos(2 * pi * i / sides);
            points.push_back(
                {static_cast<float>(radius * direction.cos), y, static_cast<float>(radius * direction.sin)});
        }
    }
    return checked_hull(json, points);
}

Shape tapered_capsule(JsonValue json, Radii radii, double height) {
    std::vector<Vec3> points;
    for (const bool top : {false, true}) {
        const double radius = top ? radii.top : radii.bottom;
        const Vec3 centre{0, static_cast<float>(top ? height / 2 : -height / 2), 0};
        if (radius == 0) {
            points.push_back(centre);
            continue;
        }
        for (const Vec3 p : sample_points(Sphere{static_cast<float>(radius)}, 14)) points.push_back(centre + p);
    }
    return checked_hull(json, points);
}

}  // namespace

ShapeSource read_shape(JsonValue json, ShapeDialect dialect, const Document& document, Warnings& warnings) {
    ShapeSource source;
    source.json = json;
    const std::string_view type = required_member(json, "type", JsonKind::String).string();
    const bool flat = dialect == ShapeDialect::OmiCollider;
    // Without its parameter object, an element has the defaults: its own members contain no sizes.
    const std::optional<JsonValue> parameters = member(json, type == "hull" ? "convex" : type, JsonKind::Object);
    const JsonValue p = flat || !parameters ? json : *parameters;
    const Defaults defaults = defaults_of(dialect);
    const auto known = [&](std::initializer_list<std::string_view> keys) {
        if (parameters) warnings.unknown_members(*parameters, fmt::format("{} shape's", type), keys);
    };
    if (type == "sphere") {
        known({"radius"});
        source.shape = Sphere{static_cast<float>(size_in(p, "radius", 0.5, false))};
    } else if (type == "box") {
        known({"size"});
        const Vec3d size = vec3_in(p, "size").value_or(Vec3d{1, 1, 1});
        if (!(size.x > 0 && size.y > 0 && size.z > 0))
            refuse(p, fmt::format("found a box of {} x {} x {}; expected sizes above 0", size.x, size.y, size.z));
        source.shape = Box{to_float(size * 0.5)};
    } else if (type == "capsule") {
        known({"radius", "radiusTop", "radiusBottom", "height"});
        const Radii radii = radii_in(p, defaults.capsule_radius);
        double height = size_in(p, "height", defaults.capsule_height, true);
        if (flat) {
            height -= radii.top + radii.bottom;
            if (height < 0) refuse(p, "found a capsule lower than twice its radius; expected at least that height");
        }
        if (radii.equal())
            source.shape = Capsule{static_cast<float>(radii.top), static_cast<float>(height / 2)};
        else
            source.shape = tapered_capsule(p, radii, height);
    } else if (type == "cylinder") {
        known({"radius", "radiusTop", "radiusBottom", "height"});
        const Radii radii = radii_in(p, defaults.cylinder_radius);
        const double height = size_in(p, "height", defaults.cylinder_height, false);
        if (radii.equal())
            source.shape = Cylinder{static_cast<float>(radii.top), static_cast<float>(height / 2)};
        else
            source.shape = tapered_cylinder(p, radii, height);
    } else if (type == "plane") {
        known({"sizeX", "sizeZ", "doubleSided"});
        const bool limited = p.find("sizeX") || p.find("sizeZ");
        const bool double_sided = flag_in(p, "doubleSided", false);
        if (limited) {
            const Vec3 half{static_cast<float>(size_in(p, "sizeX", 2 * double(unlimited_half_size), false) / 2),
                            plane_thickness / 2,
                            static_cast<float>(size_in(p, "sizeZ", 2 * double(unlimited_half_size), false) / 2)};
            source.shape = Box{half};
            if (!double_sided) source.offset = {0, -plane_thickness / 2, 0};
            warnings.add("planes of finite size are replaced by boxes 0.1 m thick");
        } else {
            source.shape = HalfSpace{};
            if (double_sided) warnings.add("infinite planes are solid below, also double-sided ones");
        }
    } else if (type == "convex" || type == "trimesh" || type == "mesh" || type == "hull") {
        source.mesh = index_in(p, "mesh", document.meshes().size(), "meshes");
        source.convex = type == "convex" || type == "hull" || flag_in(p, "convexHull", false);
        if (!source.mesh) warnings.add(fmt::format("{} shapes without a mesh are skipped", type), Harm::Missing);
    } else {
        warnings.add_named("shape type {} is not supported", quoted_short(type), Harm::Missing);
    }
    if (source.shape) {
        if (const Result<void> checked = check(*source.shape); !checked)
            refuse(json, checked.error().problem, checked.error().remedy);
    }
    return source;
}

ShapeList::ShapeList(Document& document, Warnings& warnings, std::string_view extension_name, std::string_view list,
                     ShapeDialect dialect)
    : dialect_(dialect) {
    const std::optional<JsonValue> body = extension(document.root(), extension_name);
    if (!body) return;
    warnings.unknown_members(*body, extension_name, {list});
    table_ = Table(document.json(), *body, list);
    for (std::size_t i = 0; i < table_.size(); ++i)
        static_cast<void>(read_shape(table_[i], dialect, document, warnings));
}

const ShapeSource& ShapeList::at(Document& document, std::uint32_t index) {
    const auto [entry, inserted] = shapes_.try_emplace(index);
    if (inserted) {
        Warnings duplicates;  // the constructor added these warnings
        entry->second = read_shape(table_[index], dialect_, document, duplicates);
        if (entry->second.shape) document.spend(entry->second.json, *entry->second.shape);
    }
    return entry->second;
}

}  // namespace fase::scene::gltf
