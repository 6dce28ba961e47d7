/// Fills a page from above along a skyline.
#include "fase/atlas/packers/skyline.hpp"

#include <algorithm>
#include <functional>
#include <limits>

namespace fase::atlas {
namespace {

constexpr int nothing_left = std::numeric_limits<int>::max();

}  // namespace

void Skyline::Shelves::prepare(std::span<const Position> positions, int most, bool by_height) {
    const auto key = [&](const Position& p) { return static_cast<std::size_t>(by_height ? p.height : p.width); };
    first.assign(static_cast<std::size_t>(most) + 2, 0);
    for (const Position& p : positions) ++first[key(p) + 1];
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    all.resize(positions.size());
    size.assign(first.begin(), first.end() - 1);  // the next free place of each shelf, for now
    for (std::uint32_t i = 0; i < positions.size(); ++i) all[size[key(positions[i])]++] = i;
}

void Skyline::Shelves::refill() {
    left = all;
    for (std::size_t i = 0; i < size.size(); ++i) size[i] = first[i + 1] - first[i];
}

void Skyline::prepare(std::span<const Kind> kinds, std::span<const std::uint32_t> order, bool may_turn,
                      bool lying_first) {
    positions_.clear();
    positions_of_.assign(kinds.size(), none);
    max_side_ = 0;
    for (const std::uint32_t kind : order) {
        const Kind size = kinds[kind];
        const bool lies = size.width >= size.height;
        const bool turn_first = may_turn && lies != lying_first && size.width != size.height;
        positions_of_[kind] = static_cast<std::uint32_t>(positions_.size());
        const Position upright{size.width, size.height, kind, false}, turned{size.height, size.width, kind, true};
        positions_.push_back(turn_first ? turned : upright);
        if (may_turn && size.width != size.height) positions_.push_back(turn_first ? upright : turned);
        max_side_ = std::max({max_side_, size.width, size.height});
    }
    by_width_.prepare(positions_, max_side_, false);
    by_height_.prepare(positions_, max_side_, true);
    leaves_ = 1;
    while (leaves_ < positions_.size()) leaves_ *= 2;
}

/// The first position on a shelf that is not used up and that `accept` takes; used up ones are taken off.
template <class Accept> std::uint32_t Skyline::first_on(Shelves& shelves, int width, Accept&& accept) {
    if (width > max_side_ || width <= 0) return none;
    const auto shelf = static_cast<std::size_t>(width);
    std::uint32_t* const begin = shelves.left.data() + shelves.first[shelf];
    std::uint32_t kept = 0, i = 0;
    std::uint32_t found = none;
    const std::uint32_t size = shelves.size[shelf];
    for (; i < size && found == none; ++i) {
        const std::uint32_t at = begin[i];
        if (counts_[positions_[at].kind] == 0) continue;
        begin[kept++] = at;
        if (accept(at)) found = at;
    }
    if (kept != i) {
        while (i < size) begin[kept++] = begin[i++];
        shelves.size[shelf] = kept;
    }
    return found;
}

/// The first position in the order that is at most so wide and high.
std::uint32_t Skyline::first_fitting(int width, int height) const {
    const auto may = [&](std::size_t node) { return least_[node].width <= width && least_[node].height <= height; };
    std::size_t node = 1;
    if (!may(node)) return none;
    for (;;) {
        if (node >= leaves_) return static_cast<std::uint32_t>(node - leaves_);
        if (may(2 * node)) {
            node = 2 * node;
            continue;
        }
        node = 2 * node + 1;
        // A branch may hold one that is narrow and another that is low: then the search goes on behind it.
        while (!may(node)) {
            while (node % 2 == 1) node /= 2;
            if (node == 0) return none;
            ++node;
        }
    }
}

std::uint32_t Skyline::choose(const Gap& gap, const SkylineRules& rules) {
    const int higher = std::max(gap.left_wall, gap.right_wall);
    std::uint32_t best = none;
    int best_fit = 0;
    (void)first_on(by_width_, gap.width, [&](std::uint32_t at) {
        const int height = positions_[at].height;
        if (height > gap.room) return false;
        const bool level = height == gap.left_wall || height == gap.right_wall;
        const int fit = level ? (gap.left_wall == gap.right_wall ? 4 : 3) : height < higher ? 2 : 1;
        if (fit > best_fit) {
            best_fit = fit;
            best = at;
        }
        return best_fit == 4;
    });
    if (best != none) return best;
    const int useful = gap.width - narrowest_;  // what is wider leaves a rest that nothing can use
    for (const int wall : {gap.left_wall, gap.right_wall}) {
        if (wall > gap.room) continue;
        best = std::min(best,
                        first_on(by_height_, wall, [&](std::uint32_t at) { return positions_[at].width <= useful; }));
    }
    if (best != none) return best;
    best = first_fitting(useful, gap.room);
    if (best != none) return best;
    if (!rules.widest_last) return first_fitting(gap.width - 1, gap.room);
    for (int width = std::min(gap.width - 1, max_side_); width > std::max(useful, 0); --width) {
        if (left_with_[static_cast<std::size_t>(width)] == 0) continue;
        best = first_on(by_width_, width, [&](std::uint32_t at) { return positions_[at].height <= gap.room; });
        if (best != none) return best;
    }
    return none;
}

/// Counts one of a kind as laid down.
void Skyline::use(std::uint32_t position) {
    const Position& used = positions_[position];
    const std::uint32_t left = --counts_[used.kind];
    const std::uint32_t first = positions_of_[used.kind];
    for (std::uint32_t at = first; at < positions_.size() && positions_[at].kind == used.kind; ++at) {
        --left_with_[static_cast<std::size_t>(positions_[at].width)];
        if (left > 0) continue;
        std::size_t node = leaves_ + at;
        least_[node] = {nothing_left, nothing_left};
        for (node /= 2; node > 0; node /= 2) {
            const Size a = least_[2 * node], b = least_[2 * node + 1];
            const Size least{std::min(a.width, b.width), std::min(a.height, b.height)};
            if (least == least_[node]) break;
            least_[node] = least;
        }
    }
    while (narrowest_ < max_side_ && left_with_[static_cast<std::size_t>(narrowest_)] == 0) ++narrowest_;
}

void Skyline::start(Size page) {
    by_width_.refill();
    by_height_.refill();
    left_with_.assign(static_cast<std::size_t>(max_side_) + 1, 0);
    least_.assign(2 * leaves_, {nothing_left, nothing_left});
    for (std::size_t i = 0; i < positions_.size(); ++i) {
        const Position& p = positions_[i];
        left_with_[static_cast<std::size_t>(p.width)] += counts_[p.kind];
        if (counts_[p.kind] > 0) least_[leaves_ + i] = {p.width, p.height};
    }
    for (std::size_t i = leaves_ - 1; i > 0; --i)
        least_[i] = {std::min(least_[2 * i].width, least_[2 * i + 1].width),
                     std::min(least_[2 * i].height, least_[2 * i + 1].height)};
    narrowest_ = 0;
    while (narrowest_ < max_side_ && left_with_[static_cast<std::size_t>(narrowest_)] == 0) ++narrowest_;
    y_.assign(static_cast<std::size_t>(page.width), -1);
    width_.resize(y_.size());
    before_.resize(y_.size());
    y_[0] = 0;
    width_[0] = page.width;
    before_[0] = -1;
    heap_.clear();
    push(0);
}

void Skyline::push(int x) {
    heap_.push_back(static_cast<std::uint64_t>(y_[static_cast<std::size_t>(x)]) << 32 | static_cast<std::uint32_t>(x));
    std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
}

/// Makes one part of two that are level.
void Skyline::merge_with_right(int x) {
    const auto i = static_cast<std::size_t>(x);
    const std::size_t right = i + static_cast<std::size_t>(width_[i]);
    if (right >= y_.size() || y_[right] != y_[i]) return;
    y_[right] = -1;
    width_[i] += width_[right];
    const std::size_t next = right + static_cast<std::size_t>(width_[right]);
    if (next < y_.size()) before_[next] = x;
}

/// Raises a part of the skyline to `y` and joins it with neighbours that are level with it.
void Skyline::raise(int x, int y) {
    const auto i = static_cast<std::size_t>(x);
    y_[i] = y;
    merge_with_right(x);
    const int before = before_[i];
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
        const int room = page.height - y;
        const int left_wall = before_[i] < 0 ? room : y_[static_cast<std::size_t>(before_[i])] - y;
        const int right_wall = right >= y_.size() ? room : y_[right] - y;
        return {x, y, width_[i], left_wall, right_wall, room};
    }
}

