#pragma once
/// The raw bytes of a block into frames, one after the other.
#include <cstdint>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/record/frame.hpp"
#include "fase/record/recording/bytes.hpp"
#include "fase/record/recording/pose_code.hpp"
#include "fase/record/recording/tables.hpp"

namespace fase::record {

/// Walks a block. Every number in it is checked: bytes of any content give frames or an Error. The tables must outlive
/// it.
class BlockReader {
public:
    /// Begins before the first frame. Format when the block's own head makes no sense.
    static Result<BlockReader> open(std::vector<std::byte> raw, const Tables& tables);
    [[nodiscard]] std::uint64_t first_frame() const { return first_frame_; }
    [[nodiscard]] std::uint32_t frames() const { return frames_; }
    /// Frames read so far.
    [[nodiscard]] std::uint32_t at() const { return at_; }
    /// Reads the next frame, if there is one; `frame` is replaced, its memory used again. After an Error, only open()
    /// helps.
    /// @param bodies false: leaves frame.bodies empty (quicker on the way to another frame).
    Result<void> next(Frame& frame, bool bodies = true);

private:
    struct Row {
        PoseCode code;
        std::array<std::int64_t, 3> step{};
        std::array<int, 3> turn{};
        std::uint32_t moved_in = 0;    ///< frame of the block, from 1
        std::uint32_t changed_in = 0;  ///< added, jumped or moved in this frame of the block
        std::uint32_t island = 0;
        std::uint8_t flags = 0;
        bool alive = false;
    };
    BlockReader(std::vector<std::byte> raw, const Tables& tables) : raw_(std::move(raw)), tables_(&tables) {}
    /// Reads n and a list of n rows that are alive (or not) before it.
    bool read_rows(ByteReader& in, std::size_t min_bytes, bool alive);
    bool read_added(ByteReader& in);
    bool read_positions(ByteReader& in);
    bool read_rotations(ByteReader& in);
    bool read_moves(ByteReader& in);
    bool read_bodies(ByteReader& in);
    template <class Pair> bool read_pairs(ByteReader& in, std::size_t min_bytes, std::vector<Pair>& pairs);
    bool read_points(ByteReader& in, std::size_t count);
    bool read_hits(ByteReader& in, std::vector<HitFrame>& hits);
    bool read_contacts(ByteReader& in, std::vector<ContactFrame>& contacts);

    std::vector<std::byte> raw_;
    const Tables* tables_;
    std::uint64_t first_frame_ = 0;
    std::uint32_t frames_ = 0, at_ = 0;
    std::size_t offset_ = 0;
    std::vector<Row> rows_;
    std::vector<std::uint32_t> list_;  ///< rows of the list at hand
    std::vector<Vec3d> points_;
    std::vector<std::uint16_t> words_;
};

}  // namespace fase::record
