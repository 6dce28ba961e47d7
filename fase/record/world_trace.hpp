#pragma once
/// Records the boxes of a world's colliders as a trace.
#include <string>
#include <vector>

#include "fase/record/trace.hpp"
#include "fase/world/world.hpp"

namespace fase::record {

/// Writes the exact boxes of the colliders that a world has in the beginning, frame after frame: what a broad phase
/// without margins would be given. At the end those of static bodies are flagged static, those of bodies that rested in
/// all frames asleep.
class WorldTrace {
public:
    /// Io and Busy as of TraceWriter; BadArgument for a world without colliders.
    static Result<WorldTrace> create(const std::string& name, const World& world);
    /// The world as it is now. BadHandle when one of the colliders is gone, Io when it cannot be written; the frames so
    /// far can still be completed.
    Result<void> add_frame(const World& world);
    /// Writes the flags and gives the file its name.
    Result<void> finish();

    [[nodiscard]] const TraceWriter& writer() const { return writer_; }

private:
    struct Tracked {
        BodyId body;
        ColliderId collider;
        bool is_static = true, rests = true;  ///< in all frames so far
    };
    explicit WorldTrace(TraceWriter writer) : writer_(std::move(writer)) {}
    TraceWriter writer_;
    std::vector<Tracked> tracked_;
    std::vector<Aabb> boxes_;
};

}  // namespace fase::record
