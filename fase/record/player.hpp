#pragma once
/// Opens a recording, whole or broken, and gives any of its frames.
#include <cstdint>
#include <memory>
#include <string>

#include "fase/core/result.hpp"
#include "fase/record/frame.hpp"
#include "fase/record/recording/tables.hpp"

namespace fase::record {

/// A recording, read as it is asked for; holds its tables and one block. Any bytes are safe: every length is checked
/// before it is believed. Not thread-safe.
class Player {
public:
    /// Opens `name`; where there is none, `name.part` of a recording that was never finished. Reads the file once from
    /// end to end and checks every chunk. Format (with the byte) when not even the head is whole, Io when it cannot be
    /// read. Damage after the head is no error: see lost().
    static Result<Player> open(const std::string& name);
    Player(Player&&) noexcept;
    Player& operator=(Player&&) noexcept;
    ~Player();

    [[nodiscard]] const Head& head() const;
    /// All rows, those that came during the run included.
    [[nodiscard]] const Tables& tables() const;
    /// Frames that can be read: 0 to frames() - 1.
    [[nodiscard]] std::uint64_t frames() const;
    /// The file that was opened.
    [[nodiscard]] const std::string& path() const;
    /// Whether the recording was finished and is whole.
    [[nodiscard]] bool complete() const;
    /// One line on what is missing: "" when nothing is.
    [[nodiscard]] const std::string& lost() const;
    /// Bytes of the file, and those of them that are good, from its start.
    [[nodiscard]] std::uint64_t file_bytes() const;
    [[nodiscard]] std::uint64_t good_bytes() const;

    /// Replaces `frame`. Quick when frames are asked for one after the other, else as slow as a block. OutOfRange: no
    /// such frame; Format: what is in the block makes no sense, or the file was changed; Io.
    Result<void> read(std::uint64_t number, Frame& frame);
    Result<Frame> frame(std::uint64_t number);

private:
    struct State;
    explicit Player(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace fase::record
