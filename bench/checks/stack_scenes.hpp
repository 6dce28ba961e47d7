#pragma once
/// What the suite `stacks` builds, on ground at y = 0.
#include "bench/checks/check_world.hpp"

namespace fase::checks {

/// Adds a stack of unit boxes at x = z = 0 without gaps. Returns the heights of their centres.
std::vector<double> add_stack(CheckWorld& world, int boxes);
/// The same with each box shifted by up to `shift` metres along x and z: alternating, or at random by the seed.
void add_crooked_stack(CheckWorld& world, int boxes, double shift, bool random);
/// Adds a wall of unit boxes with `base` boxes in the lowest row, each row one box shorter; 0.1 m between neighbours.
void add_pyramid(CheckWorld& world, int base);
/// Adds a tower of planks 3 m long and 0.2 m thick: three a layer, crosswise, without gaps between layers.
void add_kapla_tower(CheckWorld& world, int layers, float half_width);
/// A world in which boxes of different sizes fall onto the ground in a loose block.
[[nodiscard]] CheckWorld box_heap(Context& context, int boxes, const Settings& settings);

}  // namespace fase::checks
