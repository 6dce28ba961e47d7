#pragma once
/// Packs the contacts of hubs into blocks. A hub is a body with more contacts than there are colours.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fase/core/no_index.hpp"
#include "fase/dynamics/solver/solver_types.hpp"

namespace fase::dynamics {

/// Blocks of eight contacts in which lanes may share their body a. The result depends only on the order of the calls.
class HubBlocks {
public:
    void clear() {
        blocks_.clear();
        first_open_ = 0;
    }
    [[nodiscard]] std::size_t size() const { return blocks_.size(); }
    /// Places a contact of rows a (the hub) and b in the first of the last blocks with a free lane in which b does not
    /// occur yet; a static b may occur several times. Returns 8 * block + lane. O(1).
    [[nodiscard]] std::uint32_t place(std::uint32_t a, std::uint32_t b, bool b_is_dynamic) {
        while (first_open_ < blocks_.size() && blocks_[first_open_].count == block_lanes) ++first_open_;
        if (blocks_.size() > first_open_ + max_open) first_open_ = blocks_.size() - max_open;
        std::size_t at = first_open_;
        while (at < blocks_.size() && !blocks_[at].accepts(a, b, b_is_dynamic)) ++at;
        if (at == blocks_.size()) blocks_.emplace_back();
        Block& block = blocks_[at];
        const int lane = block.count++;
        block.a[lane] = a;
        block.b[lane] = b_is_dynamic ? b : no_index;
        return static_cast<std::uint32_t>(at * block_lanes) + static_cast<std::uint32_t>(lane);
    }
    /// Returns how many lanes of the block share the hub of this lane; 0 for an unused lane.
    [[nodiscard]] float split(std::size_t block, int lane) const {
        const Block& rows = blocks_[block];
        int sum = 0;
        for (int i = 0; i < rows.count; ++i) sum += lane < rows.count && rows.a[i] == rows.a[lane];
        return static_cast<float>(sum);
    }

private:
    static constexpr std::size_t max_open = 16;
    struct Block {
        std::array<std::uint32_t, block_lanes> a{}, b{};
        int count = 0;

        [[nodiscard]] bool accepts(std::uint32_t new_a, std::uint32_t new_b, bool b_is_dynamic) const {
            if (count == block_lanes) return false;
            for (int i = 0; i < count; ++i)
                if (b[i] == new_a || (b_is_dynamic && (b[i] == new_b || a[i] == new_b))) return false;
            return true;
        }
    };
    std::vector<Block> blocks_;
    std::size_t first_open_ = 0;
};

}  // namespace fase::dynamics
