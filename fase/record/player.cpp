/// Scans the chunks of a file and decodes blocks on demand.
#include "fase/record/player.hpp"

#include <algorithm>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "fase/core/detail/file_kind.hpp"
#include "fase/core/detail/text.hpp"
#include "fase/record/format.hpp"
#include "fase/record/recording/block_reader.hpp"
#include "fase/record/recording/bytes.hpp"
#include "fase/record/recording/chunk_packer.hpp"
#include "fase/record/recording/crc32.hpp"
#include "fase/record/recording/input_file.hpp"

namespace fase::record {
namespace {

struct Block {
    std::uint64_t offset = 0;  ///< of its chunk
    std::uint64_t first_frame = 0;
    std::uint32_t frames = 0;
};

Error no_memory(const std::string& path) {
    return {Status::NoMemory, path, "not enough memory to read it", "close other programs, or record fewer bodies"};
}

}  // namespace

constexpr std::string_view incomplete_chunk = "found an incomplete chunk";

struct Player::State {
    explicit State(InputFile from) : file(std::move(from)) {}

    [[nodiscard]] std::string at(std::uint64_t offset) const { return detail::at_byte(file.path(), offset); }
    /// The error of a recording without a complete frame.
    [[nodiscard]] Error no_frame(std::string remedy) const {
        return {Status::Format, file.path(), "found no complete frame; expected at least one", std::move(remedy)};
    }
    Result<void> read_file_head() const;
    /// Reads a chunk into `bytes` and verifies its checksum.
    Result<ChunkBody> read_chunk(std::uint64_t offset);
    /// Processes a chunk. Returns whether it is the last one.
    Result<bool> add_chunk(const ChunkBody& chunk, std::uint64_t offset);
    Result<void> add_block(const ChunkBody& chunk, std::uint64_t offset);
    Result<void> scan();
    Result<void> load(const Block& block);

    InputFile file;
    Tables tables;
    std::vector<Block> blocks;
    std::vector<std::byte> bytes;
    std::uint64_t table_bytes = 0, good_bytes = 0;
    bool has_head = false, complete = false;
    std::string lost;
    std::optional<BlockReader> reader;
    std::uint64_t reader_block = 0;  ///< offset of the block that `reader` holds
};

Result<void> Player::State::read_file_head() const {
    std::array<std::byte, file_head_bytes> head;
    const auto length = static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), head.size()));
    if (Result<void> read = file.read(0, std::span(head).first(length)); !read) return read;
    ByteReader in(std::span<const std::byte>(head).first(length));
    const auto magic = in.get_bytes(file_magic.size());
    const auto version = in.get<std::uint32_t>();
    const bool same = magic.size() == file_magic.size() &&
                      std::equal(magic.begin(), magic.end(), std::as_bytes(std::span(file_magic)).begin());
    const std::string_view begin(reinterpret_cast<const char*>(head.data()), length);
    if (begin.empty() || (!same && !file_magic.starts_with(begin)))
        return wrong_kind(file.path(), kind_of(std::span<const std::byte>(head).first(length)),
                          "a recording, which begins with FASEREC");
    const auto check = in.get<std::uint32_t>();
    if (in.failed()) return no_frame("the file ends at byte " + std::to_string(length) + ", inside its head");
    if (check != crc32(std::span<const std::byte>(head).first(12))) {
        return Error{Status::Format, at(8), "found a file head with a wrong checksum", {}};
    }
    if (version != format_version) {
        return Error{
            Status::Format, at(8),
            "found version " + std::to_string(version) + "; this program reads " + std::to_string(format_version),
            "use the version of fase that wrote it"};
    }
    return {};
}

