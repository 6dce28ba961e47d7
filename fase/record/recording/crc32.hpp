#pragma once
/// The checksum of chunks: CRC-32 as in ZIP, PNG and Ethernet.
#include <cstddef>
#include <cstdint>
#include <span>

namespace fase::record {

/// Returns the CRC-32 (polynomial EDB88320 reflected, initial value and final xor FFFFFFFF) of `bytes`. To continue,
/// pass the result for the preceding bytes as `before`. Processes eight bytes per step. Source: Kounavis, Berry 2005, A
/// systematic approach to building high performance software-based CRC generators.
[[nodiscard]] std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before = 0);

}  // namespace fase::record
