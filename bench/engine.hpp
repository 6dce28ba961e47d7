#pragma once
/// The interface of an engine that `fase bench step` measures: load a scene, step it, read the positions.
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

/// How an engine steps. All other settings keep the engine's defaults.
struct EngineOptions {
    Settings settings;  ///< gravity, time step and sleep apply to every engine; the rest only to Fase
    int threads = 1;    ///< for engines with threads
};

/// A world of one engine, built from a scene.
class Engine {
public:
    virtual ~Engine() = default;
    /// Steps once by the time step of the options.
    virtual Result<void> step() = 0;
    /// Pairs of shapes in contact after the last step.
    [[nodiscard]] virtual std::size_t contacts() const = 0;
    /// Appends the centre of mass of each dynamic body, in metres, in scene order.
    virtual void read_centres(std::vector<Vec3d>& out) const = 0;
    /// A hash of the full state; nullopt: the engine has none.
    [[nodiscard]] virtual std::optional<std::uint64_t> hash() const { return std::nullopt; }
    /// Threads in use.
    [[nodiscard]] virtual int threads() const { return 1; }
    /// The settings in a few words, for tables.
    [[nodiscard]] virtual std::string settings() const = 0;
};

/// One engine that can be measured.
struct EngineInfo {
    std::string_view name;
    /// Creates the world. Error Unsupported: the scene uses a feature that the engine or its adapter lacks.
    Result<std::unique_ptr<Engine>> (*make)(const scene::Scene& scene, const EngineOptions& options);
};

/// THE list of engines in this build: Fase first, then each peer found.
[[nodiscard]] std::span<const EngineInfo> engines();

}  // namespace fase::bench
