/// Common benchmark scenes of physics engines: pyramids, a rock pile, a washer.
#include <algorithm>
#include <cmath>

#include "fase/scene/generate/angles.hpp"
#include "fase/scene/generate/builder.hpp"

namespace fase::scene {
namespace {

constexpr BodyStyle stone{"ground", {0.55f, 0.55f, 0.52f}, 1000, {}};
/// One colour per row, so that the motion of a wall is visible.
constexpr Colour row_colours[]{
    {0.80f, 0.47f, 0.27f}, {0.89f, 0.69f, 0.36f}, {0.45f, 0.60f, 0.64f}, {0.30f, 0.42f, 0.55f}};

/// Adds a wall of unit boxes along x on y = 0. The boxes touch but do not overlap.
void add_wall(Builder& builder, std::uint32_t unit_box, int base, double middle_x, double z) {
    for (int row = 0; row < base; ++row) {
        const BodyStyle style{"box", row_colours[row % 4], 100, {}};
        for (int i = 0; i < base - row; ++i) {
            const double x = middle_x + i - 0.5 * (base - row - 1);
            builder.add(unit_box, style, {.position = {x, row + 0.5, z}});
        }
    }
}

/// Adds a floor and four walls of `height` around [-half, half]².
void add_pit(Builder& builder, float half, float height, const BodyStyle& style) {
    const float thick = 1;
    builder.static_box({0, -thick, 0}, {half + 2 * thick, thick, half + 2 * thick}, style);
    for (const int side : {-1, 1}) {
        builder.static_box({side * double(half + thick), height / 2, 0}, {thick, height / 2, half + 2 * thick}, style);
        builder.static_box({0, height / 2, side * double(half + thick)}, {half, height / 2, thick}, style);
    }
}

}  // namespace

Scene make_large_pyramid(const GenerateOptions& options) {
    Builder builder("large_pyramid");
    // The largest wall with at most `count` boxes: base (base + 1) / 2.
    const int base =
        std::max(1, static_cast<int>(std::sqrt(2.0 * static_cast<double>(options.count) + 0.25) - 0.5 + 1e-9));
    const float half_width = static_cast<float>(base);
    builder.static_box({0, -1, 0}, {std::max(100.0f, half_width), 1, std::max(100.0f, half_width)}, stone);
    add_wall(builder, builder.shape(Box{{0.5f, 0.5f, 0.5f}}), base, 0, 0);
    builder.scene().camera =
        Camera{{0.35f * half_width, 0.55f * half_width, 1.25f * half_width + 4}, {0, 0.4f * half_width, 0}};
    return builder.take();
}

Scene make_many_pyramids(const GenerateOptions& options) {
    constexpr int base = 10, boxes_per_wall = base * (base + 1) / 2;
    constexpr double along = base + 2, apart = 3;
    Builder builder("many_pyramids");
    const int pyramids = std::max(1, static_cast<int>((options.count + boxes_per_wall / 2) / boxes_per_wall));
    const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(pyramids))));
    const int rows = (pyramids + columns - 1) / columns;
    const float half_x = static_cast<float>(columns * along / 2 + 20),
                half_z = static_cast<float>(rows * apart / 2 + 20);
    builder.static_box({0, -1, 0}, {half_x, 1, half_z}, stone);
    const std::uint32_t unit_box = builder.shape(Box{{0.5f, 0.5f, 0.5f}});
    for (int i = 0; i < pyramids; ++i) {
        const double x = (i % columns - 0.5 * (columns - 1)) * along, z = (i / columns - 0.5 * (rows - 1)) * apart;
        add_wall(builder, unit_box, base, x, z);
    }
    builder.scene().camera = Camera{{0.6f * half_x, 0.6f * half_x, half_z + 0.8f * half_x}, {0, 2, 0}};
    return builder.take();
}

