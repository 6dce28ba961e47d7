#pragma once
/// The checksum of chunks: CRC-32 as in zip, PNG and Ethernet.
#include <cstddef>
#include <cstdint>
#include <span>

namespace fase::record {

/// CRC-32 (polynomial EDB88320 reflected, start and final xor FFFFFFFF) of `bytes`; `before` is the value of the bytes
/// that went ahead of them, 0 for none. Eight bytes at a time. Source: Kounavis, Berry 2005, A systematic approach to
/// building high performance software-based CRC generators.
[[nodiscard]] std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before = 0);

}  // namespace fase::record
