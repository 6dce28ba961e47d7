/// Fills a page along a skyline.
#include "fase/atlas/packers/skyline.hpp"

#include <algorithm>
#include <functional>
#include <limits>

namespace fase::atlas {
namespace {

constexpr int exhausted = std::numeric_limits<int>::max();

}  // namespace

void Skyline::Buckets::prepare(std::span<const Candidate> candidates, int max_side, bool by_height) {
    const auto key = [&](const Candidate& p) { return static_cast<std::size_t>(by_height ? p.height : p.width); };
    first.assign(static_cast<std::size_t>(max_side) + 2, 0);
    for (const Candidate& p : candidates) ++first[key(p) + 1];
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    all.resize(candidates.size());
    size.assign(first.begin(), first.end() - 1);  // used as the next free index of each bucket
    for (std::uint32_t i = 0; i < candidates.size(); ++i) all[size[key(candidates[i])]++] = i;
}

void Skyline::Buckets::reset() {
    left = all;
    for (std::size_t i = 0; i < size.size(); ++i) size[i] = first[i + 1] - first[i];
}

void Skyline::prepare(std::span<const Kind> kinds, std::span<const std::uint32_t> order, bool may_rotate,
                      bool landscape_first) {
    candidates_.clear();
    candidate_of_.assign(kinds.size(), no_index);
    max_side_ = 0;
    for (const std::uint32_t kind : order) {
        const Kind size = kinds[kind];
        const bool is_landscape = size.width >= size.height;
        const bool rotated_first = may_rotate && is_landscape != landscape_first && size.width != size.height;
        candidate_of_[kind] = static_cast<std::uint32_t>(candidates_.size());
        const Candidate upright{size.width, size.height, kind, false}, rotated{size.height, size.width, kind, true};
        candidates_.push_back(rotated_first ? rotated : upright);
        if (may_rotate && size.width != size.height) candidates_.push_back(rotated_first ? upright : rotated);
        max_side_ = std::max({max_side_, size.width, size.height});
    }
    by_width_.prepare(candidates_, max_side_, false);
    by_height_.prepare(candidates_, max_side_, true);
    leaves_ = 1;
    while (leaves_ < candidates_.size()) leaves_ *= 2;
}

/// Returns the first candidate in a bucket that is left and that `accept` accepts; removes exhausted ones on the way.
template <class Accept> std::uint32_t Skyline::first_in(Buckets& buckets, int width, Accept&& accept) {
    if (width > max_side_ || width <= 0) return no_index;
    const auto bucket = static_cast<std::size_t>(width);
    std::uint32_t* const begin = buckets.left.data() + buckets.first[bucket];
    std::uint32_t kept = 0, i = 0;
    std::uint32_t found = no_index;
    const std::uint32_t size = buckets.size[bucket];
    for (; i < size && found == no_index; ++i) {
        const std::uint32_t at = begin[i];
        if (counts_[candidates_[at].kind] == 0) continue;
        begin[kept++] = at;
        if (accept(at)) found = at;
    }
    if (kept != i) {
        while (i < size) begin[kept++] = begin[i++];
        buckets.size[bucket] = kept;
    }
    return found;
}

/// Returns the first candidate in the order of preference that is at most this wide and high.
std::uint32_t Skyline::first_fitting(int width, int height) const {
    const auto may_fit = [&](std::size_t node) {
        return min_size_[node].width <= width && min_size_[node].height <= height;
    };
    std::size_t node = 1;
    if (!may_fit(node)) return no_index;
    for (;;) {
        if (node >= leaves_) return static_cast<std::uint32_t>(node - leaves_);
        if (may_fit(2 * node)) {
            node = 2 * node;
            continue;
        }
        node = 2 * node + 1;
        // A branch may contain a narrow and a low candidate but none that fits: continue with the next branch.
        while (!may_fit(node)) {
            while (node % 2 == 1) node /= 2;
            if (node == 0) return no_index;
            ++node;
        }
    }
}

std::uint32_t Skyline::select(const Gap& gap, const SkylineRules& rules) {
    const int higher = std::max(gap.left_wall, gap.right_wall);
    std::uint32_t best = no_index;
    int best_fit = 0;
    (void)first_in(by_width_, gap.width, [&](std::uint32_t at) {
        const int height = candidates_[at].height;
        if (height > gap.headroom) return false;
        const bool level = height == gap.left_wall || height == gap.right_wall;
        const int fit = level ? (gap.left_wall == gap.right_wall ? 4 : 3) : height < higher ? 2 : 1;
        if (fit > best_fit) {
            best_fit = fit;
            best = at;
        }
        return best_fit == 4;
    });
    if (best != no_index) return best;
    const int useful = gap.width - narrowest_;  // a wider rectangle leaves a rest that no rectangle fits
    for (const int wall : {gap.left_wall, gap.right_wall}) {
        if (wall > gap.headroom) continue;
        best = std::min(best,
                        first_in(by_height_, wall, [&](std::uint32_t at) { return candidates_[at].width <= useful; }));
    }
    if (best != no_index) return best;
    best = first_fitting(useful, gap.headroom);
    if (best != no_index) return best;
    if (!rules.widest_last) return first_fitting(gap.width - 1, gap.headroom);
    for (int width = std::min(gap.width - 1, max_side_); width > std::max(useful, 0); --width) {
        if (left_with_width_[static_cast<std::size_t>(width)] == 0) continue;
        best = first_in(by_width_, width, [&](std::uint32_t at) { return candidates_[at].height <= gap.headroom; });
        if (best != no_index) return best;
    }
    return no_index;
}

/// Counts one rectangle of a kind as placed.
void Skyline::use(std::uint32_t candidate) {
    const Candidate& used = candidates_[candidate];
    const std::uint32_t left = --counts_[used.kind];
    const std::uint32_t first = candidate_of_[used.kind];
    for (std::uint32_t at = first; at < candidates_.size() && candidates_[at].kind == used.kind; ++at) {
        --left_with_width_[static_cast<std::size_t>(candidates_[at].width)];
        if (left > 0) continue;
        std::size_t node = leaves_ + at;
        min_size_[node] = {exhausted, exhausted};
        for (node /= 2; node > 0; node /= 2) {
            const Size a = min_size_[2 * node], b = min_size_[2 * node + 1];
            const Size lower{std::min(a.width, b.width), std::min(a.height, b.height)};
            if (lower == min_size_[node]) break;
            min_size_[node] = lower;
        }
    }
    while (narrowest_ < max_side_ && left_with_width_[static_cast<std::size_t>(narrowest_)] == 0) ++narrowest_;
}

void Skyline::start(Size page) {
    by_width_.reset();
    by_height_.reset();
    left_with_width_.assign(static_cast<std::size_t>(max_side_) + 1, 0);
    min_size_.assign(2 * leaves_, {exhausted, exhausted});
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
        const Candidate& p = candidates_[i];
        left_with_width_[static_cast<std::size_t>(p.width)] += counts_[p.kind];
        if (counts_[p.kind] > 0) min_size_[leaves_ + i] = {p.width, p.height};
    }
    for (std::size_t i = leaves_ - 1; i > 0; --i)
        min_size_[i] = {std::min(min_size_[2 * i].width, min_size_[2 * i + 1].width),
                        std::min(min_size_[2 * i].height, min_size_[2 * i + 1].height)};
    narrowest_ = 0;
    while (narrowest_ < max_side_ && left_with_width_[static_cast<std::size_t>(narrowest_)] == 0) ++narrowest_;
    y_.assign(static_cast<std::size_t>(page.width), -1);
    width_.resize(y_.size());
    previous_.resize(y_.size());
    y_[0] = 0;
    width_[0] = page.width;
    previous_[0] = -1;
    heap_.clear();
    push(0);
}

