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

/// Stores a box and returns that of the grid. Inlined, because a box that is returned through memory is written in
/// floats and read in vectors, which waits for the cache.
[[gnu::always_inline]] inline Aabb set_box(BoxRow& row, const Aabb& box, float radius) {
    // More than half of the radius, by more than the rounding here and in squared_distance(): no near pair is missed.
    constexpr float slack = 4e-7f;
    const float half = 0.5f * radius * (1 + slack);
    const auto growth = [=](Vec3 v) { return abs(v) * slack + Vec3{half, half, half}; };
    row.lo = box.lo;
    row.hi = box.hi;
    return {box.lo - growth(box.lo), box.hi + growth(box.hi)};
}

}  // namespace

void NeighbourGrid::commit(std::span<const Proxy> changed, std::size_t proxies) {
    if (!changes_.commit(built_, changed, proxies)) clear();
}

void NeighbourGrid::clear() { *this = NeighbourGrid(); }

std::size_t NeighbourGrid::bytes() const {
    const auto of = [](const auto& list) { return list.capacity() * sizeof list[0]; };
    return sizeof *this + grid_.bytes() + of(number_of_) + of(rows_) + of(free_) + of(moved_) + changes_.bytes();
}

void NeighbourGrid::build(const IndexedBoxes& in) {
    std::vector<Proxy> proxies, in_rows;
    for (Proxy p = 0; p < in.states.size(); ++p)
        if (in.states[p] & holds_value) proxies.push_back(p);
    store_all(in, proxies);
    in_rows.reserve(proxies.size());
    grid_.traverse(broad::Everything{}, [&](Number number, const Aabb&) {
        in_rows.push_back(proxies[number]);
        return true;
    });
    store_all(in, in_rows);
    mixed_ = false;
    inserted_ = 0;
    spread_ = 0;
}

/// Stores boxes in the grid, numbered by their place in `proxies`.
void NeighbourGrid::store_all(const IndexedBoxes& in, std::span<const Proxy> proxies) {
    number_of_.assign(in.states.size(), no_index);
    changes_.forget();
    free_.clear();
    rows_.resize(proxies.size());
    std::vector<Move> all(proxies.size());
    for (Number number = 0; number < proxies.size(); ++number) {
        const Proxy p = proxies[number];
        number_of_[p] = number;
        rows_[number].set_proxy(p);
        all[number] = {number, set_box(rows_[number], in.boxes[p], radius_)};
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
            rows_[number].set_proxy(no_index);
            number = no_index;
            continue;
        }
        if (free_.empty()) {
            number = static_cast<Number>(rows_.size());
            rows_.emplace_back();
        } else {
            number = free_.back();
            free_.pop_back();
        }
        rows_[number].set_proxy(p);
        grid_.insert(number, set_box(rows_[number], in.boxes[p], radius_));
        ++inserted_;
    }
}

void NeighbourGrid::follow(const IndexedBoxes& in, TaskRunner* tasks) {
    number_of_.resize(in.states.size(), no_index);
    moved_.clear();
    insert_and_erase(in);
    // In the order of the grid, which its memory is in, if many moved; all of them, if nearly all moved.
    const std::size_t count = changes_.proxies().size();
    const bool all = free_.empty() && 4 * count >= 3 * rows_.size();
    if (!all && 2 * count > rows_.size()) {
        for (Number number = 0; number < rows_.size(); ++number) {
            const Proxy p = rows_[number].proxy();
            if (p != no_index && changes_.is_pending(p)) moved_.push_back(number);
        }
    } else if (!all) {
        for (const Proxy p : changes_.proxies())
            if (changes_.is_pending(p) && number_of_[p] != no_index) moved_.push_back(number_of_[p]);
    }
    changes_.forget();
    const auto move = [&](std::size_t moves, const auto& number_of) {
        constexpr std::size_t ahead = 32;
        const auto box_of = [=, rows = rows_.data(), boxes = in.boxes.data(), radius = radius_](std::size_t k) {
            if (k + ahead < moves) {
                const Aabb& later = boxes[rows[number_of(k + ahead)].proxy()];
                detail::prefetch(later.lo.x);
                detail::prefetch(later.hi.z);
            }
            BoxRow& row = rows[number_of(k)];
            return set_box(row, boxes[row.proxy()], radius);
        };
        grid_.move(tasks, moves, number_of, box_of);
    };
    if (all) {
        move(rows_.size(), [](std::size_t k) { return static_cast<Number>(k); });
    } else {
        move(moved_.size(), [&](std::size_t k) { return moved_[k]; });
    }
    tasks != nullptr ? grid_.commit(*tasks) : grid_.commit();
}

void NeighbourGrid::update(const IndexedBoxes& in, float radius, TaskRunner* tasks) {
    const bool other_radius = radius != radius_;
    radius_ = radius;
    try {
        if (!built_ || other_radius || mixed_ || 4 * inserted_ > rows_.size()) {
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

/// Compares how far apart the numbers of pairs are with how far they were when they were given.
void NeighbourGrid::watch_locality(std::span<const Pair> pairs) {
    if (pairs.size() < sample) return;
    double sum = 0;
    for (std::size_t i = 0; i < sample; ++i) {
        const Pair pair = pairs[i * (pairs.size() / sample)];
        const Number a = number_of_[pair.a], b = number_of_[pair.b];
        sum += a < b ? b - a : a - b;
    }
    const double mean = sum / sample;
    if (spread_ == 0) spread_ = std::max(mean, 1000.0);
    mixed_ = mean > mixed_factor * spread_;
}

void NeighbourGrid::find(const IndexedBoxes& in, float radius, TaskRunner* tasks, std::vector<Pair>& out) {
    changes_.use();
    out.clear();
    update(in, radius, tasks);
    grid_.find_pairs(
        tasks,
        [rows = rows_.data(), limit = radius * radius](Pair* pairs, std::size_t count) {
            return keep_near_pairs(rows, limit, pairs, count);
        },
        out);
    watch_locality(out);
}

}  // namespace fase::query
