#pragma once
/// Raw bytes into a chunk of the file, and a chunk back into raw bytes.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/record/format.hpp"

namespace fase::record {

/// Appends whole chunks to a buffer. Holds the compressor's memory between calls.
class ChunkPacker {
public:
    /// @param level of zstd, 1 (quick) to 19 (small).
    explicit ChunkPacker(int level = 3);
    ChunkPacker(ChunkPacker&&) noexcept;
    ChunkPacker& operator=(ChunkPacker&&) noexcept;
    ~ChunkPacker();
    /// Appends the chunk to `out`. Bytes that a reader's limits would refuse in packed form are stored plainly.
    /// Capacity when `raw` is longer than a chunk may be, NoMemory; then `out` is as it was.
    Result<void> append(ChunkType type, std::span<const std::byte> raw, std::vector<std::byte>& out);

private:
    struct Context;
    std::unique_ptr<Context> context_;
    std::uint64_t table_bytes_ = 0, file_bytes_ = 0;  ///< raw bytes of tables and bytes of chunks so far
};

/// A chunk as it stands in a file: its type and the bytes between length and check.
struct ChunkBody {
    ChunkType type{};
    std::span<const std::byte> bytes;
};
/// The unpacked length that a body says it has, checked against the limits of the format. Format otherwise.
Result<std::uint64_t> raw_length(const ChunkBody& body);
/// Unpacks. Allocates no more than raw_length(). Format when the bytes are not what they should be.
Result<std::vector<std::byte>> unpack(const ChunkBody& body);

}  // namespace fase::record
