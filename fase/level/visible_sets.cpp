/// Encodes bits as lengths of runs.
#include "fase/level/visible_sets.hpp"

namespace fase::level {

void VisibleSets::append(std::span<const std::uint64_t> bits, std::size_t count) {
    const auto is_set = [&](std::size_t i) { return (bits[i / 64] >> i % 64 & 1) != 0; };
    bool seen = false;
    for (std::size_t i = 0; i < count; seen = !seen) {
        std::size_t end = i;
        while (end < count && is_set(end) == seen) ++end;
        if (end == count && !seen) break;  // the last hidden run is not stored
        for (std::size_t length = end - i;; length >>= 7) {
            runs_.push_back(static_cast<std::uint8_t>((length & 127) | (length >= 128 ? 128 : 0)));
            if (length < 128) break;
        }
        i = end;
    }
}

}  // namespace fase::level
