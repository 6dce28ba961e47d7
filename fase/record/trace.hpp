#pragma once
/// Traces of boxes, AABT: what a broad phase is given frame by frame, as a file.
///
/// Little-endian: "AABT", u32 version (1), u32 boxes, u32 frames, a flag byte a box, zeros up to a multiple of 4, then
/// for each frame and box six floats: least x, y, z, largest x, y, z. Metres.
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/geometry/aabb.hpp"
#include "fase/record/recording/bytes.hpp"
#include "fase/record/recording/input_file.hpp"
#include "fase/record/recording/output_file.hpp"

namespace fase::record {

inline constexpr std::string_view trace_magic = "AABT";
inline constexpr std::uint32_t trace_version = 1;

/// What a trace says of a box for all its frames. Both may be set; then static counts.
enum TraceFlag : std::uint8_t {
    trace_static = 1,  ///< has the same box in each frame; two of them are no pair
    trace_asleep = 2,  ///< rests from the first frame on, until its box changes
};

/// Reads a trace frame by frame and judges each number that it hands out: no NaN, no least above its largest, no static
/// box that moves. Infinite boxes of half-spaces are good. Errors are Format and name file, byte, frame and body.
class TraceReader {
public:
    /// Reads head and flags. Io when it cannot be opened; Format for another kind of file, another version, no box, no
    /// frame, unknown flags, and counts that do not fit the file's size (judged before any memory is taken for them).
    static Result<TraceReader> open(const std::string& name);

    /// Fills `out` with the boxes of the next frame, by body; false, and `out` empty, behind the last one.
    Result<bool> next(std::vector<Aabb>& out);
    /// The next frame is the first again.
    void rewind() { frame_ = 0; }

    /// TraceFlag bits, by body.
    [[nodiscard]] std::span<const std::uint8_t> flags() const { return flags_; }
    [[nodiscard]] std::size_t boxes() const { return flags_.size(); }
    [[nodiscard]] std::uint32_t frames() const { return frames_; }
    /// Of the file.
    [[nodiscard]] std::uint64_t bytes() const { return file_.size(); }
    [[nodiscard]] const std::string& path() const { return file_.path(); }

private:
    explicit TraceReader(InputFile file) : file_(std::move(file)) {}
    Result<void> read_head();
    [[nodiscard]] Error broken(std::uint64_t offset, std::string problem, std::string remedy = {}) const;
    [[nodiscard]] Error broken_body(std::uint32_t body, std::size_t number, const std::string& problem) const;
    [[nodiscard]] std::uint64_t offset_of(std::uint32_t frame, std::uint32_t body) const;

    InputFile file_;
    std::uint32_t frames_ = 0, frame_ = 0;  // frame_: the one to be read next
    std::uint64_t head_bytes_ = 0;
    std::vector<std::uint8_t> flags_;
    std::vector<Aabb> first_static_;  // of the static bodies in their order, from the first frame
    std::vector<std::byte> block_;    // reused
};

/// Writes a trace under `NAME.part` and names it `NAME` when it is complete: flags and the number of frames are known
/// at the end only. Cut off before, it leaves a `NAME.part` that is refused, for it says that it holds no frame.
class TraceWriter {
public:
    /// BadArgument for no box; Io when `name` cannot be made or is a device or pipe; Busy as of OutputFile.
    static Result<TraceWriter> create(const std::string& name, std::size_t boxes);

    /// One more frame. BadArgument, and nothing is written, for another number of boxes or one that a reader would
    /// refuse; Io when it cannot be written: the frames so far can still be completed.
    Result<void> add_frame(std::span<const Aabb> boxes);
    /// Whether a body's box has changed since the first frame.
    [[nodiscard]] bool moved(std::size_t body) const { return moved_[body] != 0; }
    /// Writes flags and count and gives the file its name. BadArgument without a frame, for another number of flags,
    /// unknown ones, and static ones of bodies that moved.
    /// @param durable also forces it to the disk
    Result<void> finish(std::span<const std::uint8_t> flags, bool durable = false);
    /// Takes the unfinished file away.
    void discard() { file_.discard(); }

    [[nodiscard]] std::size_t boxes() const { return boxes_; }
    [[nodiscard]] std::uint32_t frames() const { return frames_; }
    /// Written so far.
    [[nodiscard]] std::uint64_t bytes() const { return file_.bytes(); }
    [[nodiscard]] const std::string& path() const { return file_.path(); }

private:
    TraceWriter(OutputFile file, std::size_t boxes) : file_(std::move(file)), boxes_(boxes) {}

    OutputFile file_;
    std::size_t boxes_;
    std::uint32_t frames_ = 0;
    std::vector<Aabb> first_;
    std::vector<std::uint8_t> moved_;  // by body
    ByteWriter frame_bytes_;           // reused
};

}  // namespace fase::record
