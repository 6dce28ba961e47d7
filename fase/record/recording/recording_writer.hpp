#pragma once
/// Writes a recording from plain rows and frames; knows nothing of worlds.
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
#include "fase/record/recording/tables.hpp"

namespace fase::record {

/// How a recording is written.
struct RecorderOptions {
    double flush_seconds = 1;         ///< a block is written at the latest so long after its first frame; 0: each frame
    std::uint32_t flush_frames = 64;  ///< … or when it holds so many frames: 1 to 64
    int level = 3;                    ///< of zstd: 1 quick, 19 small
    bool durable = false;             ///< each block is forced to the disk, so that it survives a power cut too
    bool contacts = false;            ///< frames list all contact points
    double quanta_per_metre = default_quanta_per_metre;  ///< positions are kept to half of its inverse: 0.25 mm
};

/// Rows are numbered from 0 in the order they are added. Nothing is written before flush(), which add_frame() calls as
/// the options say: when the block is full, when its time is over, or when it would be before another frame that takes
/// as long as the last. After an error of the file every call gives that error again.
class RecordingWriter {
public:
    /// Makes `NAME.part` and writes the head. Errors: those of OutputFile::create(), BadArgument for options out of
    /// range.
    static Result<RecordingWriter> create(const std::string& name, Head head, const RecorderOptions& options = {});
    RecordingWriter(RecordingWriter&&) noexcept = default;
    RecordingWriter& operator=(RecordingWriter&&) noexcept = default;
    ~RecordingWriter() = default;

    // Rows: the number of the new row; Capacity when the table is full (2^21 rows), BadArgument when it names a row
    // that is not there.
    Result<std::uint32_t> add(const RecordedShape& shape) { return add_row(0, shape); }
    Result<std::uint32_t> add(const RecordedMesh& mesh) { return add_row(1, mesh); }
    Result<std::uint32_t> add(const RecordedBody& body) { return add_row(2, body); }
    Result<std::uint32_t> add(const RecordedCollider& collider);
    Result<std::uint32_t> add(const RecordedVisual& visual);
    /// The collider is gone from the next block on.
    Result<void> end_collider(std::uint32_t row);

    /// All rows that the frame names must have been added. Errors: BadArgument as of BlockWriter::add(), then nothing
    /// changed; Io with the frames and bytes that were written, and the file so far opens.
    Result<void> add_frame(const Frame& frame);
    /// Writes what is held back.
    Result<void> flush();
    /// Flushes, writes the index, gives the file its name. Nothing can be added afterwards.
    Result<void> finish();

    /// Frames added; frames among them that are in the file; bytes in the file.
    [[nodiscard]] std::uint64_t frames() const { return frames_flushed_ + block_.frames(); }
    [[nodiscard]] std::uint64_t frames_flushed() const { return frames_flushed_; }
    [[nodiscard]] std::uint64_t bytes() const { return file_.bytes(); }
    /// Whether the next frame begins a block.
    [[nodiscard]] bool at_block_begin() const { return block_.frames() == 0; }
    /// Where the file is now: `NAME.part`, then `NAME`.
    [[nodiscard]] const std::string& path() const { return file_.path(); }
    [[nodiscard]] const FrameCost& cost() const { return block_.cost(); }

private:
    using Clock = std::chrono::steady_clock;
    struct Rows {
        ByteWriter bytes;
        std::uint32_t count = 0;
    };
    struct Table {
        std::uint32_t rows = 0;     ///< in all
        std::vector<Rows> pending;  ///< a chunk each
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
    /// Remembers the error and tells how far the file came.
    Error failed(const Error& error);
    [[nodiscard]] bool time_is_over();

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
