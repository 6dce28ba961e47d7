#pragma once
/// Records a world: made once, told after every step, finished at the end.
#include <memory>
#include <string>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/record/recording/recording_writer.hpp"
#include "fase/world/world.hpp"

namespace fase::record {

/// One mesh of a body for the picture.
struct Visual {
    std::uint32_t mesh = 0;  ///< index in RecordingHead::meshes
    LocalPose pose;          ///< of the mesh in the body
    Colour colour;
};
/// How a body is called and looks. Bodies without one are drawn by their shapes, in colours that the viewer chooses.
struct BodyLook {
    BodyId body;
    std::string name;
    Colour colour;
    std::vector<Visual> visuals;  ///< drawn instead of the shapes; may be empty
};
/// What a world does not know of itself.
struct RecordingHead {
    std::string title;
    std::vector<RecordedMesh> meshes;
    std::vector<BodyLook> looks;  ///< in any order; may name bodies that are made later
};

/// Reads a world through its public functions and writes `NAME.part`, which finish() renames to `NAME`. Killed at any
/// moment, it leaves a file that opens up to its last flushed block. Bodies may come and go between frames; colliders
/// that were put on or taken off a living body show from the next block on. One thread at a time.
class Recorder {
public:
    /// Writes head and tables of the world as it is; frame 0 is what the first add_frame() finds.
    /// Io: cannot write there; Busy: another program records to that name; BadArgument: options out of range, a visual
    /// of a mesh that is not there.
    static Result<Recorder> create(const std::string& name, const World& world, const RecordingHead& head = {},
                                   const RecorderOptions& options = {});
    Recorder(Recorder&&) noexcept;
    Recorder& operator=(Recorder&&) noexcept;
    /// Finishes, if that was not done; errors are lost then.
    ~Recorder();

    /// The world as it is now, with the report and events of its last step. It must be the world of create(). Errors:
    /// Io, with frames and bytes written so far (they open); Capacity, when more than 2^21 bodies ever lived.
    Result<void> add_frame(const World& world);
    /// Writes what is held back.
    Result<void> flush();
    /// Writes the rest and the index, renames. Later calls do nothing.
    Result<void> finish();
    /// What was written so far.
    [[nodiscard]] const RecordingWriter& writer() const;

private:
    struct State;
    explicit Recorder(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace fase::record