Scene make_hull_pile(const GenerateOptions& options) {
    constexpr float spacing = 1.3f;
    constexpr int forms = 32;
    Builder builder("hull_pile");
    Random random(options.seed, 1);
    const int count = static_cast<int>(options.count);
    const int side = std::max(3, static_cast<int>(std::cbrt(static_cast<double>(count) / 2) + 1e-9));
    const float half = 0.5f * spacing * static_cast<float>(side) + 0.2f;
    add_pit(builder, half, 2.5f * half, stone);
    std::vector<std::uint32_t> rocks;
    for (int i = 0; i < forms; ++i)
        rocks.push_back(builder.hull(rock_points(random, random.between(0.3f, 0.6f), 10 + i % 8)));
    for (int i = 0; i < count; ++i) {
        const int layer = i / (side * side), cell = i % (side * side);
        const double x = (cell % side - 0.5 * (side - 1)) * spacing, z = (cell / side - 0.5 * (side - 1)) * spacing;
        const BodyStyle style{"rock", row_colours[random.below(4)], 2000, {}};
        const std::uint32_t rock = rocks[random.below(rocks.size())];
        builder.add(rock, style, {.position = {x, 1 + spacing * layer, z}, .rotation = random_rotation(random)});
    }
    builder.scene().camera = Camera{{1.8f * half, 4.2f * half, 3.4f * half}, {0, half, 0}};
    return builder.take();
}

Scene make_washer(const GenerateOptions& options) {
    constexpr float half = 0.2f;
    constexpr double pitch = 2 * half + 0.01;
    constexpr int staves = 16, paddles = 8;
    constexpr float thick = 0.5f;
    Builder builder("washer");
    const int side = std::max(1, static_cast<int>(std::cbrt(static_cast<double>(options.count)) + 0.5));
    const float block = static_cast<float>(pitch) * static_cast<float>(side);
    const float radius = 0.85f * block + 1, half_length = 0.5f * block + 0.2f;
    const double centre = 1.3 * radius + thick;
    const BodyStyle steel{"drum", {0.62f, 0.66f, 0.72f, 0.35f}, 7800, {}};

    // The drum around z: staves form the tube, paddles lift the cubes, two plates close the ends.
    const float stave_half =
        (radius + 2 * thick) * static_cast<float>(sin_cos(pi / staves).sin / sin_cos(pi / staves).cos);
    const std::uint32_t stave = builder.shape(Box{{stave_half, thick, half_length + 2 * thick}});
    const std::uint32_t paddle = builder.shape(Box{{0.1f, 0.12f * radius, half_length}});
    const std::uint32_t end = builder.shape(Box{{radius + thick, radius + thick, thick}});
    Body& drum = builder.add(end, steel, {.position = {0, centre, 0}, .kind = BodyKind::Kinematic});
    drum.colliders[0].def.pose.position = drum.visuals[0].position = {0, 0, -(half_length + thick)};
    builder.attach(drum, end, steel, {{0, 0, half_length + thick}, {}});
    const auto pose_on_drum = [](int i, int count, float distance) {
        const double angle = 2 * pi * i / count;
        const SinCos direction = sin_cos(angle);
        return LocalPose{
            {static_cast<float>(direction.sin) * distance, -static_cast<float>(direction.cos) * distance, 0},
            rotation_about({0, 0, 1}, angle)};
    };
    for (int i = 0; i < staves; ++i) builder.attach(drum, stave, steel, pose_on_drum(i, staves, radius + thick));
    for (int i = 0; i < paddles; ++i)
        builder.attach(drum, paddle, steel, pose_on_drum(2 * i + 1, 2 * paddles, 0.9f * radius));
    drum.def.angular_velocity = {0, 0, static_cast<float>(25 * pi / 180)};
    drum.def.can_sleep = false;

    const std::uint32_t cube = builder.shape(Box{{half, half, half}});
    for (int y = 0; y < side; ++y) {
        const BodyStyle style{"cube", row_colours[y * 4 / side], 1000, {}};
        for (int z = 0; z < side; ++z) {
            for (int x = 0; x < side; ++x) {
                const auto offset = [&](int i) { return (i - 0.5 * (side - 1)) * pitch; };
                builder.add(cube, style, {.position = {offset(x), centre + offset(y), offset(z)}});
            }
        }
    }
    builder.scene().camera = Camera{{0.6f * radius, static_cast<float>(centre) + 0.5f * radius, 3.6f * radius},
                                    {0, static_cast<float>(centre), 0}};
    return builder.take();
}

}  // namespace fase::scene
