#pragma once
/// Random rotations and shapes for checks, from a seeded stream.
#include "fase/core/random.hpp"
#include "fase/geometry/shapes.hpp"
#include "fase/math/quat.hpp"

namespace fase::checks {

/// Returns a uniformly distributed rotation, by rejection.
[[nodiscard]] Quat random_rotation(Random& random);
/// Returns a bounded shape of any kind, of about `size` metres half across.
[[nodiscard]] Shape random_shape(Random& random, float size);
/// A bumpy square of `size` metres with 32 triangles, one- or two-sided.
[[nodiscard]] Shape random_mesh(Random& random, float size);

}  // namespace fase::checks
