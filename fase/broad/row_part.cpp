/// When boxes are sorted, and which sets of a population ask which.
#include "fase/broad/row_part.hpp"

namespace fase::broad {

void RowPart::clear() {
    loose_.clear();
    blocks_.clear();
}

void RowPart::commit(const RowGridSettings& settings) {
    if (loose_.take_changed()) sorted_.build(loose_.ordinary(), settings);
    blocks_.commit({}, settings);
}

void RowPart::settle(const RowGridSettings& settings) {
    if (!loose_.take_changed()) return blocks_.commit({}, settings);
    blocks_.commit(loose_.ordinary(), settings);
    loose_.drop_ordinary();
}

void RowPart::find_own_pairs(std::size_t k, std::size_t begin, std::size_t end, row_grid::PairBlock& out) const {
    const RowView mine = set(k).view();
    row_grid::find_own_pairs(mine, begin, end, out);
    if (blocks_.size() == 0) return;
    const bool loose_ask = sorted_.size() <= blocks_.size();
    if (k == 0 && !loose_ask) return;
    for_askers(mine, begin, end, [&](std::span<const Move> askers) {
        if (k > 0 && !loose_ask) row_grid::find_asked_pairs(sorted_.view(), {askers, {}}, out);
        blocks_.find_asked_pairs({askers, {}}, k == 0 ? RowBlocks::none : static_cast<std::uint32_t>(k - 1), out);
    });
}

std::string RowPart::broken_invariant() const {
    if (std::string broken = loose_.broken_invariant(); !broken.empty()) return broken;
    if (std::string broken = sorted_.broken_invariant(loose_.ordinary()); !broken.empty()) return broken;
    if (std::string broken = blocks_.broken_invariant(); !broken.empty()) return broken;
    for (const std::span<const Move> row : {loose_.ordinary(), loose_.odd()})
        for (const Move& m : row)
            if (blocks_.holds(m.proxy)) return "a box is loose and in a block";
    return {};
}

}  // namespace fase::broad
