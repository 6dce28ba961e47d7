/// A merge of two sorted lists into three.
#include "fase/pairs/pair_set.hpp"

#include <algorithm>

#include "fase/core/detail/check.hpp"

namespace fase::pairs {

PairChanges PairSet::update(std::span<const broad::Pair> current) {
    FASE_ASSERT(std::is_sorted(current.begin(), current.end()));
    begun_.clear();
    staying_.clear();
    ended_.clear();
    std::size_t o = 0, n = 0;
    while (o < pairs_.size() && n < current.size()) {
        const broad::Pair before = pairs_[o], now = current[n];
        if (before == now) {
            staying_.push_back(now);
            ++o;
            ++n;
        } else if (before < now) {
            ended_.push_back(before);
            ++o;
        } else {
            begun_.push_back(now);
            ++n;
        }
    }
    ended_.insert(ended_.end(), pairs_.begin() + static_cast<std::ptrdiff_t>(o), pairs_.end());
    begun_.insert(begun_.end(), current.begin() + static_cast<std::ptrdiff_t>(n), current.end());
    pairs_.assign(current.begin(), current.end());
    return {begun_, staying_, ended_};
}

std::size_t PairSet::bytes() const {
    return (pairs_.capacity() + begun_.capacity() + staying_.capacity() + ended_.capacity()) * sizeof(broad::Pair);
}

}  // namespace fase::pairs
