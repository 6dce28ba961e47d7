/// Finds all pairs of boxes within a radius, frame after frame.
#include "fase/query/detail/neighbour_grid.hpp"

#include <algorithm>

#include "fase/core/detail/prefetch.hpp"
#include "fase/core/no_index.hpp"

namespace fase::query {

using broad::Move;
using broad::Pair;
using broad::Proxy;

namespace {

constexpr std::size_t sample = 256;  // pairs whose numbers are looked at
constexpr double mixed_factor = 8;   // numbers are given anew when pairs lie so much farther apart
constexpr std::size_t pairs_per_task = 8192;

}  // namespace

void NeighbourGrid::commit(std::span<const Proxy> changed, std::size_t proxies) {
    if (!changes_.commit(built_, changed, proxies)) clear();
}

void NeighbourGrid::clear() { *this = NeighbourGrid(); }

std::size_t NeighbourGrid::bytes() const {
    const auto of = [](const auto& list) { return list.capacity() * sizeof list[0]; };
    return sizeof *this + grid_.bytes() + of(number_of_) + of(proxy_of_) + of(boxes_) + of(grown_) + of(free_) +
           of(moved_) + changes_.bytes();
}

void NeighbourGrid::set_box(Number number, const Aabb& box) {
    // More than half of the radius, by more than the rounding here and in squared_distance(): no near pair is missed.
    constexpr float slack = 4e-7f;
    const float half = 0.5f * radius_ * (1 + slack);
    const auto growth = [=](Vec3 v) { return abs(v) * slack + Vec3{half, half, half}; };
    boxes_[number] = box;
    grown_[number] = {box.lo - growth(box.lo), box.hi + growth(box.hi)};
}

void NeighbourGrid::build(const IndexedBoxes& in) {
    proxy_of_.clear();
    for (Proxy p = 0; p < in.states.size(); ++p)
        if (in.states[p] & holds_value) proxy_of_.push_back(p);
    store_all(in);
    std::vector<Proxy> in_rows;
    in_rows.reserve(proxy_of_.size());
    grid_.traverse(broad::Everything{}, [&](Number number, const Aabb&) {
        in_rows.push_back(proxy_of_[number]);
        return true;
    });
    proxy_of_.swap(in_rows);
    store_all(in);
    mixed_ = false;
    inserted_ = 0;
    spread_ = 0;
}

/// Stores all boxes in the grid, numbered by their place in proxy_of_.
void NeighbourGrid::store_all(const IndexedBoxes& in) {
    number_of_.assign(in.states.size(), no_index);
    changes_.forget();
    free_.clear();
    boxes_.resize(proxy_of_.size());
    grown_.resize(proxy_of_.size());
    std::vector<Move> all(proxy_of_.size());
    for (Number number = 0; number < proxy_of_.size(); ++number) {
        number_of_[proxy_of_[number]] = number;
        set_box(number, in.boxes[proxy_of_[number]]);
        all[number] = {number, grown_[number]};
    }
    grid_.build(all);
}

/// Adds and removes boxes.
void NeighbourGrid::insert_and_erase(const IndexedBoxes& in) {
    for (const Proxy p : changes_.proxies()) {
        Number& number = number_of_[p];
        const bool exists = (in.states[p] & holds_value) != 0;
        if (exists == (number != no_index)) continue;
        changes_.settle(p);
        if (!exists) {
            grid_.erase(number);
            free_.push_back(number);
            proxy_of_[number] = no_index;
            number = no_index;
            continue;
        }
        if (free_.empty()) {
            number = static_cast<Number>(proxy_of_.size());
            proxy_of_.push_back(p);
            boxes_.emplace_back();
            grown_.emplace_back();
        } else {
            number = free_.back();
            free_.pop_back();
            proxy_of_[number] = p;
        }
        set_box(number, in.boxes[p]);
        grid_.insert(number, grown_[number]);
        ++inserted_;
    }
}

void NeighbourGrid::follow(const IndexedBoxes& in, TaskRunner* tasks) {
    number_of_.resize(in.states.size(), no_index);
    moved_.clear();
    moved_.reserve(changes_.proxies().size());
    insert_and_erase(in);
    const auto move = [&](Number number, Proxy p) {
        set_box(number, in.boxes[p]);
        moved_.push_back(number);
    };
    if (2 * changes_.proxies().size() > proxy_of_.size()) {  // in the order of the grid, which its memory is in
        constexpr std::size_t ahead = 16;
        for (Number number = 0; number < proxy_of_.size(); ++number) {
            if (number + ahead < proxy_of_.size() && proxy_of_[number + ahead] != no_index)
                detail::prefetch(in.boxes[proxy_of_[number + ahead]]);
            const Proxy p = proxy_of_[number];
            if (p != no_index && changes_.is_pending(p)) move(number, p);
        }
    } else {
        for (const Proxy p : changes_.proxies())
            if (changes_.is_pending(p) && number_of_[p] != no_index) move(number_of_[p], p);
    }
    changes_.forget();
    grid_.move(tasks, std::span<const Number>(moved_), std::span<const Aabb>(grown_));
    tasks != nullptr ? grid_.commit(*tasks) : grid_.commit();
}

void NeighbourGrid::update(const IndexedBoxes& in, float radius, TaskRunner* tasks) {
    const bool other_radius = radius != radius_;
    radius_ = radius;
    try {
        if (!built_ || other_radius || mixed_ || 4 * inserted_ > proxy_of_.size()) {
            build(in);
        } else if (!changes_.proxies().empty()) {
            follow(in, tasks);
        }
    } catch (...) {
        clear();
        throw;
    }
    built_ = true;
}

void NeighbourGrid::keep_near(float limit, TaskRunner* tasks, std::vector<Pair>& pairs) {
    // Without branches: about a quarter of the pairs is too far, in no pattern. Returns the new end.
    const auto keep = [&](std::size_t begin, std::size_t end) {
        std::size_t at = begin;
        for (std::size_t i = begin; i < end; ++i) {
            const Pair pair = pairs[i];
            const Proxy a = proxy_of_[pair.a], b = proxy_of_[pair.b];
            pairs[at] = {std::min(a, b), std::max(a, b)};
            at += squared_distance(boxes_[pair.a], boxes_[pair.b]) <= limit ? 1 : 0;
        }
        return at;
    };
    if (tasks == nullptr || tasks->threads() == 1) {
        pairs.resize(keep(0, pairs.size()));
        return;
    }
    const std::size_t chunks = (pairs.size() + pairs_per_task - 1) / pairs_per_task;
    std::vector<std::size_t> kept(chunks, 0);
    parallel_ranges(*tasks, pairs.size(), pairs_per_task, [&](std::size_t begin, std::size_t end) {
        kept[begin / pairs_per_task] = keep(begin, end) - begin;
    });
    std::size_t at = 0;
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
        const auto from = pairs.begin() + static_cast<std::ptrdiff_t>(chunk * pairs_per_task);
        std::copy(from, from + static_cast<std::ptrdiff_t>(kept[chunk]),
                  pairs.begin() + static_cast<std::ptrdiff_t>(at));
        at += kept[chunk];
    }
    pairs.resize(at);
}

/// Compares how far apart the numbers of pairs are with how far they were when they were given.
void NeighbourGrid::watch_locality(std::span<const Pair> pairs) {
    if (pairs.size() < sample) return;
    double sum = 0;
    for (std::size_t i = 0; i < sample; ++i) {
        const Pair pair = pairs[i * (pairs.size() / sample)];
        sum += pair.a < pair.b ? pair.b - pair.a : pair.a - pair.b;
    }
    const double mean = sum / sample;
    if (spread_ == 0) spread_ = std::max(mean, 1000.0);
    mixed_ = mean > mixed_factor * spread_;
}

void NeighbourGrid::find(const IndexedBoxes& in, float radius, TaskRunner* tasks, std::vector<Pair>& out) {
    changes_.use();
    out.clear();
    update(in, radius, tasks);
    tasks != nullptr ? grid_.find_pairs(*tasks, out) : grid_.find_pairs(out);
    watch_locality(out);
    keep_near(radius * radius, tasks, out);
}

}  // namespace fase::query
