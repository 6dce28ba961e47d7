#pragma once
/// Writes a recording from plain rows and frames; independent of World.
#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/record/format.hpp"
#include "fase/record/frame.hpp"
#include "fase/record/recording/block_writer.hpp"
#include "fase/record/recording/chunk_packer.hpp"
#include "fase/record/recording/output_file.hpp"
#include "fase/record/tables.hpp"

namespace fase::record {

/// Options for writing a recording.
struct RecorderOptions {
    double flush_seconds = 1;         ///< longest time from a block's first frame until it is written; 0: every frame
    std::uint32_t flush_frames = 64;  ///< frames per block at most: 1 to 64
    int level = 3;                    ///< zstd level: 1 fast, 19 small
    bool durable = false;             ///< flushes each block to the disk, so that it survives a power failure
    bool contacts = false;            ///< frames list all contact points
    double quanta_per_metre = default_quanta_per_metre;  ///< position error is at most half of 1 / this: 0.25 mm
};

/// Writes rows and frames. Each table numbers its rows from 0 in the order they are added. Only flush() writes to the
/// file. add_frame() calls it when the block is full, when flush_seconds have passed, or when they would pass before
/// the next frame, if that takes as long as the last one. After a file error, every call returns that error.
class RecordingWriter {
public:
    /// Creates `NAME.part` and writes the head. Errors: those of OutputFile::create(); BadArgument for options out of
    /// range.
    static Result<RecordingWriter> create(const std::string& name, Head head, const RecorderOptions& options = {});
    RecordingWriter(RecordingWriter&&) noexcept = default;
    RecordingWriter& operator=(RecordingWriter&&) noexcept = default;
    ~RecordingWriter() = default;

    // Each add() returns the number of the new row. Errors: Capacity if the table is full (2^21 rows); BadArgument if
    // it refers to a row that was not added.
    Result<std::uint32_t> add(const RecordedShape& shape) { return add_row(0, shape); }
    Result<std::uint32_t> add(const RecordedMesh& mesh) { return add_row(1, mesh); }
    Result<std::uint32_t> add(const RecordedBody& body) { return add_row(2, body); }
    Result<std::uint32_t> add(const RecordedCollider& collider);
    Result<std::uint32_t> add(const RecordedVisual& visual);
    /// Ends a collider: it is absent from the next block on.
    Result<void> end_collider(std::uint32_t row);

    /// Adds a frame. All rows that it refers to must have been added. Errors: BadArgument as in BlockWriter::add(),
    /// without any change; Io, with the number of frames and bytes written: the file opens up to there.
    Result<void> add_frame(const Frame& frame);
    /// Writes all pending rows and frames.
    Result<void> flush();
    /// Flushes, writes the index and renames the file to its final name. Nothing can be added afterwards.
    Result<void> finish();

    // The number of frames added, of frames written to the file, and of bytes in the file.
    [[nodiscard]] std::uint64_t frames() const { return frames_flushed_ + block_.frames(); }
    [[nodiscard]] std::uint64_t frames_flushed() const { return frames_flushed_; }
    [[nodiscard]] std::uint64_t bytes() const { return file_.bytes(); }
    /// Returns whether the next frame begins a block.
    [[nodiscard]] bool at_block_begin() const { return block_.frames() == 0; }
    /// Returns the current path: `NAME.part`, then `NAME`.
    [[nodiscard]] const std::string& path() const { return file_.path(); }
    [[nodiscard]] const FrameCost& cost() const { return block_.cost(); }

private:
    using Clock = std::chrono::steady_clock;
    struct Rows {
        ByteWriter bytes;
        std::uint32_t count = 0;
    };
    struct Table {
        std::uint32_t rows = 0;     ///< all rows so far
        std::vector<Rows> pending;  ///< one chunk each
    };
    struct IndexEntry {
        ChunkType type;
        std::uint64_t offset, first_frame;
        std::uint32_t frames;
    };
    RecordingWriter(OutputFile file, const Head& head, const RecorderOptions& options);
    template <class Row> Result<std::uint32_t> add_row(std::size_t table, const Row& row);
    Result<void> pack(ChunkType type, std::span<const std::byte> raw, std::uint64_t first_frame, std::uint32_t frames);
    Result<void> pack_tables();
    Result<void> pack_index();
    Result<void> write_packed();
    /// Stores the error, with the number of frames and bytes written, and returns it.
    Error failed(const Error& error);
    [[nodiscard]] bool is_flush_due();

    OutputFile file_;
    RecorderOptions options_;
    ChunkPacker packer_;
    BlockWriter block_;
    std::array<Table, 6> tables_;
    std::vector<std::byte> packed_;
    std::vector<IndexEntry> index_;
    std::uint64_t frames_flushed_ = 0;
    Clock::time_point block_begin_{}, last_frame_{};
    Result<void> state_;
    bool finished_ = false;
};

}  // namespace fase::record
