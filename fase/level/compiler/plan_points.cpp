/// Points by their numbers: a hash table with open addressing.
#include "fase/level/compiler/plan_points.hpp"

#include "fase/core/hash.hpp"

namespace fase::level {

std::size_t PlanPoints::place_of(const ExactPoint& p) const {
    const auto word = [](std::int64_t value) { return static_cast<std::uint64_t>(value); };
    const std::uint64_t hash = mix_bits(word(p.x) * 0x9e3779b97f4a7c15ull + word(p.y) * 0xc2b2ae3d27d4eb4full +
                                        word(p.w) * 0x165667b19e3779f9ull);
    std::size_t place = hash & (places_.size() - 1);
    while (places_[place] != empty && exact_[places_[place]] != p) place = (place + 1) & (places_.size() - 1);
    return place;
}

void PlanPoints::grow(std::size_t places) {
    places_.assign(places, empty);
    for (std::size_t i = 0; i < exact_.size(); ++i) places_[place_of(exact_[i])] = static_cast<std::uint32_t>(i);
}

std::uint32_t PlanPoints::index_of(const ExactPoint& p) {
    std::size_t place = place_of(p);
    if (places_[place] != empty) return places_[place];
    const auto index = static_cast<std::uint32_t>(exact_.size());
    const auto w = static_cast<double>(p.w);
    exact_.push_back(p);
    rounded_.push_back({static_cast<double>(p.x) / w, static_cast<double>(p.y) / w});
    places_[place] = index;
    if (exact_.size() * 2 > places_.size()) grow(places_.size() * 2);
    return index;
}

}  // namespace fase::level
