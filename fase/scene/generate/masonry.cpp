/// Places stones: each block rests on the course below, with a joint to its neighbours.
#include "fase/scene/generate/masonry.hpp"

#include <algorithm>
#include <cmath>

#include "fase/scene/generate/angles.hpp"

namespace fase::scene {
namespace {

constexpr Colour stone_tones[]{
    {0.58f, 0.54f, 0.46f}, {0.52f, 0.48f, 0.41f}, {0.63f, 0.58f, 0.49f}, {0.47f, 0.45f, 0.41f}, {0.60f, 0.52f, 0.42f}};

/// Left of a horizontal direction, seen from above.
Vec3 left_of(Vec3 along) { return {along.z, 0, -along.x}; }

/// The corners of one wedge of a ring around the y axis: `angle` wide, centred on x, half a joint narrower on each
/// side. `origin` receives the reference point that the corners are relative to.
std::vector<Vec3> wedge_points(float inner, float outer, double angle, float half_height, Vec3& origin) {
    const SinCos edge = sin_cos(angle / 2);
    const auto corner = [&](float radius, int side) {
        const double x = radius * edge.cos, z = side * (radius * edge.sin - Masonry::joint / 2);
        return Vec3{static_cast<float>(x), 0, static_cast<float>(z)};
    };
    origin = {0.5f * (inner + outer) * static_cast<float>(edge.cos), 0, 0};
    std::vector<Vec3> points;
    for (const float radius : {inner, outer}) {
        for (const int side : {-1, 1}) {
            for (const float y : {-half_height, half_height}) {
                points.push_back(corner(radius, side) - origin + Vec3{0, y, 0});
            }
        }
    }
    return points;
}

/// A point in the plane of the arch.
struct Vec2d {
    double x = 0, y = 0;
};

/// Clips a convex polygon to normal . p >= offset.
std::vector<Vec2d> clipped(const std::vector<Vec2d>& polygon, Vec2d normal, double offset) {
    std::vector<Vec2d> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec2d p = polygon[i], q = polygon[(i + 1) % polygon.size()];
        const double at_p = normal.x * p.x + normal.y * p.y - offset, at_q = normal.x * q.x + normal.y * q.y - offset;
        if (at_p >= 0) kept.push_back(p);
        if ((at_p < 0) != (at_q < 0)) {
            const double t = at_p / (at_p - at_q);
            kept.push_back({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)});
        }
    }
    return kept;
}

}  // namespace

BodyStyle stone_of(Masonry& masonry, std::string_view name) {
    return {name, stone_tones[masonry.random.below(std::size(stone_tones))], 2400, {.friction = 0.7f}};
}

Quat facing(Vec3 along) {
    // The direction halfway between x and `along` has half the angle.
    if (along.x <= -0.999f) return {0, 1, 0, 0};
    const Vec3 half = normalized(Vec3{1 + along.x, 0, along.z});
    return {0, -half.z, 0, half.x};
}

BlockKind make_blocks(Masonry& masonry, float depth) {
    const float joint = Masonry::joint, y = Masonry::course / 2;
    return {masonry.builder.shape(Box{{(Masonry::length - joint) / 2, y, (depth - joint) / 2}}),
            masonry.builder.shape(Box{{(Masonry::length / 2 - joint) / 2, y, (depth - joint) / 2}}), depth};
}

void add_wall_courses(Masonry& masonry, const BlockKind& kind, const WallLine& line, float offset, int blocks,
                      int first, int courses) {
    const Quat rotation = facing(line.along);
    const auto add_block = [&](std::uint32_t shape, double distance, int course) {
        const Vec3 sideways = left_of(line.along) * offset;
        Vec3d p = line.start + to_double(line.along) * distance + to_double(sideways);
        p.y = (course + 0.5) * Masonry::course;
        masonry.builder.add(shape, stone_of(masonry, "wall stone"), {.position = p, .rotation = rotation});
    };
    for (int course = first; course < first + courses; ++course) {
        if (course % 2 == 0) {
            for (int i = 0; i < blocks; ++i) add_block(kind.full, (i + 0.5) * Masonry::length, course);
            continue;
        }
        add_block(kind.half, 0.25 * Masonry::length, course);
        for (int i = 1; i < blocks; ++i) add_block(kind.full, i * Masonry::length, course);
        add_block(kind.half, (blocks - 0.25) * Masonry::length, course);
    }
}

void add_battlement(Masonry& masonry, std::uint32_t merlon, float half_height, const WallLine& line, float offset,
                    int blocks, double y) {
    for (int i = 0; i < blocks; i += 2) {
        Vec3d p = line.start + to_double(line.along) * ((i + 0.5) * Masonry::length) +
                  to_double(left_of(line.along) * offset);
        p.y = y + half_height;
        masonry.builder.add(merlon, stone_of(masonry, "merlon"), {.position = p, .rotation = facing(line.along)});
    }
}

