#pragma once
/// Bullet as an engine that `fase bench` measures.
#include <memory>

#include "bench/engine.hpp"

namespace fase::bench {

/// Bullet's btDiscreteDynamicsWorld with its own defaults: dynamic AABB trees, sequential impulses. Materials are set
/// so that its product of frictions is Fase's geometric mean. Kinematic bodies move on at their first velocities, as in
/// Fase. Unsupported for axis locks, gravity scales other than 1, sensors and filters.
Result<std::unique_ptr<Engine>> make_bullet(const scene::Scene& scene, const EngineOptions& options);

/// The same with 50 iterations a step instead of 10: what it takes until a wall of 100 rows stands.
Result<std::unique_ptr<Engine>> make_bullet_50(const scene::Scene& scene, const EngineOptions& options);

}  // namespace fase::bench
