/// The three populations of a pair finder, and the ways between them.
#include "fase/broad/pair_finder.hpp"

#include <algorithm>
#include <cstring>

#include "fase/core/check.hpp"

namespace fase::broad {
namespace {

/// Appends the places at which the boxes are others than before, bit by bit, in order; `before` is as they are then.
void take_changed(std::span<const Aabb> boxes, std::span<Aabb> before, std::vector<Proxy>& changed) {
    static_assert(sizeof(Aabb) == 24);
    const auto word = [](const Aabb& box, int k) {
        std::uint64_t bits;
        std::memcpy(&bits, reinterpret_cast<const char*>(&box) + 8 * k, 8);
        return bits;
    };
    changed.resize(boxes.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Aabb &old = before[i], &now = boxes[i];
        const std::uint64_t differing =
            (word(old, 0) ^ word(now, 0)) | (word(old, 1) ^ word(now, 1)) | (word(old, 2) ^ word(now, 2));
        changed[count] = static_cast<Proxy>(i);
        count += differing != 0 ? 1 : 0;
    }
    changed.resize(count);
    if (2 * count > boxes.size()) {
        std::copy(boxes.begin(), boxes.end(), before.begin());
    } else {
        for (const Proxy p : changed) before[p] = boxes[p];
    }
}

}  // namespace

void PairFinder::build(TaskRunner& tasks, std::span<const Aabb> boxes, std::span<const Population> populations) {
    FASE_ASSERT(boxes.size() == populations.size());
    boxes_.assign(boxes.begin(), boxes.end());
    populations_.assign(populations.begin(), populations.end());
    std::vector<Move> row;
    for (const Population population : {Population::Awake, Population::Asleep, Population::Static}) {
        row.clear();
        for (std::size_t i = 0; i < boxes.size(); ++i)
            if (populations[i] == population) row.push_back({static_cast<Proxy>(i), boxes[i]});
        AnyStructure& structure = structure_of(*this, population);
        if (automatic_) {
            structure.clear();
            structure.become(*AnyStructure::named(suited_structure({row.size(), 1}, {}).structure));
        }
        structure.build(row);
    }
    if (automatic_) suit_all(true);
    updates_ = 0;
    resting_.clear();
    asleep_.find_pairs(tasks, resting_);
    asleep_.find_pairs_between(tasks, static_, resting_);
}

void PairFinder::update(std::span<const Aabb> boxes) {
    FASE_ASSERT(boxes.size() == populations_.size());
    take_changed(boxes, boxes_, changed_);
    if (awake_.size() == boxes.size()) {
        awake_.move(changed_, boxes_);
    } else {
        auto& [awake, woken, fixed] = changed_of_;
        for (std::vector<Proxy>* list : {&awake, &woken, &fixed}) list->clear();
        for (const Proxy p : changed_)
            (populations_[p] == Population::Static   ? fixed
             : populations_[p] == Population::Asleep ? woken
                                                     : awake)
                .push_back(p);
        awake_.move(awake, boxes_);
        if (!woken.empty()) wake(woken);
        if (!fixed.empty()) move_static(fixed);
    }
    constexpr std::uint32_t looks_again = 32;
    if (automatic_) suit_all(++updates_ % looks_again == 0);
    awake_.commit();
}

void PairFinder::suit_all(bool looks_closely) {
    for (AnyStructure* structure : {&awake_, &asleep_, &static_}) suit(*structure, looks_closely);
}

SuitedStructure PairFinder::chosen(Population population) const {
    const AnyStructure& structure = structure_of(*this, population);
    const std::string_view name = structure.info().name;
    if (!automatic_) return {name, {}};
    return {name, suited_structure({structure.size(), 1}, name).reason};
}

void PairFinder::wake(std::span<const Proxy> proxies) {
    for (const Proxy p : proxies) populations_[p] = Population::Awake;
    asleep_.erase(proxies);
    asleep_.commit();
    awake_.insert(proxies, boxes_);
    drop_resting([this](Proxy p) { return populations_[p] == Population::Awake; });
}

void PairFinder::move_static(std::span<const Proxy> proxies) {
    static_.move(proxies, boxes_);
    static_.commit();
    if (asleep_.size() == 0) return;
    drop_resting([&](Proxy p) { return std::binary_search(proxies.begin(), proxies.end(), p); });
    std::vector<Move> askers;
    for (const Proxy p : proxies) askers.push_back({p, boxes_[p]});
    asleep_.find_pairs_of(askers, resting_);
}

template <class F> void PairFinder::drop_resting(const F& goes) {
    const auto gone = [&](Pair pair) { return goes(pair.a) || goes(pair.b); };
    resting_.erase(std::remove_if(resting_.begin(), resting_.end(), gone), resting_.end());
}

void PairFinder::find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const {
    out.insert(out.end(), resting_.begin(), resting_.end());
    find_awake_pairs(tasks, out);
}

void PairFinder::find_awake_pairs(TaskRunner& tasks, std::vector<Pair>& out) const {
    awake_.find_pairs(tasks, out);
    awake_.find_pairs_between(tasks, asleep_, out);
    awake_.find_pairs_between(tasks, static_, out);
}

std::string PairFinder::broken_invariant() const {
    for (const auto& [population, name] : {std::pair{Population::Awake, "awake: "},
                                           {Population::Asleep, "asleep: "},
                                           {Population::Static, "static: "}}) {
        const AnyStructure& structure = structure_of(*this, population);
        const auto here = std::count(populations_.begin(), populations_.end(), population);
        if (structure.size() != static_cast<std::size_t>(here))
            return std::string(name) + "the structure has another number of boxes";
        if (const std::string broken = structure.broken_invariant(); !broken.empty()) return name + broken;
    }
    for (const Pair pair : resting_)
        if (population(pair.a) == Population::Awake || population(pair.b) == Population::Awake)
            return "an awake box is in a resting pair";
    return {};
}

}  // namespace fase::broad
