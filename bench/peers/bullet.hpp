#pragma once
/// Bullet in `fase bench step`.
#include <memory>

#include "bench/engine.hpp"

namespace fase::bench {

/// Creates a btDiscreteDynamicsWorld with Bullet's defaults: dynamic AABB trees, sequential impulses. Material values
/// are converted so that Bullet's product of frictions equals Fase's geometric mean. Kinematic bodies keep their
/// initial velocities, as in Fase. Error Unsupported: axis locks, gravity scales other than 1, sensors and filters.
Result<std::unique_ptr<Engine>> make_bullet(const scene::Scene& scene, const EngineOptions& options);

/// The same with 50 iterations per step instead of 10: as many as a wall of 100 rows needs to stay up.
Result<std::unique_ptr<Engine>> make_bullet_50(const scene::Scene& scene, const EngineOptions& options);

}  // namespace fase::bench
