/// A hash table of points with open addressing.
#include "fase/level/compiler/plan_points.hpp"

#include "fase/core/hash.hpp"

namespace fase::level {

std::size_t PlanPoints::slot_of(const ExactPoint& p) const {
    const auto word = [](std::int64_t value) { return static_cast<std::uint64_t>(value); };
    const std::uint64_t hash = mix_bits(word(p.x) * 0x9e3779b97f4a7c15ull + word(p.y) * 0xc2b2ae3d27d4eb4full +
                                        word(p.w) * 0x165667b19e3779f9ull);
    std::size_t slot = hash & (slots_.size() - 1);
    while (slots_[slot] != no_index && exact_[slots_[slot]] != p) slot = (slot + 1) & (slots_.size() - 1);
    return slot;
}

void PlanPoints::grow(std::size_t slots) {
    slots_.assign(slots, no_index);
    for (std::size_t i = 0; i < exact_.size(); ++i) slots_[slot_of(exact_[i])] = static_cast<std::uint32_t>(i);
}

std::uint32_t PlanPoints::index_of(const ExactPoint& p) {
    std::size_t slot = slot_of(p);
    if (slots_[slot] != no_index) return slots_[slot];
    const auto index = static_cast<std::uint32_t>(exact_.size());
    const auto w = static_cast<double>(p.w);
    exact_.push_back(p);
    rounded_.push_back({static_cast<double>(p.x) / w, static_cast<double>(p.y) / w});
    slots_[slot] = index;
    if (exact_.size() * 2 > slots_.size()) grow(slots_.size() * 2);
    return index;
}

}  // namespace fase::level
