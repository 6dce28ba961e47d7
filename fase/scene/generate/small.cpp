/// Small scenes: a stack, a pile of all shapes, sleeping stacks, dominoes.
#include <algorithm>
#include <cmath>

#include "fase/scene/generate/angles.hpp"
#include "fase/scene/generate/builder.hpp"

namespace fase::scene {
namespace {

constexpr Colour palette[]{
    {0.83f, 0.36f, 0.24f}, {0.93f, 0.70f, 0.27f}, {0.35f, 0.60f, 0.47f}, {0.22f, 0.45f, 0.62f}, {0.60f, 0.42f, 0.60f}};

BodyStyle painted(std::string_view name, std::size_t i, float density = 1000) {
    return {name, palette[i % std::size(palette)], density, {}};
}

/// The side of the smallest square grid with at least `count` cells.
int side_for(std::size_t count) {
    return std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count)) - 1e-9)));
}

}  // namespace

Scene make_stack(const GenerateOptions& options) {
    Builder builder("stack");
    builder.ground(50, grass);
    const std::uint32_t box = builder.shape(Box{{0.5f, 0.5f, 0.5f}});
    for (std::size_t i = 0; i < options.count; ++i) {
        builder.add(box, painted("box", i), {.position = {0, static_cast<double>(i) + 0.5, 0}});
    }
    const float height = static_cast<float>(options.count);
    builder.scene().camera = Camera{{0.9f * height + 4, 0.6f * height + 1, 1.2f * height + 4}, {0, 0.45f * height, 0}};
    return builder.take();
}

Scene make_pile(const GenerateOptions& options) {
    constexpr float spacing = 1.25f;
    Builder builder("pile");
    Random random(options.seed, 2);
    builder.ground(100, grass);
    const int side = std::max(4, static_cast<int>(std::cbrt(2.0 * static_cast<double>(options.count)) + 1e-9));
    const float half = 0.5f * spacing * static_cast<float>(side) + 0.3f, wall_height = 1.5f;
    const BodyStyle wall{"wall", {0.58f, 0.54f, 0.46f}, 2400, {}};
    for (const int sign : {-1, 1}) {
        builder.static_box({sign * double(half + 0.25f), wall_height / 2, 0}, {0.25f, wall_height / 2, half + 0.5f},
                           wall);
        builder.static_box({0, wall_height / 2, sign * double(half + 0.25f)}, {half, wall_height / 2, 0.25f}, wall);
    }
    std::vector<std::uint32_t> shapes;
    for (int i = 0; i < 4; ++i) {
        const auto size = [&] { return random.between(0.2f, 0.4f); };
        shapes.push_back(builder.shape(Box{{size(), size(), size()}}));
        shapes.push_back(builder.shape(Sphere{size()}));
        shapes.push_back(builder.shape(Capsule{0.7f * size(), 0.7f * size()}));
        shapes.push_back(builder.shape(Cylinder{size(), size()}));
        shapes.push_back(builder.hull(rock_points(random, 0.3f + 0.07f * static_cast<float>(i), 12 + 2 * i)));
    }
    for (std::size_t i = 0; i < options.count; ++i) {
        const auto cell = static_cast<int>(i % static_cast<std::size_t>(side * side));
        const double layer = static_cast<double>(i / static_cast<std::size_t>(side * side));
        const std::uint32_t shape = shapes[random.below(shapes.size())];
        const auto jittered = [&](int k) {
            return (k - 0.5 * (side - 1) + 0.1 * double(random.between(-1, 1))) * spacing;
        };
        const double x = jittered(cell % side), z = jittered(cell / side);
        const std::size_t colour = random.below(std::size(palette));
        const Quat rotation = random_rotation(random);
        builder.add(shape, painted(name_of(builder.scene().shapes[shape]), colour),
                    {.position = {x, 1 + spacing * layer, z}, .rotation = rotation});
    }
    builder.scene().camera = Camera{{1.6f * half, 1.7f * half, 2.4f * half}, {0, 0.5f * half, 0}};
    return builder.take();
}

