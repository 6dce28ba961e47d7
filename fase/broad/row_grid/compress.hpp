#pragma once
/// Permutation tables that move the marked lanes of a vector to its front.
#include <array>
#include <cstddef>
#include <cstdint>

namespace fase::broad::row_grid {

/// Returns the source lanes by mask: first the marked lanes, in order, then lane 0. Each lane is given by `bytes`
/// bytes: its index, or the indices of its bytes.
template <std::size_t lanes, std::size_t bytes> constexpr auto front_lanes() {
    std::array<std::array<std::uint8_t, lanes * bytes>, (std::size_t{1} << lanes)> table{};
    for (std::size_t mask = 0; mask < table.size(); ++mask) {
        std::size_t to = 0;
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            if ((mask >> lane & 1) == 0) continue;
            for (std::size_t k = 0; k < bytes; ++k)
                table[mask][to++] = static_cast<std::uint8_t>(bytes == 1 ? lane : lane * bytes + k);
        }
    }
    return table;
}
alignas(64) inline constexpr auto front_of_eight = front_lanes<8, 1>();
alignas(64) inline constexpr auto front_bytes_of_four = front_lanes<4, 4>();

}  // namespace fase::broad::row_grid
