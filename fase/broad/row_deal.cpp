/// Who deals which boxes, and where the runs of a slab are.
#include "fase/broad/row_deal.hpp"

#include <algorithm>
#include <bit>

namespace fase::broad {

using row_grid::Counted;
using row_grid::Hand;

template <class Row> Counted RowDeal::deal_from(std::span<const Row> boxes, const RowFit& fit, TaskRunner* tasks) {
    const std::size_t threads = tasks == nullptr ? 1 : static_cast<std::size_t>(tasks->threads());
    const std::size_t parts = std::max<std::size_t>(std::min(threads, boxes.size() / part_least), 1);
    const std::size_t part_length = (boxes.size() + parts - 1) / parts;
    // Several slabs a thread: some have more boxes than others.
    const std::size_t wanted = std::clamp<std::size_t>(
        std::max(boxes.size() / slab_boxes, threads == 1 ? 1 : 8 * threads), 1, Hand::most_slabs / 2);
    const auto shift = static_cast<unsigned>(std::bit_width(fit.table / wanted));
    const std::size_t slabs = (fit.table >> shift) + std::size_t{1};
    const std::size_t part_room = part_length + slabs * Hand::run_length;
    if (pool_.size() < parts * part_room + 1) pool_.resize(parts * (part_room + part_length / 64) + 1);
    hands_.resize(parts);
    std::vector<Counted> counted(parts);
    const auto deal_part = [&](std::size_t begin, std::size_t end) {
        const std::size_t part = begin / part_length;
        Hand& hand = hands_[part];
        hand.begin(pool_.data(), static_cast<std::uint32_t>(part * part_room), shift);
        counted[part] = row_grid::deal_boxes(boxes.subspan(begin, end - begin), static_cast<Proxy>(begin), fit, hand);
    };
    if (parts == 1) {
        deal_part(0, boxes.size());
    } else {
        parallel_ranges(*tasks, boxes.size(), part_length, deal_part);
    }
    Counted all;
    for (const Counted& part : counted) all += part;
    gather_runs(slabs, shift, fit.table);
    return all;
}

template Counted RowDeal::deal_from(std::span<const Move>, const RowFit&, TaskRunner*);
template Counted RowDeal::deal_from(std::span<const Aabb>, const RowFit&, TaskRunner*);

/// Runs go by hands, and by slabs only within the order of a hand: here they are put by slab.
void RowDeal::gather_runs(std::size_t slabs, unsigned shift, std::uint32_t counters) {
    std::array<std::uint32_t, Hand::most_slabs + 1> next{};
    std::size_t total = 0;
    for (const Hand& hand : hands_) {
        for (const Hand::Run& run : hand.runs()) ++next[run.slab + 1];
        total += hand.runs().size();
    }
    for (std::size_t k = 0; k < slabs; ++k) next[k + 1] += next[k];
    runs_.resize(total);
    slabs_.resize(slabs);
    for (std::size_t k = 0; k < slabs; ++k) slabs_[k].runs = {runs_.data() + next[k], next[k + 1] - next[k]};
    for (const Hand& hand : hands_)
        for (const Hand::Run& run : hand.runs()) runs_[next[run.slab]++] = {run.begin, hand.end_of(run)};
    std::uint32_t first = 0;
    for (std::size_t k = 0; k < slabs; ++k) {
        RowSlab& slab = slabs_[k];
        slab.counters = static_cast<std::uint32_t>(k) << shift;
        slab.counters_end =
            static_cast<std::uint32_t>(std::min<std::uint64_t>(counters, (std::uint64_t{k} + 1) << shift));
        slab.first = first;
        for (const RecordSpan run : slab.runs) first += run.end - run.begin;
    }
}

std::size_t RowDeal::bytes() const {
    std::size_t sum = pool_.capacity() * sizeof(Move) + hands_.capacity() * sizeof(Hand) +
                      slabs_.capacity() * sizeof(RowSlab) + runs_.capacity() * sizeof(RecordSpan);
    for (const Hand& hand : hands_) sum += hand.runs().size_bytes();
    return sum;
}

}  // namespace fase::broad
