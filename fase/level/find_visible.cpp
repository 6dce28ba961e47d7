/// Propagates sights from each opening to all openings that are visible through it.
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

/// One row of bits for each sub-sector.
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

/// Marks what is visible through single openings; one object a thread.
class SightPropagator {
public:
    SightPropagator(const LevelBsp& bsp, const Doorways& doors, const VisibleOptions& options)
        : bsp_(bsp), doors_(doors), options_(options), states_(doors.all.size()), pending_(bsp.sub_sectors.size(), 0) {}

    /// Marks all sub-sectors that are visible through an opening. Returns false, with incomplete marks, after too many
    /// steps.
    bool propagate(std::uint32_t from, std::span<Word> seen) {
        const Doorway& first = doors_.all[from];
        ++run_;
        const std::size_t step_limit = steps_ + options_.max_steps;
        states_[from] = {{}, run_, true};
        set(seen, first.into);
        // Close to the order in which lines cross sub-sectors, so few openings are processed again.
        const Point middle{(first.left.x + first.right.x) / 2, (first.left.y + first.right.y) / 2};
        order_.clear();
        front_to_back(bsp_, middle, [&](std::uint32_t s) {
            order_.push_back(s);
            return true;
        });
        pending_[first.into] = 1;
        for (std::size_t pending = 1; pending > 0;) {
            for (const std::uint32_t s : order_) {
                if (pending_[s] == 0) continue;
                pending_[s] = 0;
                pending += process(first, s, seen) - 1;
                if (steps_ > step_limit) {
                    std::fill(pending_.begin(), pending_.end(), std::uint8_t{0});
                    return false;
                }
            }
        }
        return true;
    }

    /// Marks the coarse set: sub-sectors reached through openings in front of this one that have it behind them.
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
                if (states_[q].run == run_ || !can_follow(first, next)) continue;
                states_[q].run = run_;
                set(seen, next.into);
                order_.push_back(next.into);
            }
        }
    }
    [[nodiscard]] std::size_t steps() const { return steps_; }

private:
    /// Bounds on the lines through an opening.
    struct State {
        Sight sight;
        std::uint32_t run = 0;  ///< number of the run that wrote it
        bool is_new = false;    ///< not yet propagated
    };
    const LevelBsp& bsp_;
    const Doorways& doors_;
    const VisibleOptions& options_;
    std::vector<State> states_;          ///< by opening
    std::vector<std::uint8_t> pending_;  ///< by sub-sector: new sights lead into it
    std::vector<std::uint32_t> order_;
    std::uint32_t run_ = 0;
    std::size_t steps_ = 0;

    /// Propagates new sights into a sub-sector through all openings out of it. Returns the number of sub-sectors that
    /// became pending.
    std::size_t process(const Doorway& first, std::uint32_t s, std::span<Word> seen) {
        std::size_t more = 0;
        for (std::uint32_t k = doors_.enter_first[s]; k < doors_.enter_first[s + 1]; ++k) {
            State& state = states_[doors_.entering[k]];
            if (state.run != run_ || !state.is_new) continue;
            state.is_new = false;
            const Doorway& last = doors_.all[doors_.entering[k]];
            for (std::uint32_t q = doors_.first[s]; q < doors_.first[s + 1]; ++q) {
                ++steps_;
                const Doorway& next = doors_.all[q];
                const auto further = extend_sight(first, last, state.sight, next, options_.heights);
                if (!further || !merge(states_[q], *further)) continue;
                set(seen, next.into);
                if (pending_[next.into] == 0) {
                    pending_[next.into] = 1;
                    ++more;
                }
            }
        }
        return more;
    }

    // Widens bounds to the next multiple of 1/64, so that the propagation ends.
    static constexpr double bound_steps = 64;
    static bool lower(double& bound, double to) {
        if (!(to < bound)) return false;
        bound = std::floor(to * bound_steps) / bound_steps;
        return true;
    }
    static bool raise(double& bound, double to) {
        if (!(to > bound)) return false;
        bound = std::ceil(to * bound_steps) / bound_steps;
        return true;
    }
    /// Merges a sight into the bounds of an opening. Returns false if they did not change.
    bool merge(State& state, const Sight& sight) const {
        if (state.run != run_) {
            state = {sight, run_, true};
            return true;
        }
        Sight& known = state.sight;
        bool changed = lower(known.first.from, sight.first.from);
        changed = raise(known.first.to, sight.first.to) || changed;
        changed = lower(known.last.from, sight.last.from) || changed;
        changed = raise(known.last.to, sight.last.to) || changed;
        changed = lower(known.slopes.min, sight.slopes.min) || changed;
        changed = raise(known.slopes.max, sight.slopes.max) || changed;
        state.is_new = state.is_new || changed;
        return changed;
    }
};

/// Returns the pairs of which each is marked in the row of the other.
BitRows mutual_pairs(const BitRows& seen, std::size_t count) {
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
        return Error{
            Status::Capacity,
            "VisibleOptions.max_bytes",
            fmt::format("found {} bytes; expected at least {} for {} sub-sectors", options.max_bytes, needed, count),
            {}};
    }
    const Doorways doors = Doorways::of(bsp, map, options.heights);
    BitRows seen(count);
    constexpr std::size_t grain = 16;
    std::vector<VisibleStats> parts((count + grain - 1) / grain);
    const auto find = [&](std::size_t begin, std::size_t end) {
        SightPropagator propagator(bsp, doors, options);
        VisibleStats& part = parts[begin / grain];
        for (std::size_t s = begin; s < end; ++s) {
            set(seen.row(s), s);
            for (std::uint32_t from = doors.first[s]; from < doors.first[s + 1]; ++from) {
                if (propagator.propagate(from, seen.row(s))) continue;
                propagator.flood(from, seen.row(s));
                ++part.coarse;
            }
        }
        part.steps = propagator.steps();
    };
    if (options.tasks != nullptr) {
        parallel_ranges(*options.tasks, count, grain, find);
    } else {
        for (std::size_t begin = 0; begin < count; begin += grain) find(begin, std::min(begin + grain, count));
    }
    const BitRows both = mutual_pairs(seen, count);
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
