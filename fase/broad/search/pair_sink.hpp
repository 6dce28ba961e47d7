#pragma once
/// A local buffer for the pairs that a hot loop appends to the caller's vector.
#include <array>
#include <cstddef>
#include <vector>

#include "fase/broad/structure.hpp"

namespace fase::broad {

/// Collects pairs in a local block and appends full blocks to `out`; the destructor appends the rest. The compiler must
/// assume that the caller's vector aliases the boxes that a loop reads; it knows that the local block does not.
class PairSink {
public:
    explicit PairSink(std::vector<Pair>& out) : out_(out) {}
    PairSink(const PairSink&) = delete;
    PairSink& operator=(const PairSink&) = delete;
    ~PairSink() { flush(); }

    void add(Proxy p, Proxy q) {
        block_[count_] = ordered_pair(p, q);
        if (++count_ == block_.size()) flush();
    }
    void flush() {
        out_.insert(out_.end(), block_.begin(), block_.begin() + static_cast<std::ptrdiff_t>(count_));
        count_ = 0;
    }

private:
    std::vector<Pair>& out_;
    std::size_t count_ = 0;
    std::array<Pair, 256> block_;
};

}  // namespace fase::broad
