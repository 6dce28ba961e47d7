/// Packs and unpacks chunks with zstd.
#include "fase/record/recording/chunk_packer.hpp"

#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <string>

#include "fase/record/recording/crc32.hpp"

namespace fase::record {
namespace {

constexpr int max_window_log = 23;

void set_u32(std::byte* at, std::uint32_t value) {
    for (int i = 0; i < 4; ++i) at[i] = static_cast<std::byte>(value >> (8 * i));
}
std::uint32_t get_u32(const std::byte* at) {
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value |= std::to_integer<std::uint32_t>(at[i]) << (8 * i);
    return value;
}
std::string letters_of(ChunkType type) {
    std::string letters;
    for (int i = 0; i < 4; ++i) {
        const auto letter = static_cast<char>(static_cast<std::uint32_t>(type) >> (8 * i) & 255);
        letters += letter >= ' ' && letter <= '~' ? letter : '?';
    }
    return letters;
}

}  // namespace

struct ChunkPacker::Context {
    ZSTD_CCtx* zstd = nullptr;
    ~Context() { ZSTD_freeCCtx(zstd); }
};

ChunkPacker::ChunkPacker(int level) : context_(std::make_unique<Context>()) {
    context_->zstd = ZSTD_createCCtx();
    if (context_->zstd == nullptr) return;
    ZSTD_CCtx_setParameter(context_->zstd, ZSTD_c_compressionLevel, std::clamp(level, 1, 19));
    ZSTD_CCtx_setParameter(context_->zstd, ZSTD_c_contentSizeFlag, 1);
}
ChunkPacker::ChunkPacker(ChunkPacker&&) noexcept = default;
ChunkPacker& ChunkPacker::operator=(ChunkPacker&&) noexcept = default;
ChunkPacker::~ChunkPacker() = default;

Result<void> ChunkPacker::append(ChunkType type, std::span<const std::byte> raw, std::vector<std::byte>& out) {
    if (raw.size() > max_raw_bytes) {
        return Error{
            Status::Capacity, "chunk " + letters_of(type),
            "found " + std::to_string(raw.size()) + " bytes; expected at most " + std::to_string(max_raw_bytes),
            "record fewer bodies or smaller meshes"};
    }
    const std::size_t begin = out.size();
    const std::size_t capacity = std::max(ZSTD_compressBound(raw.size()), raw.size());
    out.resize(begin + 8 + packed_head_bytes + capacity + 4);
    std::byte* packed = out.data() + begin + 8 + packed_head_bytes;
    std::size_t size =
        context_->zstd == nullptr ? 0 : ZSTD_compress2(context_->zstd, packed, capacity, raw.data(), raw.size());
    bool store_plain = context_->zstd == nullptr || ZSTD_isError(size) != 0 || size >= raw.size() ||
                       raw.size() > free_raw_bytes + max_packing * (size + packed_head_bytes);
    if (type != frames_chunk) {
        table_bytes_ += raw.size();
        store_plain = store_plain || table_bytes_ > free_table_bytes + max_table_packing * (file_bytes_ + size);
    }
    if (store_plain) {
        size = raw.size();
        if (size != 0) std::memcpy(packed, raw.data(), size);
    }
    const std::size_t length = packed_head_bytes + size;
    std::byte* head = out.data() + begin;
    set_u32(head, static_cast<std::uint32_t>(type));
    set_u32(head + 4, static_cast<std::uint32_t>(length));
    set_u32(head + 8, store_plain ? 0 : 1);
    set_u32(head + 12, static_cast<std::uint32_t>(raw.size()));
    out.resize(begin + 8 + length + 4);
    const auto checked = std::span<const std::byte>(out).subspan(begin, 8 + length);
    set_u32(out.data() + begin + 8 + length, crc32(checked));
    file_bytes_ += out.size() - begin;
    return {};
}

Result<std::uint64_t> raw_length(const ChunkBody& body) {
    const auto refuse = [&](const char* problem) {
        return Error{Status::Format, "chunk " + letters_of(body.type), problem, {}};
    };
    if (body.bytes.size() < packed_head_bytes) return refuse("found an incomplete chunk body");
    const std::uint32_t method = get_u32(body.bytes.data());
    const std::uint64_t raw = get_u32(body.bytes.data() + 4);
    if (method > 1) return refuse("found an unknown packing method; expected 0 (plain) or 1 (zstd)");
    if (raw > max_raw_bytes || raw > free_raw_bytes + max_packing * body.bytes.size()) {
        return refuse("expands to more bytes than a chunk of its size may contain");
    }
    if (method == 0 && raw != body.bytes.size() - packed_head_bytes)
        return refuse("found a length that differs from the stated one");
    return raw;
}

Result<std::vector<std::byte>> unpack(const ChunkBody& body) {
    const Result<std::uint64_t> length = raw_length(body);
    if (!length) return length.error();
    const auto packed = body.bytes.subspan(packed_head_bytes);
    if (get_u32(body.bytes.data()) == 0) return std::vector<std::byte>(packed.begin(), packed.end());
    const auto refuse = [&](const char* problem) {
        return Error{Status::Format, "chunk " + letters_of(body.type), problem, {}};
    };
    struct Context {
        ZSTD_DCtx* zstd = ZSTD_createDCtx();
        ~Context() { ZSTD_freeDCtx(zstd); }
    } context;
    if (context.zstd == nullptr) return Error{Status::NoMemory, {}, "not enough memory to unpack a chunk", {}};
    ZSTD_DCtx_setParameter(context.zstd, ZSTD_d_windowLogMax, max_window_log);
    std::vector<std::byte> raw(static_cast<std::size_t>(*length));
    ZSTD_inBuffer in{packed.data(), packed.size(), 0};
    ZSTD_outBuffer out{raw.data(), raw.size(), 0};
    const std::size_t state = ZSTD_decompressStream(context.zstd, &out, &in);
    if (ZSTD_isError(state) != 0 || state != 0 || in.pos != in.size || out.pos != out.size) {
        return refuse("found packed bytes that are not a zstd frame of the stated length");
    }
    return raw;
}

}  // namespace fase::record
