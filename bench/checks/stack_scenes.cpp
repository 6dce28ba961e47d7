/// What the suite `stacks` builds, on ground at y = 0.
#include "bench/checks/stack_scenes.hpp"

#include <cmath>

#include "bench/checks/random_scenes.hpp"
#include "fase/core/random.hpp"

namespace fase::checks {

std::vector<double> add_stack(CheckWorld& world, int boxes) {
    std::vector<double> heights;
    for (int i = 0; i < boxes; ++i) {
        heights.push_back(0.5 + i);
        world.add({.position = {0, heights.back(), 0}}, Box{});
    }
    return heights;
}

void add_crooked_stack(CheckWorld& world, int boxes, double shift, bool random) {
    Random numbers(world.context().seed, 1);
    for (int i = 0; i < boxes; ++i) {
        const double side = i % 2 == 0 ? 1 : -1;
        const double x = random ? double(numbers.between(-1, 1)) : side;
        const double z = random ? double(numbers.between(-1, 1)) : 0;
        world.add({.position = {x * shift, 0.5 + i, z * shift}}, Box{});
    }
}

void add_pyramid(CheckWorld& world, int base) {
    constexpr double pitch = 1.1;
    for (int row = 0; row < base; ++row)
        for (int i = 0; i < base - row; ++i)
            world.add({.position = {pitch * (i - 0.5 * (base - row - 1)), 0.5 + row, 0}}, Box{});
}

void add_kapla_tower(CheckWorld& world, int layers, float half_width) {
    const Quat quarter_turn{0, std::sqrt(0.5f), 0, std::sqrt(0.5f)};
    const double outer = 1.5 - double(half_width);
    for (int layer = 0; layer < layers; ++layer)
        for (const double aside : {-outer, 0.0, outer}) {
            const double y = 0.1 + 0.2 * layer;
            const bool along_x = layer % 2 == 0;
            world.add({.position = along_x ? Vec3d{0, y, aside} : Vec3d{aside, y, 0},
                       .rotation = along_x ? Quat{} : quarter_turn},
                      Box{{1.5f, 0.1f, half_width}});
        }
}

CheckWorld box_heap(Context& context, int boxes, const Settings& settings) {
    CheckWorld world(context, settings);
    world.add_ground();
    Random random(context.seed, 2);
    const int side = 12;
    for (int i = 0; i < boxes; ++i) {
        const int layer = i / (side * side), cell = i % (side * side);
        const auto size = [&] { return random.between(0.25f, 0.45f); };
        const Box box{{size(), size(), size()}};
        world.add({.position = {1.3 * (cell % side - 0.5 * side), 1 + 1.3 * layer, 1.3 * (cell / side - 0.5 * side)},
                   .rotation = random_rotation(random)},
                  box);
    }
    return world;
}

}  // namespace fase::checks
