#pragma once
/// Decodes the raw bytes of a block into frames, sequentially.
#include <cstdint>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/record/frame.hpp"
#include "fase/record/recording/bytes.hpp"
#include "fase/record/recording/pose_code.hpp"
#include "fase/record/tables.hpp"

namespace fase::record {

/// Reads the frames of a block in order. It checks every number: any bytes give frames or an Error. The tables must
/// outlive the reader.
class BlockReader {
public:
    /// Creates a reader before the first frame. Error Format if the head of the block is invalid.
    static Result<BlockReader> open(std::vector<std::byte> raw, const Tables& tables);
    [[nodiscard]] std::uint64_t first_frame() const { return first_frame_; }
    [[nodiscard]] std::uint32_t frames() const { return frames_; }
    /// Returns the number of frames read so far.
    [[nodiscard]] std::uint32_t frames_read() const { return frames_read_; }
    /// Reads the next frame and replaces `frame`; reuses its memory. Error Format for an invalid frame, or past the
    /// last one; after an error the reader is unusable.
    /// @param bodies false: leaves frame.bodies empty, which is faster for frames that are only skipped.
    Result<void> next(Frame& frame, bool bodies = true);

private:
    struct Row {
        PoseCode code;
        std::array<std::int64_t, 3> step{};
        std::array<int, 3> rotation_step{};
        std::uint32_t moved_in = 0;    ///< the frame of the block, from 1, in which the steps were made
        std::uint32_t changed_in = 0;  ///< the frame of the block, from 1, that added, jumped or moved it
        std::uint32_t island = 0;
        std::uint8_t flags = 0;
        bool present = false;
    };
    BlockReader(std::vector<std::byte> raw, const Tables& tables) : raw_(std::move(raw)), tables_(&tables) {}
    /// Reads n and a list of n rows; fails unless each of them is present (or absent).
    bool read_rows(ByteReader& in, std::size_t min_bytes, bool present);
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
    std::uint32_t frames_ = 0, frames_read_ = 0;
    std::size_t offset_ = 0;
    std::vector<Row> rows_;
    std::vector<std::uint32_t> list_;  ///< the rows of the list that is being read
    std::vector<Vec3d> points_;
    std::vector<std::uint16_t> words_;
};

}  // namespace fase::record