Result<ChunkBody> Player::State::read_chunk(std::uint64_t offset) {
    const std::uint64_t left = file.size() - std::min(offset, file.size());
    if (left < chunk_frame_bytes) return Error{Status::Format, at(offset), std::string(incomplete_chunk), {}};
    std::array<std::byte, 8> head;
    if (Result<void> read = file.read(offset, head); !read) return read.error();
    ByteReader in(head);
    const ChunkType type{in.get<std::uint32_t>()};
    const std::uint64_t length = in.get<std::uint32_t>();
    if (length > left - chunk_frame_bytes) return Error{Status::Format, at(offset), std::string(incomplete_chunk), {}};
    if (length > packed_head_bytes + max_raw_bytes) {
        return Error{Status::Format, at(offset), "found a chunk above the size limit", {}};
    }
    bytes.resize(static_cast<std::size_t>(length + chunk_frame_bytes));
    if (Result<void> read = file.read(offset, bytes); !read) return read.error();
    const std::span<const std::byte> all(bytes);
    ByteReader check(all.last(4));
    if (check.get<std::uint32_t>() != crc32(all.first(all.size() - 4))) {
        return Error{Status::Format, at(offset), "found a chunk with a wrong checksum", {}};
    }
    return ChunkBody{type, all.subspan(8, static_cast<std::size_t>(length))};
}

Result<void> Player::State::add_block(const ChunkBody& chunk, std::uint64_t offset) {
    Result<std::vector<std::byte>> raw = unpack(chunk);
    if (!raw) return raw.error();
    ByteReader in(*raw);
    Block block{offset, in.get<std::uint64_t>(), in.get<std::uint32_t>()};
    const std::uint64_t expected = blocks.empty() ? 0 : blocks.back().first_frame + blocks.back().frames;
    if (in.failed() || block.first_frame != expected || block.frames == 0 || block.frames > max_block_frames) {
        return Error{Status::Format, {}, "found a block out of order", {}};
    }
    blocks.push_back(block);
    return {};
}

Result<bool> Player::State::add_chunk(const ChunkBody& chunk, std::uint64_t offset) {
    const bool is_head = chunk.type == head_chunk;
    if (is_head == has_head)
        return Error{Status::Format, {}, is_head ? "found a second head" : "found no head as first chunk", {}};
    if (chunk.type == frames_chunk) {
        if (Result<void> added = add_block(chunk, offset); !added) return added.error();
        return false;
    }
    if (chunk.type == index_chunk) return true;
    if (!is_head && !holds_rows(chunk.type)) return false;
    const Result<std::uint64_t> length = raw_length(chunk);
    if (!length) return length.error();
    table_bytes += *length;
    if (table_bytes > free_table_bytes + max_table_packing * file.size()) {
        return Error{
            Status::Format, {}, "found tables that expand to more bytes than a file of this size may contain", {}};
    }
    const Result<std::vector<std::byte>> raw = unpack(chunk);
    if (!raw) return raw.error();
    if (is_head) {
        Result<Head> head = read_head(*raw);
        if (!head) return head.error();
        tables.head = std::move(*head);
        has_head = true;
        return false;
    }
    if (Result<void> read = read_rows(chunk.type, *raw, tables); !read) return read.error();
    return false;
}

Result<void> Player::State::scan() {
    if (Result<void> head = read_file_head(); !head) return head;
    std::uint64_t offset = file_head_bytes;
    Error stopped;
    bool ended = false;
    good_bytes = offset;
    while (offset < file.size() && !ended) {
        const Result<ChunkBody> chunk = read_chunk(offset);
        if (!chunk) {
            if (chunk.status() == Status::Io) return chunk.error();
            stopped = chunk.error();
            break;
        }
        const std::uint64_t next = offset + chunk_frame_bytes + (*chunk).bytes.size();
        const Result<bool> added = add_chunk(*chunk, offset);
        if (!added) {
            stopped = added.error();
            stopped.where = at(offset) + (stopped.where.empty() ? "" : ": " + stopped.where);
            break;
        }
        ended = *added;
        offset = next;
        good_bytes = offset;
    }
    if (!has_head) {
        const bool is_cut = stopped.problem.empty() || stopped.problem == incomplete_chunk;
        if (is_cut) return no_frame("the file ends at byte " + std::to_string(file.size()) + ", inside its head");
        stopped.status = Status::Format;
        return stopped;
    }
    complete = ended && offset + tail_bytes == file.size();
    if (complete) {
        good_bytes = file.size();
        return {};
    }
    const Block last = blocks.empty() ? Block{} : blocks.back();
    const std::uint64_t frames = last.first_frame + last.frames;
    const std::string readable = frames == 0   ? "found no complete frame; expected at least one"
                                 : frames == 1 ? "1 frame is readable"
                                               : std::to_string(frames) + " frames are readable";
    if (!stopped.problem.empty()) {
        lost = detail::byte_text(offset) + " of " + std::to_string(file.size()) + ": " + stopped.problem +
               "; the rest is lost, " + readable;
    } else if (!ended) {
        lost = "the recording was not finished: " + readable;
    } else {
        lost = "found bytes after the end of the recording, or an incomplete end: " + readable;
    }
    return {};
}

