#pragma once
/// Opens a recording, complete or damaged, and reads any of its frames.
#include <cstdint>
#include <memory>
#include <string>

#include "fase/core/result.hpp"
#include "fase/record/frame.hpp"
#include "fase/record/tables.hpp"

namespace fase::record {

/// An open recording. It keeps the tables and one block in memory and reads other blocks on demand. Any bytes are safe:
/// every length is checked before use. Not thread-safe.
class Player {
public:
    /// Opens `name`, or `name.part` of an unfinished recording if `name` does not exist. Reads the file once from start
    /// to end and checks every chunk. Errors: Format, with the byte offset, if the head is incomplete or damaged; Io if
    /// it cannot be read. Damage after the head is not an error: see lost(). So a recording may have no frame: see
    /// check_has_frames().
    static Result<Player> open(const std::string& name);
    Player(Player&&) noexcept;
    Player& operator=(Player&&) noexcept;
    ~Player();

    [[nodiscard]] const Head& head() const;
    /// Returns all rows, including those added during the run.
    [[nodiscard]] const Tables& tables() const;
    /// Returns the number of readable frames: 0 to frames() - 1.
    [[nodiscard]] std::uint64_t frames() const;
    /// Format, with the file's name, if no frame is readable: the file was cut before the end of its first frames.
    [[nodiscard]] Result<void> check_has_frames() const;
    /// Returns the path of the opened file.
    [[nodiscard]] const std::string& path() const;
    /// Returns whether the recording was finished and is undamaged.
    [[nodiscard]] bool complete() const;
    /// Describes in one line what is missing; "" if nothing is.
    [[nodiscard]] const std::string& lost() const;
    // The size of the file in bytes, and of its undamaged part from the start.
    [[nodiscard]] std::uint64_t file_bytes() const;
    [[nodiscard]] std::uint64_t good_bytes() const;

    /// Reads a frame and replaces `frame`. Fast for frames in sequence; otherwise decodes up to one block. Errors:
    /// OutOfRange for a frame that does not exist; Format if the block is invalid or the file was changed; Io.
    Result<void> read(std::uint64_t number, Frame& frame);
    Result<Frame> frame(std::uint64_t number);

private:
    struct State;
    explicit Player(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace fase::record
