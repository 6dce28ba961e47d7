/// Spreads sights from each opening over all that can be seen through it.
#include "fase/level/find_visible.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <vector>

#include "fase/level/level_order.hpp"
#include "fase/level/visibility/doorways.hpp"

namespace fase::level {
namespace {

using Word = std::uint64_t;

/// Rows of bits, one a sub-sector.
class BitRows {
public:
    explicit BitRows(std::size_t count) : words_((count + 63) / 64), bits_(count * words_, 0) {}
    [[nodiscard]] std::span<Word> row(std::size_t i) { return {bits_.data() + i * words_, words_}; }
    [[nodiscard]] std::span<const Word> row(std::size_t i) const { return {bits_.data() + i * words_, words_}; }

private:
    std::size_t words_;
    std::vector<Word> bits_;
};
void set(std::span<Word> row, std::size_t bit) { row[bit / 64] |= Word{1} << bit % 64; }
bool is_set(std::span<const Word> row, std::size_t bit) { return (row[bit / 64] >> bit % 64 & 1) != 0; }

/// Marks what is seen through one opening after another; one a thread.
class Spreader {
public:
    Spreader(const LevelBsp& bsp, const Doorways& doors, const VisibleOptions& options)
        : bsp_(bsp), doors_(doors), options_(options), states_(doors.all.size()), waits_(bsp.sub_sectors.size(), 0) {}

    /// False, with some things not marked, when it takes too many steps.
    bool spread(std::uint32_t from, std::span<Word> seen) {
        const Doorway& first = doors_.all[from];
        ++run_;
        const std::size_t most = steps_ + options_.max_steps;
        states_[from] = {{}, run_, true};
        set(seen, first.into);
        // Nearly the order in which lines meet sub-sectors, so that few are looked through again.
        const Point middle{(first.left.x + first.right.x) / 2, (first.left.y + first.right.y) / 2};
        order_.clear();
        front_to_back(bsp_, middle, [&](std::uint32_t s) {
            order_.push_back(s);
            return true;
        });
        waits_[first.into] = 1;
        for (std::size_t waiting = 1; waiting > 0;) {
            for (const std::uint32_t s : order_) {
                if (waits_[s] == 0) continue;
                waits_[s] = 0;
                waiting += look_on(first, s, seen) - 1;
                if (steps_ > most) {
                    std::fill(waits_.begin(), waits_.end(), std::uint8_t{0});
                    return false;
                }
            }
        }
        return true;
    }

    /// The coarse answer: all that is reached through openings that lie before this one and have it behind them.
    void flood(std::uint32_t from, std::span<Word> seen) {
        const Doorway& first = doors_.all[from];
        ++run_;
        order_.assign(1, first.into);
        set(seen, first.into);
        while (!order_.empty()) {
            const std::uint32_t s = order_.back();
            order_.pop_back();
            for (std::uint32_t q = doors_.first[s]; q < doors_.first[s + 1]; ++q) {
                const Doorway& next = doors_.all[q];
                if (states_[q].run == run_ || !may_follow(first, next)) continue;
                states_[q].run = run_;
                set(seen, next.into);
                order_.push_back(next.into);
            }
        }
    }
    [[nodiscard]] std::size_t steps() const { return steps_; }

private:
    /// What is known of the lines through an opening.
    struct State {
        Sight sight;
        std::uint32_t run = 0;  ///< in which it was found
        bool fresh = false;     ///< not yet looked on from
    };
    const LevelBsp& bsp_;
    const Doorways& doors_;
    const VisibleOptions& options_;
    std::vector<State> states_;        ///< by opening
    std::vector<std::uint8_t> waits_;  ///< by sub-sector: fresh sights lead into it
    std::vector<std::uint32_t> order_;
    std::uint32_t run_ = 0;
    std::size_t steps_ = 0;

