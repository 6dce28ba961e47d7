#pragma once
/// Encodes frames into the raw bytes of a block: a key frame, then only changes.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/record/frame.hpp"
#include "fase/record/recording/bytes.hpp"
#include "fase/record/recording/pose_code.hpp"
#include "fase/record/tables.hpp"

namespace fase::record {

/// The size of the moves in a recording so far.
struct FrameCost {
    std::uint64_t moves = 0;       ///< bodies written as moved, over all frames
    std::uint64_t move_bytes = 0;  ///< their bytes before compression, including row lists
};

/// Encodes frames; the caller takes the bytes when the block is full. Memory: a small state per row, plus the block.
class BlockWriter {
public:
    explicit BlockWriter(const Head& head)
        : quanta_per_metre_(head.quanta_per_metre),
          contacts_(head.contacts),
          stages_(head.stage_names.size()),
          counters_(head.counter_names.size()) {}

    /// Appends a frame. Error BadArgument, without any change, if a position is not finite or farther than 1e9 m from
    /// the origin, a rotation is not a unit quaternion, rows are not ascending, or a list has another length than the
    /// head says.
    Result<void> add(const Frame& frame);
    /// Returns the number of frames since take().
    [[nodiscard]] std::uint32_t frames() const { return frames_; }
    /// Returns the number of bytes since take().
    [[nodiscard]] std::size_t size() const { return out_.size(); }
    /// Returns the raw block and starts a new one. The bytes are valid until the next add().
    [[nodiscard]] std::span<const std::byte> take();
    [[nodiscard]] const FrameCost& cost() const { return cost_; }

private:
    struct Row {
        PoseCode code;
        std::array<std::int64_t, 3> step{};
        std::array<int, 3> rotation_step{};
        std::uint32_t moved_in = 0;  ///< the frame of the block, from 1, in which the steps were made
        std::uint32_t island = 0;
        std::uint8_t flags = 0;
    };
    struct Change {
        std::uint32_t row;
        PoseCode code;
    };
    struct Move {
        std::uint32_t row;
        std::array<std::uint16_t, 6> residuals;
    };
    [[nodiscard]] Result<void> check(const Frame& frame) const;
    void classify_changes(const Frame& frame, bool key);
    void add_change(std::uint32_t row, const PoseCode& code);
    void put_rows(std::span<const std::uint32_t> rows);
    void put_positions(std::span<const Change> changes);
    void put_rotations(std::span<const Change> changes);
    void put_pairs(std::span<const ColliderPair> pairs);
    void put_events(const Frame& frame);
    void put_contacts(std::span<const ContactFrame> contacts);

    double quanta_per_metre_;
    bool contacts_;
    std::size_t stages_, counters_;
    std::uint32_t frames_ = 0;
    std::uint64_t first_frame_ = 0;
    ByteWriter out_, taken_;
    FrameCost cost_;
    std::vector<Row> rows_;
    std::vector<std::uint32_t> present_, next_present_;
    // The changes of the current frame.
    std::vector<std::uint32_t> removed_, flags_changed_, island_changed_, scratch_rows_;
    std::vector<Change> added_, jumped_;
    std::vector<Move> moved_;
};

}  // namespace fase::record
