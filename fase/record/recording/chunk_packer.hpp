#pragma once
/// Packs raw bytes into a chunk of the file and unpacks them.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/record/format.hpp"

namespace fase::record {

/// Appends complete chunks to a buffer. Keeps the compressor's memory between calls.
class ChunkPacker {
public:
    /// @param level zstd compression level: 1 (fast) to 19 (small)
    explicit ChunkPacker(int level = 3);
    ChunkPacker(ChunkPacker&&) noexcept;
    ChunkPacker& operator=(ChunkPacker&&) noexcept;
    ~ChunkPacker();
    /// Appends the chunk to `out`. Stores the bytes uncompressed if a reader's limits would reject their compressed
    /// form. Error Capacity if `raw` exceeds the chunk limit; `out` is then unchanged.
    Result<void> append(ChunkType type, std::span<const std::byte> raw, std::vector<std::byte>& out);

private:
    struct Context;
    std::unique_ptr<Context> context_;
    std::uint64_t table_bytes_ = 0, file_bytes_ = 0;  ///< raw bytes of tables, and bytes of all chunks, so far
};

/// A chunk as stored in a file: its type and the bytes between length and checksum.
struct ChunkBody {
    ChunkType type{};
    std::span<const std::byte> bytes;
};
/// Returns the unpacked length that a body states. Error Format if it exceeds the limits of the format.
Result<std::uint64_t> raw_length(const ChunkBody& body);
/// Unpacks a body; allocates at most raw_length() bytes. Error Format if the packed bytes are invalid.
Result<std::vector<std::byte>> unpack(const ChunkBody& body);

}  // namespace fase::record
