#pragma once
/// The constants of the recording format; format.md explains them.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace fase::record {

inline constexpr std::string_view file_magic{"FASEREC\n", 8};
inline constexpr std::string_view tail_magic{"FASEEND\n", 8};
inline constexpr std::uint32_t format_version = 1;
inline constexpr std::size_t file_head_bytes = 16;
inline constexpr std::size_t tail_bytes = 16;
inline constexpr std::size_t chunk_frame_bytes = 12;  ///< type, length and checksum around a chunk's body
inline constexpr std::size_t packed_head_bytes = 8;   ///< method and raw length at the start of a body

inline constexpr std::uint64_t max_raw_bytes = std::uint64_t(64) << 20;  ///< limit for one chunk, unpacked
inline constexpr std::uint64_t free_raw_bytes = std::uint64_t(4) << 20;  ///< unpacked bytes that any chunk may have …
inline constexpr std::uint64_t max_packing = 32;                         ///< … plus this many times its packed size
inline constexpr std::uint64_t free_table_bytes = std::uint64_t(4)
                                                  << 20;  ///< unpacked bytes that all tables of a file may have …
inline constexpr std::uint64_t max_table_packing = 16;    ///< … plus this many times the file size
inline constexpr std::uint32_t max_rows = 1u << 21;       ///< limit for each table
inline constexpr std::uint32_t max_block_frames = 64;
inline constexpr std::size_t full_block_bytes = std::size_t(8) << 20;  ///< a writer ends a block at this size
inline constexpr double default_quanta_per_metre = 2048;
inline constexpr double max_position = 1e9;  ///< metres from the origin

/// The type of a chunk: its four letters, the first in the lowest byte.
enum class ChunkType : std::uint32_t {};
/// Returns the chunk type of four letters.
constexpr ChunkType chunk_type(const char (&letters)[5]) {
    std::uint32_t value = 0;
    for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(letters[i]);
    return ChunkType{value};
}
inline constexpr ChunkType head_chunk = chunk_type("HEAD");
inline constexpr ChunkType shapes_chunk = chunk_type("SHAP");
inline constexpr ChunkType meshes_chunk = chunk_type("MESH");
inline constexpr ChunkType bodies_chunk = chunk_type("BODY");
inline constexpr ChunkType colliders_chunk = chunk_type("COLL");
inline constexpr ChunkType collider_ends_chunk = chunk_type("CEND");
inline constexpr ChunkType visuals_chunk = chunk_type("VISU");
inline constexpr ChunkType frames_chunk = chunk_type("FRMS");
inline constexpr ChunkType index_chunk = chunk_type("INDX");

/// Flag bits of a frame.
inline constexpr std::uint8_t key_frame = 1, contacts_follow = 2;
/// Flag bits of a body in a frame; its kind is in the bits above them.
inline constexpr std::uint8_t body_awake = 1, body_quarantined = 2;
inline constexpr int body_kind_shift = 2;

}  // namespace fase::record