void Skyline::push(int x) {
    heap_.push_back(static_cast<std::uint64_t>(y_[static_cast<std::size_t>(x)]) << 32 | static_cast<std::uint32_t>(x));
    std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
}

/// Merges a segment with its right neighbour if both are level.
void Skyline::merge_with_right(int x) {
    const auto i = static_cast<std::size_t>(x);
    const std::size_t right = i + static_cast<std::size_t>(width_[i]);
    if (right >= y_.size() || y_[right] != y_[i]) return;
    y_[right] = -1;
    width_[i] += width_[right];
    const std::size_t next = right + static_cast<std::size_t>(width_[right]);
    if (next < y_.size()) previous_[next] = x;
}

/// Raises a segment of the skyline to `y` and merges it with neighbours at the same height.
void Skyline::raise(int x, int y) {
    const auto i = static_cast<std::size_t>(x);
    y_[i] = y;
    merge_with_right(x);
    const int before = previous_[i];
    if (before >= 0 && y_[static_cast<std::size_t>(before)] == y) {
        merge_with_right(before);
    } else {
        push(x);
    }
}

Skyline::Gap Skyline::lowest_gap(Size page) {
    for (;;) {
        const auto x = static_cast<int>(heap_.front() & 0xffffffff), y = static_cast<int>(heap_.front() >> 32);
        const auto i = static_cast<std::size_t>(x);
        std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
        heap_.pop_back();
        if (y_[i] != y) continue;
        const std::size_t right = i + static_cast<std::size_t>(width_[i]);
        const int headroom = page.height - y;
        const int left_wall = previous_[i] < 0 ? headroom : y_[static_cast<std::size_t>(previous_[i])] - y;
        const int right_wall = right >= y_.size() ? headroom : y_[right] - y;
        return {x, y, width_[i], left_wall, right_wall, headroom};
    }
}

