/// The default scene: a castle of loose stones and a volley of heavy balls that hits it.
#include <algorithm>
#include <array>
#include <cmath>

#include "fase/scene/generate/angles.hpp"
#include "fase/scene/generate/masonry.hpp"

namespace fase::scene {
namespace {

// The plan, in metres: four towers on a square, walls of two layers between them, a gate in the wall at +z.
constexpr int wall_blocks = 17, outer_courses = 10, inner_courses = 8, tower_courses = 17;
constexpr float tower_radius = 2.4f, outer_depth = 0.5f, inner_depth = 1;
constexpr double corner_distance = 0.5 * wall_blocks * Masonry::length + tower_radius + 0.001;
constexpr int gate_blocks = 5, pier_courses = 3, arch_courses = 4;
constexpr double bodies_per_castle = 3000;

/// The two layers of a wall.
struct WallLayers {
    BlockKind outer, inner;
    static constexpr float outer_offset = 0.5f, inner_offset = -0.25f;  ///< to the left of the line, which is outward
};

/// Adds the courses from `first` to before `end`; courses above the inner layer's top are added to the outer layer
/// only.
void add_layers(Masonry& masonry, const WallLayers& layers, const WallLine& line, int blocks, int first, int end) {
    add_wall_courses(masonry, layers.outer, line, WallLayers::outer_offset, blocks, first, end - first);
    add_wall_courses(masonry, layers.inner, line, WallLayers::inner_offset, blocks, first,
                     std::min(end, inner_courses) - first);
}

/// The line that starts `metres` further along.
WallLine advanced(const WallLine& line, double metres) {
    return {line.start + to_double(line.along) * metres, line.along};
}

/// Adds piers, the arch on them, and the courses on both sides.
void build_gate(Masonry& masonry, const WallLayers& layers, const WallLine& line) {
    const float depth = outer_depth + inner_depth, half_width = 0.5f * gate_blocks * Masonry::length;
    const int side_blocks = (wall_blocks - gate_blocks) / 2;
    const Vec3d middle = advanced(line, 0.5 * wall_blocks * Masonry::length).start;
    const BlockKind pier = make_blocks(masonry, depth);
    for (int course = 0; course < pier_courses; ++course) {
        for (const int side : {-1, 1}) {
            Vec3d p = middle + to_double(line.along) * (side * 0.5 * (gate_blocks - 1) * Masonry::length);
            p.y = (course + 0.5) * Masonry::course;
            masonry.builder.add(pier.full, stone_of(masonry, "pier stone"),
                                {.position = p, .rotation = facing(line.along)});
        }
    }
    build_arch(masonry, middle + Vec3d{0, pier_courses * double(Masonry::course), 0}, line.along,
               half_width - Masonry::length, half_width, arch_courses * Masonry::course, depth);
    const int top = pier_courses + arch_courses;
    add_layers(masonry, layers, line, side_blocks, 0, top);
    add_layers(masonry, layers, advanced(line, (side_blocks + gate_blocks) * double(Masonry::length)), side_blocks, 0,
               top);
    add_layers(masonry, layers, line, wall_blocks, top, outer_courses);
}

void build_walls(Masonry& masonry, Vec3d centre) {
    Builder& builder = masonry.builder;
    const WallLayers layers{make_blocks(masonry, outer_depth), make_blocks(masonry, inner_depth)};
    const float plank_half = 0.1f, merlon_half = 0.4f;
    const std::uint32_t merlon =
        builder.shape(Box{{(Masonry::length - Masonry::joint) / 2, merlon_half, (outer_depth - Masonry::joint) / 2}});
    const std::uint32_t plank =
        builder.shape(Box{{(Masonry::length - Masonry::joint) / 2, plank_half, (inner_depth - Masonry::joint) / 2}});
    constexpr std::array<Vec3, 4> directions{{{-1, 0, 0}, {0, 0, -1}, {1, 0, 0}, {0, 0, 1}}};
    for (std::size_t i = 0; i < directions.size(); ++i) {
        // Counter-clockwise seen from below, so that left is outward.
        const Vec3 along = directions[i], outward{along.z, 0, -along.x};
        const double half = 0.5 * wall_blocks * Masonry::length;
        const WallLine line{centre + to_double(outward) * corner_distance - to_double(along) * half, along};
        if (outward.z > 0.5f) {
            build_gate(masonry, layers, line);
        } else {
            add_layers(masonry, layers, line, wall_blocks, 0, outer_courses);
        }
        for (int k = 0; k < wall_blocks; ++k) {
            Vec3d p = advanced(line, (k + 0.5) * Masonry::length).start +
                      to_double(outward) * double(WallLayers::inner_offset);
            p.y = inner_courses * double(Masonry::course) + plank_half;
            builder.add(plank, wood, {.position = p, .rotation = facing(along)});
        }
        add_battlement(masonry, merlon, merlon_half, line, WallLayers::outer_offset, wall_blocks,
                       outer_courses * double(Masonry::course));
    }
}

/// Adds stacked barrels and piles of logs between stones.
void fill_yard(Masonry& masonry, Vec3d centre) {
    Builder& builder = masonry.builder;
    constexpr float barrel_radius = 0.35f, barrel_half = 0.45f, log_radius = 0.25f, log_half = 1.2f;
    const std::uint32_t barrel = builder.shape(Cylinder{barrel_radius, barrel_half});
    const std::uint32_t log = builder.shape(Capsule{log_radius, log_half});
    const std::uint32_t block = builder.shape(Box{{0.4f, 0.6f, 1}});
    const BodyStyle oak{"barrel", {0.42f, 0.26f, 0.12f}, 800, {}};
    const BodyStyle wood_log{"log", {0.50f, 0.36f, 0.20f}, 700, {}};
    for (const double x : {-6.5, 6.5}) {
        for (int layer = 0; layer < 3; ++layer) {
            for (int i = 0; i < (3 - layer) * (3 - layer); ++i) {
                const auto offset = [&](int k) {
                    return (k - 0.5 * (2 - layer)) * (2 * double(barrel_radius) + 0.001);
                };
                builder.add(
                    barrel, oak,
                    {.position = centre + Vec3d{x + offset(i % (3 - layer)), (2 * layer + 1) * double(barrel_half),
                                                6.5 + offset(i / (3 - layer))}});
            }
        }
    }
    const double pitch = 2 * double(log_radius) + 0.001,
                 rise = std::sqrt((2 * double(log_radius) + 0.0002) * (2 * double(log_radius) + 0.0002) -
                                  pitch * pitch / 4);
    const Quat horizontal{0.70710678f, 0, 0, 0.70710678f};
    for (const double x : {-6.5, 6.5}) {
        const Vec3d base = centre + Vec3d{x, 0, -6};
        for (int layer = 0; layer < 3; ++layer) {
            for (int i = 0; i < 4 - layer; ++i) {
                builder.add(log, wood_log,
                            {.position = base + Vec3d{(i - 0.5 * (3 - layer)) * pitch, log_radius + layer * rise, 0},
                             .rotation = horizontal});
            }
        }
        for (const int side : {-1, 1}) {
            builder.add(block, stone_of(masonry, "stone"),
                        {.position = base + Vec3d{side * (2 * pitch + 0.4005), 0.6f, 0}});
        }
    }
}

/// Scatters rocks around the walls, apart from each other and slightly above the ground.
void scatter_rocks(Masonry& masonry, Vec3d centre, int count) {
    std::vector<std::uint32_t> forms;
    for (int i = 0; i < 8; ++i)
        forms.push_back(masonry.builder.hull(rock_points(masonry.random, masonry.random.between(0.3f, 0.8f), 12 + i)));
    for (int i = 0; i < count; ++i) {
        // Three rings, 3 m apart, with one angular slot per rock: no two rocks touch.
        const int ring = i % 3;
        const SinCos direction = sin_cos(2 * pi * (i / 3 + 0.6 * double(masonry.random.unit())) / ((count + 2) / 3));
        const double distance = 20 + 3 * ring + double(masonry.random.unit());
        // Separate statements: the compiler may evaluate arguments in any order.
        const std::uint32_t form = forms[masonry.random.below(forms.size())];
        const BodyStyle style = stone_of(masonry, "rock");
        const Quat rotation = random_rotation(masonry.random);
        masonry.builder.add(form, style,
                            {.position = centre + Vec3d{distance * direction.cos, 0.9, distance * direction.sin},
                             .rotation = rotation});
    }
}

/// One ball of the volley.
struct Shot {
    double seconds;  ///< time of impact
    Vec3 target;
    double side;  ///< direction that it comes from, radians from the front of the gate
    float radius;
};

void fire_volley(Masonry& masonry, Vec3d centre, Vec3 gravity) {
    constexpr float c = static_cast<float>(corner_distance);
    constexpr Shot shots[]{
        {2.0, {5, 3.2f, c}, 0.1, 0.8f}, {2.8, {-c, 5, c}, -0.4, 0.9f},  {3.3, {-5.5f, 3, c}, -0.2, 0.8f},
        {3.8, {c, 6, c}, 0.5, 0.9f},    {4.3, {0, 4.2f, c}, 0.05, 1},   {4.8, {c, 3, 2}, 1.2, 0.8f},
        {5.3, {2, 6, 3}, 0.3, 1},       {5.7, {-c, 4, -c}, -1.1, 0.9f}, {6.1, {-2, 7, 3}, -0.5, 1.1f},
        {6.5, {c, 5, -c}, 1.4, 1},      {6.9, {-c, 3, -3}, -1.5, 0.8f}, {7.3, {3, 8, 2}, 0.6, 1},
        {7.7, {-c, 6, c}, -0.7, 1.1f},  {8.2, {0, 8, 0}, 0.0, 1.2f},    {8.7, {c, 4, c}, 0.9, 1},
        {9.2, {1, 5, 3}, 0.2, 1.3f},
    };
    Builder& builder = masonry.builder;
    const BodyStyle boulder{"boulder", {0.30f, 0.28f, 0.27f}, 2700, {}};
    int number = 0;
    for (const Shot& shot : shots) {
        const bool is_ball = number++ % 4 != 3;
        const std::uint32_t shape = is_ball ? builder.shape(Sphere{shot.radius})
                                            : builder.hull(rock_points(masonry.random, 1.25f * shot.radius, 24));
        // The start position and the velocity that hit the target after `seconds` of free flight.
        const SinCos side = sin_cos(shot.side);
        const Vec3d target = centre + to_double(shot.target);
        const double distance = 24 * shot.seconds + 12;
        const Vec3d start{centre.x + distance * side.sin, 8 + 6 * shot.seconds, centre.z + distance * side.cos};
        const Vec3d velocity = (target - start) * (1 / shot.seconds) - to_double(gravity) * (shot.seconds / 2);
        Body& ball =
            builder.add(shape, is_ball ? iron : boulder, {.position = start, .linear_velocity = to_float(velocity)});
        ball.def.angular_velocity = random_direction(masonry.random) * 3;
        ball.def.angular_damping = 1;  // rolling resistance of grass
    }
}

}  // namespace

Scene make_castle(const GenerateOptions& options) {
    Builder builder("castle");
    builder.ground(300, grass);
    const int castles = std::max(1, static_cast<int>(static_cast<double>(options.count) / bodies_per_castle + 0.5));
    const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(castles))));
    for (int i = 0; i < castles; ++i) {
        Masonry masonry{builder, Random(options.seed, static_cast<std::uint64_t>(i))};
        const Vec3d centre{(i % columns - 0.5 * (columns - 1)) * 70.0, 0, (i / columns) * -70.0};
        for (const double x : {-1, 1}) {
            for (const double z : {-1, 1})
                build_tower(masonry, centre + Vec3d{x * corner_distance, 0, z * corner_distance}, tower_radius,
                            tower_courses, z < 0);
        }
        build_walls(masonry, centre);
        build_keep(masonry, centre + Vec3d{0, 0, -1.5}, 7, 21);
        fill_yard(masonry, centre);
        scatter_rocks(masonry, centre, 120);
        fire_volley(masonry, centre, builder.scene().gravity);
    }
    for (Body& body : builder.scene().bodies)  // stops endless rocking of stones on rubble
        if (body.def.kind == BodyKind::Dynamic && body.def.angular_damping == 0) body.def.angular_damping = 0.2f;
    builder.scene().camera = Camera{{27, 17, 38}, {0, 3, 0}};
    return builder.take();
}

}  // namespace fase::scene