void build_tower(Masonry& masonry, Vec3d foot, float outer, int courses, bool roofed) {
    constexpr int wedges = 12;
    constexpr double angle = 2 * pi / wedges;
    const float inner = outer - 0.8f, half = Masonry::course / 2, deck_half = 0.15f, merlon_half = 0.45f;
    Builder& builder = masonry.builder;
    Vec3 origin, merlon_origin;
    const std::uint32_t wedge = builder.hull(wedge_points(inner, outer, angle, half, origin));
    const std::uint32_t merlon = builder.hull(wedge_points(outer - 0.45f, outer, angle, merlon_half, merlon_origin));
    const std::uint32_t deck = builder.shape(Cylinder{outer, deck_half});
    const auto add_stone = [&](std::uint32_t shape, Vec3 from_axis, double azimuth, double y, std::string_view name) {
        const Quat rotation = rotation_about({0, 1, 0}, azimuth);
        const Vec3d p = foot + to_double(rotate(rotation, from_axis)) + Vec3d{0, y, 0};
        builder.add(shape, stone_of(masonry, name), {.position = p, .rotation = rotation});
    };
    for (int course = 0; course < courses; ++course) {
        for (int i = 0; i < wedges; ++i) {
            add_stone(wedge, origin, (i + 0.5 * (course % 2)) * angle, (course + 0.5) * Masonry::course, "tower stone");
        }
    }
    double top = courses * double(Masonry::course);
    builder.add(deck, wood, {.position = foot + Vec3d{0, top + deck_half, 0}});
    top += 2 * double(deck_half);
    for (int i = 0; i < wedges; i += 2) add_stone(merlon, merlon_origin, i * angle, top + merlon_half, "merlon");
    if (!roofed) return;
    top += 2 * double(merlon_half);
    // A flat cone whose eaves extend beyond the battlements. Its origin is a quarter of the height above the eaves,
    // near its centre of mass.
    constexpr float height = 2.5f;
    std::vector<Vec3> points{{0, 0.75f * height, 0}};
    for (int i = 0; i < wedges; ++i) {
        const SinCos direction = sin_cos((i + 0.5) * angle);
        points.push_back({(outer + 0.3f) * static_cast<float>(direction.cos), -0.25f * height,
                          (outer + 0.3f) * static_cast<float>(direction.sin)});
    }
    builder.add(builder.hull(points), tiles, {.position = foot + Vec3d{0, top + 0.25 * height, 0}});
}

void build_keep(Masonry& masonry, Vec3d foot, int blocks, int courses) {
    constexpr float depth = 0.6f, beam_half = 0.2f, merlon_half = 0.45f;
    Builder& builder = masonry.builder;
    const BlockKind kind = make_blocks(masonry, depth);
    const std::uint32_t merlon =
        builder.shape(Box{{(Masonry::length - Masonry::joint) / 2, merlon_half, (depth - Masonry::joint) / 2}});
    // Each of the four runs covers one corner and stops before the next; odd courses run in the opposite direction.
    const double run = blocks * Masonry::length, side = run + depth;
    const auto add_course = [&](std::uint32_t shape, double half_height, double bottom, bool mirrored, int step,
                                std::string_view name) {
        constexpr std::array<Vec3, 4> directions{{{1, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 0, -1}}};
        for (const Vec3 along : directions) {
            const Vec3 inward{-along.z, 0, along.x};
            for (int i = 0; i < blocks; i += step) {
                double distance = (i + 0.5) * Masonry::length - side / 2;
                if (mirrored) distance = -distance;
                const Vec3d p = foot + to_double(along) * distance - to_double(inward) * ((side - depth) / 2) +
                                Vec3d{0, bottom + half_height, 0};
                builder.add(shape, stone_of(masonry, name), {.position = p, .rotation = facing(along)});
            }
        }
    };
    for (int course = 0; course < courses; ++course) {
        add_course(kind.full, Masonry::course / 2, course * double(Masonry::course), course % 2 == 1, 1, "keep stone");
    }
    double top = courses * double(Masonry::course);
    const int beams = 12;
    const double beam_width = side / beams;
    const std::uint32_t beam = builder.shape(
        Box{{static_cast<float>(side / 2), beam_half, static_cast<float>((beam_width - Masonry::joint) / 2)}});
    for (int i = 0; i < beams; ++i) {
        builder.add(beam, wood, {.position = foot + Vec3d{0, top + beam_half, (i - 0.5 * (beams - 1)) * beam_width}});
    }
    top += 2 * double(beam_half);
    add_course(merlon, merlon_half, top, false, 2, "merlon");
}

void build_arch(Masonry& masonry, Vec3d middle, Vec3 along, float radius, float half_width, float height, float depth) {
    constexpr int stones = 9;
    const double gap = Masonry::joint / 2;
    for (int i = 0; i < stones; ++i) {
        const SinCos first = sin_cos(pi * i / stones), last = sin_cos(pi * (i + 1) / stones);
        const double w = half_width - gap;
        std::vector<Vec2d> face{{-w, 0}, {w, 0}, {w, height}, {-w, height}};
        face = clipped(face, {-first.sin, first.cos}, gap);
        face = clipped(face, {last.sin, -last.cos}, gap);
        // The chord of the inner circle is perpendicular to the direction of the stone's middle.
        const SinCos half = sin_cos(pi * (i + 0.5) / stones);
        face = clipped(face, {half.cos, half.sin}, radius * sin_cos(pi / (2 * stones)).cos);
        Vec2d centre;
        for (const Vec2d p : face)
            centre = {centre.x + p.x / double(face.size()), centre.y + p.y / double(face.size())};
        // Rounds to a grid that float represents exactly, so that the flat top stays in place.
        centre = {std::floor(centre.x * 64) / 64, std::floor(centre.y * 64) / 64};
        std::vector<Vec3> points;
        for (const Vec2d p : face) {
            for (const float side : {-0.5f, 0.5f}) {
                points.push_back({static_cast<float>(p.x - centre.x), static_cast<float>(p.y - centre.y),
                                  side * (depth - Masonry::joint)});
            }
        }
        const Vec3d position = middle + to_double(along) * centre.x + Vec3d{0, centre.y, 0};
        masonry.builder.add(masonry.builder.hull(points), stone_of(masonry, "arch stone"),
                            {.position = position, .rotation = facing(along)});
    }
}

}  // namespace fase::scene
