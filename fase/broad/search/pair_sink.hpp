#pragma once
/// Where hot loops put the pairs they find before these reach the caller's vector.
#include <array>
#include <cstddef>
#include <vector>

#include "fase/broad/structure.hpp"

namespace fase::broad {

/// Collects pairs in a block of its own and appends full blocks to `out`; the rest goes there when the sink dies. The
/// compiler must assume that a caller's vector aliases the boxes that a loop reads; it knows better of this block.
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
