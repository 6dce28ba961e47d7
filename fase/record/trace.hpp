#pragma once
/// Box traces (AABT): files with the input of a broad phase, frame by frame.
///
/// Format, little-endian: "AABT", u32 version (1), u32 boxes, u32 frames, one flag byte per box, zeros up to a multiple
/// of 4, then for each frame and box six floats: lower x, y, z, upper x, y, z. Metres.
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fase/core/motion_state.hpp"
#include "fase/core/result.hpp"
#include "fase/geometry/aabb.hpp"
#include "fase/record/recording/bytes.hpp"
#include "fase/record/recording/input_file.hpp"
#include "fase/record/recording/output_file.hpp"

namespace fase::record {

inline constexpr std::string_view trace_magic = "AABT";
inline constexpr std::uint32_t trace_version = 1;

/// Flags of a box for all frames. If both are set, static takes precedence.
enum TraceFlag : std::uint8_t {
    trace_static = 1,  ///< the same box in every frame; two static boxes are no pair
    trace_asleep = 2,  ///< asleep from the first frame until its box changes
};

/// Reads a trace frame by frame and validates every number: no NaN, no lower bound above the upper bound, no static box
/// that moves. Infinite boxes of half-spaces are valid. Errors are Format and name file, byte, frame and body.
class TraceReader {
public:
    /// Reads head and flags. Errors: Io if the file cannot be opened; Format for another kind of file or version, no
    /// box, no frame, unknown flags, and counts that contradict the file size (checked before any memory is allocated).
    static Result<TraceReader> open(const std::string& name);

    /// Replaces `out` by the boxes of the next frame, by body. Returns false, with `out` empty, after the last frame.
    Result<bool> next(std::vector<Aabb>& out);
    /// Restarts at the first frame.
    void rewind() { frame_ = 0; }

    /// Returns the TraceFlag bits of each body.
    [[nodiscard]] std::span<const std::uint8_t> flags() const { return flags_; }
    /// Returns the motion state of each body that its flags give.
    [[nodiscard]] std::vector<MotionState> motion_states() const;
    [[nodiscard]] std::size_t boxes() const { return flags_.size(); }
    [[nodiscard]] std::uint32_t frames() const { return frames_; }
    /// Returns the size of the file.
    [[nodiscard]] std::uint64_t bytes() const { return file_.size(); }
    [[nodiscard]] const std::string& path() const { return file_.path(); }

private:
    explicit TraceReader(InputFile file) : file_(std::move(file)) {}
    Result<void> read_head();
    [[nodiscard]] Error format_error(std::uint64_t offset, std::string problem, std::string remedy = {}) const;
    [[nodiscard]] Error body_error(std::uint32_t body, std::size_t number, const std::string& problem) const;
    [[nodiscard]] std::uint64_t offset_of(std::uint32_t frame, std::uint32_t body) const;

    InputFile file_;
    std::uint32_t frames_ = 0, frame_ = 0;  // frame_: the next one to read
    std::uint64_t head_bytes_ = 0;
    std::vector<std::uint8_t> flags_;
    std::vector<Aabb> first_static_;  // boxes of the static bodies, in order, in the first frame
    std::vector<std::byte> block_;    // reused
};

/// Writes a trace as `NAME.part` and renames it to `NAME` when it is complete, because flags and frame count are known
/// only at the end. An aborted run leaves a `NAME.part` that readers reject, because its frame count is 0. An older
/// `NAME` stays as it was until then.
class TraceWriter {
public:
    /// Creates a trace. Errors: BadArgument for no box; Io if `name` cannot be created or is a device or pipe; Busy as
    /// in OutputFile::create().
    static Result<TraceWriter> create(const std::string& name, std::size_t boxes);

    /// Appends a frame. Errors: BadArgument, without writing, for a wrong number of boxes or a box that a reader would
    /// reject; Io if it cannot be written: finish() then leaves the previous frames in `NAME.part`.
    Result<void> add_frame(std::span<const Aabb> boxes);
    /// Returns whether a body's box has changed since the first frame.
    [[nodiscard]] bool moved(std::size_t body) const { return moved_[body] != 0; }
    /// Writes flags and frame count and renames the file to its final name. Error BadArgument for no frame, a wrong
    /// number of flags, unknown flags, and static flags of bodies that moved. After a frame that could not be written:
    /// calls leave_part() and returns the error of that frame.
    /// @param durable also flushes it to the disk
    Result<void> finish(std::span<const std::uint8_t> flags, bool durable = false);
    /// Writes flags and frame count and leaves the file as `NAME.part`, which readers open. Removes it if it has no
    /// frame. Errors: those of finish().
    Result<void> leave_part(std::span<const std::uint8_t> flags);
    /// Removes the unfinished file.
    void discard() { file_.discard(); }

    [[nodiscard]] std::size_t boxes() const { return boxes_; }
    [[nodiscard]] std::uint32_t frames() const { return frames_; }
    /// Returns the number of bytes written.
    [[nodiscard]] std::uint64_t bytes() const { return file_.bytes(); }
    [[nodiscard]] const std::string& path() const { return file_.path(); }

private:
    TraceWriter(OutputFile file, std::size_t boxes) : file_(std::move(file)), boxes_(boxes) {}
    Result<void> write_head(std::span<const std::uint8_t> flags);

    OutputFile file_;
    std::size_t boxes_;
    std::uint32_t frames_ = 0;
    std::vector<Aabb> first_;
    std::vector<std::uint8_t> moved_;  // by body
    ByteWriter frame_bytes_;           // reused
    Result<void> state_;               // the error of the frame that could not be written
};

}  // namespace fase::record