std::int64_t Skyline::fill(Size page, std::span<const std::uint32_t> counts, const SkylineRules& rules,
                           std::int64_t max_lost, std::vector<PlacedKind>& out) {
    out.clear();
    counts_.assign(counts.begin(), counts.end());
    std::int64_t left = 0;
    for (const Candidate& p : candidates_) {
        if (&p != &candidates_[candidate_of_[p.kind]]) continue;
        left += area_of({p.width, p.height}) * counts_[p.kind];
    }
    if (page.width <= 0 || page.height <= 0) return left;
    start(page);
    std::int64_t lost = 0;
    while (left > 0) {
        const Gap gap = lowest_gap(page);
        if (gap.headroom == 0) break;
        const std::uint32_t chosen = select(gap, rules);
        if (chosen == no_index) {
            const int up = std::min({gap.left_wall, gap.right_wall, gap.headroom});
            lost += std::int64_t{gap.width} * up;
            if (lost > max_lost) break;
            raise(gap.x, gap.y + up);
            continue;
        }
        const Candidate& p = candidates_[chosen];
        bool at_left = true;
        if (p.height != gap.left_wall) {
            switch (rules.side) {
                case GapSide::Left: break;
                case GapSide::HigherWall: at_left = gap.left_wall >= gap.right_wall; break;
                case GapSide::LowerWall: at_left = gap.left_wall <= gap.right_wall; break;
                case GapSide::NearerHeight:
                    at_left = std::abs(gap.left_wall - p.height) <= std::abs(gap.right_wall - p.height);
                    break;
            }
            if (p.height == gap.right_wall) at_left = false;
        }
        const int x = at_left ? gap.x : gap.x + gap.width - p.width;
        out.push_back({p.kind, x, gap.y, p.rotated});
        left -= area_of({p.width, p.height});
        const int rest = gap.width - p.width;
        if (rest > 0) {
            // Split the gap into two segments: the rectangle's and the rest.
            const int second = at_left ? gap.x + p.width : x;
            const auto i = static_cast<std::size_t>(gap.x), j = static_cast<std::size_t>(second);
            const std::size_t next = i + static_cast<std::size_t>(gap.width);
            y_[j] = gap.y;
            width_[j] = gap.x + gap.width - second;
            width_[i] = second - gap.x;
            previous_[j] = gap.x;
            if (next < y_.size()) previous_[next] = second;
            push(at_left ? second : gap.x);
        }
        const int top = gap.y + p.height;
        use(chosen);
        raise(x, top);
    }
    return left;
}

}  // namespace fase::atlas