    /// From all fresh openings into a sub-sector through all out of it. How many sub-sectors more wait.
    std::size_t look_on(const Doorway& first, std::uint32_t s, std::span<Word> seen) {
        std::size_t more = 0;
        for (std::uint32_t k = doors_.enter_first[s]; k < doors_.enter_first[s + 1]; ++k) {
            State& state = states_[doors_.entering[k]];
            if (state.run != run_ || !state.fresh) continue;
            state.fresh = false;
            const Doorway& last = doors_.all[doors_.entering[k]];
            for (std::uint32_t q = doors_.first[s]; q < doors_.first[s + 1]; ++q) {
                ++steps_;
                const Doorway& next = doors_.all[q];
                const auto further = go_on(first, last, state.sight, next, options_.heights);
                if (!further || !take(states_[q], *further)) continue;
                set(seen, next.into);
                if (waits_[next.into] == 0) {
                    waits_[next.into] = 1;
                    ++more;
                }
            }
        }
        return more;
    }

    // Bounds that grow go to the next mark, so that they do not grow for ever.
    static constexpr double marks = 64;
    static bool lower(double& bound, double to) {
        if (!(to < bound)) return false;
        bound = std::floor(to * marks) / marks;
        return true;
    }
    static bool raise(double& bound, double to) {
        if (!(to > bound)) return false;
        bound = std::ceil(to * marks) / marks;
        return true;
    }
    /// Adds sights through an opening to those known; false when they are.
    bool take(State& state, const Sight& sight) const {
        if (state.run != run_) {
            state = {sight, run_, true};
            return true;
        }
        Sight& known = state.sight;
        bool grows = lower(known.first.from, sight.first.from);
        grows = raise(known.first.to, sight.first.to) || grows;
        grows = lower(known.last.from, sight.last.from) || grows;
        grows = raise(known.last.to, sight.last.to) || grows;
        grows = lower(known.slopes.least, sight.slopes.least) || grows;
        grows = raise(known.slopes.most, sight.slopes.most) || grows;
        state.fresh = state.fresh || grows;
        return grows;
    }
};

/// Pairs of which each is marked in the other's row.
BitRows mutual(const BitRows& seen, std::size_t count) {
    BitRows both(count);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t w = 0; w < seen.row(i).size(); ++w) {
            for (Word rest = seen.row(i)[w]; rest != 0; rest &= rest - 1) {
                const std::size_t k = w * 64 + static_cast<std::size_t>(std::countr_zero(rest));
                if (is_set(seen.row(k), i)) set(both.row(i), k);
            }
        }
    }
    return both;
}

}  // namespace

Result<VisibleResult> find_visible(const LevelBsp& bsp, const Map& map, const VisibleOptions& options) {
    const std::size_t count = bsp.sub_sectors.size();
    const std::size_t needed = 2 * count * ((count + 63) / 64) * sizeof(Word);
    if (needed > options.max_bytes) {
        return Error{Status::Capacity,
                     "VisibleOptions.most_bytes",
                     fmt::format("found {} bytes, need {} for {} sub-sectors", options.max_bytes, needed, count),
                     {}};
    }
    const Doorways doors = Doorways::of(bsp, map, options.heights);
    BitRows seen(count);
    constexpr std::size_t grain = 16;
    std::vector<VisibleStats> parts((count + grain - 1) / grain);
    const auto find = [&](std::size_t begin, std::size_t end) {
        Spreader spreader(bsp, doors, options);
        VisibleStats& part = parts[begin / grain];
        for (std::size_t s = begin; s < end; ++s) {
            set(seen.row(s), s);
            for (std::uint32_t from = doors.first[s]; from < doors.first[s + 1]; ++from) {
                if (spreader.spread(from, seen.row(s))) continue;
                spreader.flood(from, seen.row(s));
                ++part.coarse;
            }
        }
        part.steps = spreader.steps();
    };
    if (options.tasks != nullptr) {
        parallel_ranges(*options.tasks, count, grain, find);
    } else {
        for (std::size_t begin = 0; begin < count; begin += grain) find(begin, std::min(begin + grain, count));
    }
    const BitRows both = mutual(seen, count);
    VisibleResult result;
    result.sets = VisibleSets::of(count, [&](std::size_t i) { return both.row(i); });
    VisibleStats& stats = result.stats;
    for (const VisibleStats& part : parts) {
        stats.coarse += part.coarse;
        stats.steps += part.steps;
    }
    stats.sub_sectors = count;
    stats.openings = doors.all.size();
    stats.pairs = result.sets.pairs();
    stats.bytes = result.sets.bytes();
    return result;
}

}  // namespace fase::level
