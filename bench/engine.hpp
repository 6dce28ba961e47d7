#pragma once
/// An engine that `fase bench` measures: a scene goes in, steps are done, heights come out.
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/scene/scene.hpp"

namespace fase::bench {

/// How an engine is to step. What else it has stays as its makers set it.
struct EngineOptions {
    Settings settings;  ///< gravity, time step and sleep count for all; the rest for Fase alone
    int threads = 1;    ///< for engines that have threads
};

/// A world of some engine, filled from a scene.
class Engine {
public:
    virtual ~Engine() = default;
    /// One step of the time step it was made with.
    virtual Result<void> step() = 0;
    /// Pairs of shapes that the solver holds apart now.
    [[nodiscard]] virtual std::size_t contacts() const = 0;
    /// Appends the centre of mass of each dynamic body, metres, in the order of the scene.
    virtual void read_centres(std::vector<Vec3d>& out) const = 0;
    /// A number that any difference in the state changes; nullopt when the engine has none.
    [[nodiscard]] virtual std::optional<std::uint64_t> hash() const { return std::nullopt; }
    /// Threads that it uses.
    [[nodiscard]] virtual int threads() const { return 1; }
    /// How it is set, in a few words for tables.
    [[nodiscard]] virtual std::string settings() const = 0;
};

/// One engine that can be measured.
struct EngineInfo {
    std::string_view name;
    /// Unsupported when the scene has what the engine or its adapter has not.
    Result<std::unique_ptr<Engine>> (*make)(const scene::Scene& scene, const EngineOptions& options);
};

/// THE list of engines of this build: Fase first, then each peer that was found.
[[nodiscard]] std::span<const EngineInfo> engines();

}  // namespace fase::bench