Result<void> Player::State::load(const Block& block) {
    if (reader && reader_block == block.offset) return {};
    reader.reset();
    const Result<ChunkBody> chunk = read_chunk(block.offset);
    if (!chunk) return chunk.error();
    Result<std::vector<std::byte>> raw = unpack(*chunk);
    if (!raw) return raw.error();
    Result<BlockReader> opened = BlockReader::open(std::move(*raw), tables);
    if (!opened) return opened.error();
    if ((*chunk).type != frames_chunk || (*opened).first_frame() != block.first_frame ||
        (*opened).frames() != block.frames) {
        return Error{Status::Format, at(block.offset), "found a different block than before: the file was changed", {}};
    }
    reader.emplace(std::move(*opened));
    reader_block = block.offset;
    return {};
}

Player::Player(std::unique_ptr<State> state) : state_(std::move(state)) {}
Player::Player(Player&&) noexcept = default;
Player& Player::operator=(Player&&) noexcept = default;
Player::~Player() = default;

const Head& Player::head() const { return state_->tables.head; }
const Tables& Player::tables() const { return state_->tables; }
std::uint64_t Player::frames() const {
    return state_->blocks.empty() ? 0 : state_->blocks.back().first_frame + state_->blocks.back().frames;
}
const std::string& Player::path() const { return state_->file.path(); }
bool Player::complete() const { return state_->complete; }
const std::string& Player::lost() const { return state_->lost; }
std::uint64_t Player::file_bytes() const { return state_->file.size(); }
std::uint64_t Player::good_bytes() const { return state_->good_bytes; }

Result<void> Player::check_has_frames() const { return frames() > 0 ? Result<void>{} : state_->no_frame({}); }

Result<Player> Player::open(const std::string& name) try {
    Result<InputFile> file = InputFile::open(name);
    if (!file) {
        Result<InputFile> unfinished = InputFile::open(name + ".part");
        if (!unfinished) return file.error();
        file = std::move(unfinished);
    }
    auto state = std::make_unique<State>(std::move(*file));
    if (Result<void> scanned = state->scan(); !scanned) return scanned.error();
    state->bytes = {};
    return Player(std::move(state));
} catch (const std::bad_alloc&) {
    return no_memory(name);
}

Result<void> Player::read(std::uint64_t number, Frame& frame) try {
    State& state = *state_;
    const auto after = std::upper_bound(state.blocks.begin(), state.blocks.end(), number,
                                        [](std::uint64_t n, const Block& block) { return n < block.first_frame; });
    if (after == state.blocks.begin() || number >= frames()) {
        return Error{Status::OutOfRange,
                     path(),
                     "found frame " + std::to_string(number) + "; expected one below " + std::to_string(frames()),
                     {}};
    }
    const Block& block = *std::prev(after);
    const auto index = static_cast<std::uint32_t>(number - block.first_frame);
    if (state.reader && state.reader_block == block.offset && state.reader->frames_read() > index) state.reader.reset();
    if (Result<void> loaded = state.load(block); !loaded) return loaded;
    while (state.reader->frames_read() <= index) {
        const Result<void> read = state.reader->next(frame, state.reader->frames_read() == index);
        if (!read) {
            Error error = read.error();
            error.where = state.at(block.offset) + ": " + error.where;
            state.reader.reset();
            return error;
        }
    }
    return {};
} catch (const std::bad_alloc&) {
    return no_memory(path());
}

Result<Frame> Player::frame(std::uint64_t number) {
    Frame frame;
    if (Result<void> read = this->read(number, frame); !read) return read.error();
    return frame;
}

}  // namespace fase::record
