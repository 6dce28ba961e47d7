/// The three populations of a pair finder, and the ways between them.
#include "fase/broad/pair_finder.hpp"

#include <algorithm>
#include <tuple>

#include "fase/core/check.hpp"

namespace fase::broad {
namespace {

/// Pairs of the boxes of two structures that share no box. One thread leaves it to the structures, which may walk
/// through both at once; several share out the boxes of the smaller one.
void append_pairs_between(TaskRunner& tasks, const AnyStructure& a, std::span<const Move> in_a, const AnyStructure& b,
                          std::span<const Move> in_b, std::vector<Pair>& out) {
    if (in_a.empty() || in_b.empty()) return;
    if (tasks.threads() == 1) {
        a.find_pairs_between(b, out);
    } else if (in_a.size() < in_b.size()) {
        b.find_pairs_of(tasks, in_a, {}, out);
    } else {
        a.find_pairs_of(tasks, in_b, {}, out);
    }
}

/// Puts into `changed` those of the row that have another box now, and gives them that box.
void take_changed(std::vector<Move>& row, std::span<const Aabb> boxes, std::vector<Move>& changed) {
    changed.clear();
    for (Move& m : row) {
        const Aabb& box = boxes[m.proxy];
        if (m.box == box) continue;
        m.box = box;
        changed.push_back(m);
    }
}

}  // namespace

void PairFinder::build(TaskRunner& tasks, std::span<const Aabb> boxes, std::span<const Population> populations) {
    FASE_ASSERT(boxes.size() == populations.size());
    for (std::vector<Move>* row : {&awake_row_, &asleep_row_, &static_row_}) row->clear();
    populations_.assign(populations.begin(), populations.end());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        std::vector<Move>& row = populations[i] == Population::Static   ? static_row_
                                 : populations[i] == Population::Asleep ? asleep_row_
                                                                        : awake_row_;
        row.push_back({static_cast<Proxy>(i), boxes[i]});
    }
    for (const auto& [structure, row] :
         {std::pair{&awake_, &awake_row_}, std::pair{&asleep_, &asleep_row_}, std::pair{&static_, &static_row_}}) {
        if (automatic_) {
            structure->clear();
            structure->become(*AnyStructure::named(suited_structure({row->size(), 1}, {}).structure));
        }
        structure->build(*row);
    }
    if (automatic_) suit_all(true);
    updates_ = 0;
    resting_.clear();
    asleep_.find_pairs(tasks, resting_);
    append_pairs_between(tasks, asleep_, asleep_row_, static_, static_row_, resting_);
}

void PairFinder::update(std::span<const Aabb> boxes) {
    FASE_ASSERT(boxes.size() == populations_.size());
    take_changed(awake_row_, boxes, changed_);
    awake_.move(changed_);
    wake_changed(boxes);
    constexpr std::uint32_t looks_again = 32;
    if (automatic_) suit_all(++updates_ % looks_again == 0);
    awake_.commit();
    move_static(boxes);
}

void PairFinder::suit_all(bool looks_closely) {
    for (AnyStructure* structure : {&awake_, &asleep_, &static_}) suit(*structure, looks_closely);
}

SuitedStructure PairFinder::chosen(Population population) const {
    const AnyStructure& structure = population == Population::Static   ? static_
                                    : population == Population::Asleep ? asleep_
                                                                       : awake_;
    const std::string_view name = structure.info().name;
    if (!automatic_) return {name, {}};
    return {name, suited_structure({structure.size(), 1}, name).reason};
}

void PairFinder::wake_changed(std::span<const Aabb> boxes) {
    changed_.clear();
    changed_proxies_.clear();
    std::size_t kept = 0;
    for (const Move& m : asleep_row_) {
        const Aabb& box = boxes[m.proxy];
        if (m.box == box) {
            asleep_row_[kept++] = m;
            continue;
        }
        changed_.push_back({m.proxy, box});
        changed_proxies_.push_back(m.proxy);
        populations_[m.proxy] = Population::Awake;
    }
    if (changed_.empty()) return;
    asleep_row_.resize(kept);
    awake_row_.insert(awake_row_.end(), changed_.begin(), changed_.end());
    asleep_.erase(changed_proxies_);
    asleep_.commit();
    awake_.insert(changed_);
    drop_resting([this](Proxy p) { return populations_[p] == Population::Awake; });
}

void PairFinder::move_static(std::span<const Aabb> boxes) {
    take_changed(static_row_, boxes, changed_);
    if (changed_.empty()) return;
    static_.move(changed_);
    static_.commit();
    if (asleep_row_.empty()) return;
    drop_resting([this](Proxy p) {  // changed_ is in the order of the row, which is ascending
        const auto less = [](const Move& m, Proxy q) { return m.proxy < q; };
        const auto at = std::lower_bound(changed_.begin(), changed_.end(), p, less);
        return at != changed_.end() && at->proxy == p;
    });
    asleep_.find_pairs_of(changed_, resting_);
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
    append_pairs_between(tasks, awake_, awake_row_, asleep_, asleep_row_, out);
    append_pairs_between(tasks, awake_, awake_row_, static_, static_row_, out);
}

std::string PairFinder::broken_invariant() const {
    for (const auto& [structure, row, name] : {std::tuple{&awake_, &awake_row_, "awake: "},
                                               {&asleep_, &asleep_row_, "asleep: "},
                                               {&static_, &static_row_, "static: "}}) {
        if (structure->size() != row->size()) return std::string(name) + "the structure has another number of boxes";
        if (const std::string broken = structure->broken_invariant(); !broken.empty()) return name + broken;
    }
    if (awake_row_.size() + asleep_row_.size() + static_row_.size() != populations_.size()) return "a box is lost";
    for (const Pair pair : resting_)
        if (population(pair.a) == Population::Awake || population(pair.b) == Population::Awake)
            return "an awake box is in a resting pair";
    return {};
}

}  // namespace fase::broad