std::int64_t Skyline::fill(Size page, std::span<const std::uint32_t> counts, const SkylineRules& rules,
                           std::int64_t max_lost, std::vector<Laid>& out) {
    out.clear();
    counts_.assign(counts.begin(), counts.end());
    std::int64_t left = 0;
    for (const Position& p : positions_) {
        if (&p != &positions_[positions_of_[p.kind]]) continue;
        left += area_of({p.width, p.height}) * counts_[p.kind];
    }
    if (page.width <= 0 || page.height <= 0) return left;
    start(page);
    std::int64_t lost = 0;
    while (left > 0) {
        const Gap gap = lowest_gap(page);
        if (gap.room == 0) break;
        const std::uint32_t chosen = choose(gap, rules);
        if (chosen == none) {
            const int up = std::min({gap.left_wall, gap.right_wall, gap.room});
            lost += std::int64_t{gap.width} * up;
            if (lost > max_lost) break;
            raise(gap.x, gap.y + up);
            continue;
        }
        const Position& p = positions_[chosen];
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
        out.push_back({p.kind, x, gap.y, p.turned});
        left -= area_of({p.width, p.height});
        const int rest = gap.width - p.width;
        if (rest > 0) {
            // The gap becomes two parts: the rectangle's and the rest.
            const int second = at_left ? gap.x + p.width : x;
            const auto i = static_cast<std::size_t>(gap.x), j = static_cast<std::size_t>(second);
            const std::size_t next = i + static_cast<std::size_t>(gap.width);
            y_[j] = gap.y;
            width_[j] = gap.x + gap.width - second;
            width_[i] = second - gap.x;
            before_[j] = gap.x;
            if (next < y_.size()) before_[next] = second;
            push(at_left ? second : gap.x);
        }
        const int top = gap.y + p.height;
        use(chosen);
        raise(x, top);
    }
    return left;
}

}  // namespace fase::atlas
