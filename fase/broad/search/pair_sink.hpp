#pragma once
/// A local buffer for the pairs that a hot loop appends to the caller's vector.
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "fase/broad/structure.hpp"

namespace fase::broad {

/// Grows a vector so that `count` more elements fit without an allocation; doubles, as push_back() does.
inline void reserve_room(std::vector<Pair>& out, std::size_t count) {
    if (out.capacity() - out.size() < count) out.reserve(std::max(out.size() + count, 2 * out.capacity()));
}

/// Collects pairs in a local block and appends full blocks to `out`; the destructor appends the rest. The compiler must
/// assume that the caller's vector aliases the boxes that a loop reads; it knows that the local block does not. `out`
/// always has room for one block, so the destructor allocates nothing; nobody else may append while the block has
/// pairs.
class PairSink {
public:
    explicit PairSink(std::vector<Pair>& out) : out_(out) { reserve_room(out_, block_.size()); }
    PairSink(const PairSink&) = delete;
    PairSink& operator=(const PairSink&) = delete;
    ~PairSink() { append(); }

    void add(Proxy p, Proxy q) {
        block_[count_] = ordered_pair(p, q);
        if (++count_ == block_.size()) flush();
    }
    void flush() {
        append();
        reserve_room(out_, block_.size());
    }

private:
    void append() noexcept {
        out_.insert(out_.end(), block_.begin(), block_.begin() + static_cast<std::ptrdiff_t>(count_));
        count_ = 0;
    }

    std::vector<Pair>& out_;
    std::size_t count_ = 0;
    std::array<Pair, 256> block_;
};

}  // namespace fase::broad
