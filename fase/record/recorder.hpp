#pragma once
/// Records a world: create once, add a frame after every step, finish at the end.
#include <memory>
#include <string>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/record/recording_writer.hpp"
#include "fase/world/world.hpp"

namespace fase::record {

/// One mesh of a body, for drawing.
struct Visual {
    std::uint32_t mesh = 0;  ///< index in RecordingHead::meshes
    LocalPose pose;          ///< of the mesh in the body
    Colour colour;
};
/// The name and appearance of a body. A body without one is drawn as its shapes, in colours that the viewer selects.
struct BodyLook {
    BodyId body;
    std::string name;
    Colour colour;
    std::vector<Visual> visuals;  ///< drawn instead of the shapes; may be empty
};
/// Information for the recording that the world does not contain.
struct RecordingHead {
    std::string title;
    std::vector<RecordedMesh> meshes;
    std::vector<BodyLook> looks;  ///< in any order; may refer to bodies that are added later
};

/// Reads a world through its public functions and writes `NAME.part`, which finish() renames to `NAME`. If the program
/// is killed, the file opens up to its last flushed block. Bodies may be added and removed between frames; colliders
/// that are added to or removed from an existing body take effect from the next block on. One thread at a time.
class Recorder {
public:
    /// Writes head and tables for the current state of the world. The first add_frame() adds frame 0. Errors: Io if the
    /// file cannot be written; Busy if another program records to that name; BadArgument for options out of range or a
    /// visual with a missing mesh.
    static Result<Recorder> create(const std::string& name, const World& world, const RecordingHead& head = {},
                                   const RecorderOptions& options = {});
    Recorder(Recorder&&) noexcept;
    Recorder& operator=(Recorder&&) noexcept;
    /// Calls finish() if necessary; ignores errors.
    ~Recorder();

    /// Adds the current state of the world, with the report and events of its last step. It must be the world of
    /// create(). Errors: Io, with the frames and bytes written so far (the file opens up to there); Capacity if more
    /// than 2^21 bodies were ever added.
    Result<void> add_frame(const World& world);
    /// Writes all pending frames.
    Result<void> flush();
    /// Writes the rest and the index and renames the file. Later calls do nothing.
    Result<void> finish();
    /// Returns the writer, for its counts and its path.
    [[nodiscard]] const RecordingWriter& writer() const;

private:
    struct State;
    explicit Recorder(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace fase::record
