/// Packs rows and frames into chunks and writes them.
#include "fase/record/recording_writer.hpp"

#include <utility>

#include "fase/record/format.hpp"
#include "fase/record/recording/crc32.hpp"

namespace fase::record {
namespace {

constexpr std::array<ChunkType, 6> table_types{shapes_chunk,    meshes_chunk,  bodies_chunk,
                                               colliders_chunk, visuals_chunk, collider_ends_chunk};
constexpr std::size_t full_table_bytes = std::size_t(4) << 20;

std::vector<std::byte> file_head() {
    ByteWriter out;
    out.put_letters(file_magic);
    out.put(format_version);
    out.put(crc32(out.bytes()));
    return {out.bytes().begin(), out.bytes().end()};
}

}  // namespace

Result<RecordingWriter> RecordingWriter::create(const std::string& name, Head head, const RecorderOptions& options) {
    const auto refuse = [](const char* field, const char* problem) {
        return Error{Status::BadArgument, field, problem, {}};
    };
    if (!(options.flush_seconds >= 0)) return refuse("RecorderOptions.flush_seconds", "expected 0 or more");
    if (options.flush_frames < 1 || options.flush_frames > max_block_frames) {
        return refuse("RecorderOptions.flush_frames", "expected 1 to 64");
    }
    if (!(options.quanta_per_metre >= 1e-3 && options.quanta_per_metre <= 1e6)) {
        return refuse("RecorderOptions.quanta_per_metre", "expected 0.001 to 1e6");
    }
    head.quanta_per_metre = options.quanta_per_metre;
    head.contacts = options.contacts;
    Result<OutputFile> file = OutputFile::create(name);
    if (!file) return file.error();
    RecordingWriter writer(std::move(*file), head, options);
    writer.packed_ = file_head();
    ByteWriter raw;
    write(raw, head);
    if (Result<void> packed = writer.pack(head_chunk, raw.bytes(), 0, 0); !packed) return packed.error();
    if (Result<void> written = writer.write_packed(); !written) return written.error();
    return writer;
}

RecordingWriter::RecordingWriter(OutputFile file, const Head& head, const RecorderOptions& options)
    : file_(std::move(file)), options_(options), packer_(options.level), block_(head) {}

template <class Row> Result<std::uint32_t> RecordingWriter::add_row(std::size_t table, const Row& row) {
    Table& rows = tables_[table];
    if (rows.rows >= max_rows) {
        return Error{Status::Capacity, "recording", "found a full table; expected at most 2097152 rows", {}};
    }
    if (rows.pending.empty() || rows.pending.back().bytes.size() > full_table_bytes) {
        rows.pending.emplace_back();
        rows.pending.back().bytes.put(std::uint32_t{0});  // count, set by pack_tables()
    }
    write(rows.pending.back().bytes, row);
    ++rows.pending.back().count;
    return rows.rows++;
}
template Result<std::uint32_t> RecordingWriter::add_row(std::size_t, const RecordedShape&);
template Result<std::uint32_t> RecordingWriter::add_row(std::size_t, const RecordedMesh&);
template Result<std::uint32_t> RecordingWriter::add_row(std::size_t, const RecordedBody&);

Result<std::uint32_t> RecordingWriter::add(const RecordedCollider& collider) {
    if (collider.body >= tables_[2].rows || collider.shape >= tables_[0].rows) {
        return Error{Status::BadArgument, "RecordedCollider", "found a body or shape row that was not added", {}};
    }
    return add_row(3, collider);
}

Result<std::uint32_t> RecordingWriter::add(const RecordedVisual& visual) {
    if (visual.body >= tables_[2].rows || visual.mesh >= tables_[1].rows) {
        return Error{Status::BadArgument, "RecordedVisual", "found a body or mesh row that was not added", {}};
    }
    return add_row(4, visual);
}

Result<void> RecordingWriter::end_collider(std::uint32_t row) {
    if (row >= tables_[3].rows)
        return Error{Status::BadArgument, "end_collider", "found a collider row that was not added", {}};
    const Result<std::uint32_t> added = add_row(5, ColliderEnd{row, frames()});
    if (!added) return added.error();
    return {};
}

Error RecordingWriter::failed(const Error& error) {
    Error complete = error;
    complete.problem +=
        "; wrote " + std::to_string(frames_flushed_) + " frames, " + std::to_string(file_.bytes()) + " bytes";
    state_ = complete;
    return complete;
}

Result<void> RecordingWriter::pack(ChunkType type, std::span<const std::byte> raw, std::uint64_t first_frame,
                                   std::uint32_t frames) {
    const std::uint64_t offset = file_.bytes() + packed_.size();
    if (Result<void> packed = packer_.append(type, raw, packed_); !packed) return packed;
    index_.push_back({type, offset, first_frame, frames});
    return {};
}

Result<void> RecordingWriter::pack_tables() {
    for (std::size_t i = 0; i < tables_.size(); ++i) {
        for (Rows& rows : tables_[i].pending) {
            rows.bytes.set_u32(0, rows.count);
            if (Result<void> packed = pack(table_types[i], rows.bytes.bytes(), 0, 0); !packed) return packed;
        }
        tables_[i].pending.clear();
    }
    return {};
}

Result<void> RecordingWriter::write_packed() {
    if (Result<void> written = file_.append(packed_); !written) return failed(written.error());
    packed_.clear();
    if (options_.durable) {
        if (Result<void> synced = file_.sync(); !synced) return failed(synced.error());
    }
    return {};
}

Result<void> RecordingWriter::flush() {
    if (!state_) return state_;
    if (finished_) return Error{Status::Busy, path(), "the recording is finished", {}};
    if (Result<void> packed = pack_tables(); !packed) return failed(packed.error());
    const std::uint32_t frames = block_.frames();
    if (frames != 0) {
        if (Result<void> packed = pack(frames_chunk, block_.take(), frames_flushed_, frames); !packed) {
            return failed(packed.error());
        }
    }
    if (Result<void> written = write_packed(); !written) return written;
    frames_flushed_ += frames;
    return {};
}

bool RecordingWriter::is_flush_due() {
    const Clock::time_point now = Clock::now();
    if (block_.frames() == 1) block_begin_ = now;
    const Clock::duration since_last = frames() > 1 ? now - last_frame_ : Clock::duration::zero();
    last_frame_ = now;
    return std::chrono::duration<double>(now - block_begin_ + since_last).count() >= options_.flush_seconds;
}

Result<void> RecordingWriter::add_frame(const Frame& frame) {
    if (!state_) return state_;
    if (finished_) return Error{Status::Busy, path(), "the recording is finished", {}};
    if (!frame.bodies.empty() && frame.bodies.back().row >= tables_[2].rows) {
        return Error{
            Status::BadArgument, "step " + std::to_string(frame.step), "found a body row that was not added", {}};
    }
    if (Result<void> added = block_.add(frame); !added) return added;
    const bool full = block_.frames() >= options_.flush_frames || block_.size() >= full_block_bytes;
    if (is_flush_due() || full) return flush();
    return {};
}

Result<void> RecordingWriter::pack_index() {
    ByteWriter raw;
    const std::uint64_t offset = file_.bytes() + packed_.size();
    raw.put(static_cast<std::uint32_t>(index_.size()));
    for (const IndexEntry& entry : index_) {
        raw.put(static_cast<std::uint32_t>(entry.type));
        raw.put(entry.offset);
        raw.put(entry.first_frame);
        raw.put(entry.frames);
    }
    if (Result<void> packed = packer_.append(index_chunk, raw.bytes(), packed_); !packed) return packed;
    ByteWriter tail;
    tail.put(offset);
    tail.put_letters(tail_magic);
    packed_.insert(packed_.end(), tail.bytes().begin(), tail.bytes().end());
    return {};
}

Result<void> RecordingWriter::finish() {
    if (finished_) return state_;
    if (Result<void> flushed = flush(); !flushed) return flushed;
    if (Result<void> packed = pack_index(); !packed) return failed(packed.error());
    if (Result<void> written = write_packed(); !written) return written;
    if (Result<void> completed = file_.complete(options_.durable); !completed) return failed(completed.error());
    finished_ = true;
    return {};
}

}  // namespace fase::record
