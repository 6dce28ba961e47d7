/// CRC-32 with eight lookup tables.
#include "fase/record/recording/crc32.hpp"

#include <array>

namespace fase::record {
namespace {

using CrcTables = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr CrcTables make_crc_tables() {
    CrcTables tables{};
    for (std::uint32_t i = 0; i < 256; ++i) {
        std::uint32_t value = i;
        for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((value & 1) != 0 ? 0xedb88320u : 0);
        tables[0][i] = value;
    }
    for (std::uint32_t i = 0; i < 256; ++i) {
        for (std::size_t t = 1; t < 8; ++t) {
            tables[t][i] = (tables[t - 1][i] >> 8) ^ tables[0][tables[t - 1][i] & 255];
        }
    }
    return tables;
}
constexpr CrcTables crc_tables = make_crc_tables();

}  // namespace

std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before) {
    std::uint32_t crc = ~before;
    const auto at = [&](std::size_t i) { return static_cast<std::uint32_t>(bytes[i]); };
    std::size_t i = 0;
    for (; i + 8 <= bytes.size(); i += 8) {
        const std::uint32_t low = crc ^ (at(i) | at(i + 1) << 8 | at(i + 2) << 16 | at(i + 3) << 24);
        crc = crc_tables[7][low & 255] ^ crc_tables[6][(low >> 8) & 255] ^ crc_tables[5][(low >> 16) & 255] ^
              crc_tables[4][low >> 24] ^ crc_tables[3][at(i + 4)] ^ crc_tables[2][at(i + 5)] ^
              crc_tables[1][at(i + 6)] ^ crc_tables[0][at(i + 7)];
    }
    for (; i < bytes.size(); ++i) crc = (crc >> 8) ^ crc_tables[0][(crc ^ at(i)) & 255];
    return ~crc;
}

}  // namespace fase::record