Scene make_sleepers(const GenerateOptions& options) {
    constexpr int stack_height = 5;
    constexpr double spacing = 2.5;
    Builder builder("sleepers");
    Random random(options.seed, 3);
    const std::size_t stacks = std::max<std::size_t>(1, options.count / stack_height);
    const int side = side_for(stacks);
    const float half = static_cast<float>(0.5 * spacing * side) + 10;
    builder.ground(2 * half, grass);
    const std::uint32_t box = builder.shape(Box{{0.5f, 0.5f, 0.5f}}), ball = builder.shape(Sphere{0.7f});
    for (std::size_t i = 0; i < stacks; ++i) {
        const int column = static_cast<int>(i % static_cast<std::size_t>(side)),
                  row = static_cast<int>(i / static_cast<std::size_t>(side));
        const Quat rotation = rotation_about({0, 1, 0}, double(random.unit()) * pi / 2);
        for (int k = 0; k < stack_height; ++k) {
            builder.add(
                box, painted("sleeper", static_cast<std::size_t>(k)),
                {.position = {(column - 0.5 * (side - 1)) * spacing, k + 0.5, (row - 0.5 * (side - 1)) * spacing},
                 .rotation = rotation,
                 .kind = BodyKind::Dynamic,
                 .awake = false});
        }
    }
    for (int i = 0; i < 4; ++i) {
        // Starts at the edge and rolls along a row.
        const int row = static_cast<int>(random.below(static_cast<std::uint64_t>(side)));
        const Vec3d start{-0.5 * spacing * side - 2, 0.7, (row - 0.5 * (side - 1)) * spacing + 1.6 * (i - 1.5)};
        builder.add(ball, {"ball", {0.06f, 0.06f, 0.07f}, 7800, {}},
                    {.position = start, .linear_velocity = {12, 0, 0}});
    }
    builder.scene().camera = Camera{{-half, 0.6f * half, half}, {0, 0, 0}};
    return builder.take();
}

Scene make_domino(const GenerateOptions& options) {
    constexpr double pitch = 0.6, inner = 2, apart = 2;
    Builder builder("domino");
    const std::uint32_t tile = builder.shape(Box{{0.08f, 0.6f, 0.3f}}), ball = builder.shape(Sphere{0.25f});
    double angle = 0, radius = inner;
    for (std::size_t i = 0; i < options.count; ++i) {
        const SinCos direction = sin_cos(angle);
        // The tile's x is tangential to the spiral, whose radius grows slowly.
        const double lean = apart / (2 * pi * radius);
        const Vec3 along =
            to_float(normalized(Vec3d{-direction.sin + lean * direction.cos, 0, direction.cos + lean * direction.sin}));
        const Quat rotation = to_quat(Mat3{along, {0, 1, 0}, cross(along, Vec3{0, 1, 0})});
        const Vec3d position{radius * direction.cos, 0.6, radius * direction.sin};
        if (i == 0) {
            const Vec3d start = position - to_double(along) * 1.2 + Vec3d{0, 0.5, 0};
            builder.add(ball, {"ball", {0.06f, 0.06f, 0.07f}, 7800, {}},
                        {.position = start, .linear_velocity = along * 4.0f});
        }
        builder.add(tile, painted("domino", i / 12, 700), {.position = position, .rotation = rotation});
        angle += pitch / std::sqrt(radius * radius + apart * apart / (4 * pi * pi));
        radius = inner + apart * angle / (2 * pi);
    }
    const float reach = static_cast<float>(radius) + 2;
    builder.ground(2 * reach, grass);
    builder.scene().camera = Camera{{0.5f * reach, 0.9f * reach, 1.2f * reach}, {0, 0, 0}};
    return builder.take();
}

}  // namespace fase::scene
