#pragma once
/// Records the boxes of a world's colliders as a trace.
#include <cstdint>
#include <string>
#include <vector>

#include "fase/record/trace.hpp"
#include "fase/world/world.hpp"

namespace fase::record {

/// Writes the exact boxes of the colliders that a world has at the start, frame by frame: the input of a broad phase
/// without margins. finish() flags the boxes of static bodies as static, and those of bodies that rested in all frames
/// as asleep.
class WorldTrace {
public:
    /// Creates a trace. Errors: Io and Busy as in TraceWriter::create(); BadArgument for a world without colliders.
    static Result<WorldTrace> create(const std::string& name, const World& world);
    /// Appends the current state of the world. Errors: BadHandle if one of the colliders was removed; Io if the frame
    /// cannot be written. finish() then leaves the previous frames in `NAME.part`.
    Result<void> add_frame(const World& world);
    /// Writes the flags and renames the file to its final name. After a frame that could not be written: as
    /// TraceWriter::finish().
    Result<void> finish() { return writer_.finish(flags()); }
    /// Writes the flags and leaves the file as `NAME.part`; an older `NAME` stays as it was.
    Result<void> leave_part() { return writer_.leave_part(flags()); }

    [[nodiscard]] const TraceWriter& writer() const { return writer_; }

private:
    struct Tracked {
        BodyId body;
        ColliderId collider;
        bool is_static = true, rests = true;  ///< in all frames so far
    };
    explicit WorldTrace(TraceWriter writer) : writer_(std::move(writer)) {}
    [[nodiscard]] std::vector<std::uint8_t> flags() const;
    TraceWriter writer_;
    std::vector<Tracked> tracked_;
    std::vector<Aabb> boxes_;
};

}  // namespace fase::record
