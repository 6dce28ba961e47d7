/// Structures that are built and updated by their first use after a commit.
#include "fase/query/on_demand.hpp"

#include "fase/broad/find_pairs.hpp"

namespace fase::query {

using broad::Move;
using broad::Proxy;

TaskRunner& serial_tasks() {
    static const std::unique_ptr<TaskRunner> tasks = make_serial_runner();
    return *tasks;
}

template <class S> void LazyStructure<S>::commit(std::span<const Proxy> changed, std::size_t proxies) {
    if (!changes_.commit(built_, changed, proxies)) return clear();
    if (!changed.empty()) current_.store(false, std::memory_order_relaxed);
}

template <class S> void LazyStructure<S>::clear() {
    structure_ = S();
    changes_.clear();
    moved_ = {};
    is_stored_ = {};
    built_ = false;
    current_ = false;
}

template <class S> std::size_t LazyStructure<S>::bytes() const {
    return structure_.bytes() + changes_.bytes() + moved_.capacity() * sizeof(Proxy) + is_stored_.capacity();
}

template <class S> void LazyStructure<S>::build(const IndexedBoxes& in) {
    is_stored_.assign(in.states.size(), 0);
    std::vector<Move> all;
    for (Proxy p = 0; p < in.states.size(); ++p) {
        if (!(in.states[p] & holds_value)) continue;
        all.push_back({p, in.boxes[p]});
        is_stored_[p] = 1;
    }
    structure_.build(all);
    bool any_rests = false;
    for (const Move& stored : all)
        if (!(in.states[stored.proxy] & is_awake)) {
            structure_.set_awake(stored.proxy, false);
            any_rests = true;
        }
    if (any_rests) structure_.commit();
}

template <class S> void LazyStructure<S>::follow(const IndexedBoxes& in, TaskRunner* tasks) {
    const std::span<const Proxy> changed = changes_.proxies();
    if (is_stored_.size() < in.states.size()) is_stored_.resize(in.states.size(), 0);
    moved_.clear();
    moved_.reserve(changed.size());
    const std::span<const Aabb> boxes = in.boxes;
    for (const Proxy p : changed) {
        const bool stored = is_stored_[p] != 0, exists = (in.states[p] & holds_value) != 0;
        is_stored_[p] = exists ? 1 : 0;
        if (!exists) {
            if (stored) structure_.erase(p);
            continue;
        }
        if (stored) {
            moved_.push_back(p);
        } else {
            structure_.insert(p, boxes[p]);
        }
    }
    if constexpr (broad::MovesInBulk<S>) {
        structure_.move(tasks, moved_, boxes);
    } else {
        for (const Proxy p : moved_) structure_.move(p, boxes[p]);
    }
    for (const Proxy p : changed) {
        const bool awake = in.states[p] & is_awake;
        if (is_stored_[p] && structure_.is_awake(p) != awake) structure_.set_awake(p, awake);
    }
    if constexpr (broad::CommitsInParallel<S>) {
        if (tasks != nullptr) return structure_.commit(*tasks);
    }
    structure_.commit();
}

template <class S> void LazyStructure<S>::update(const IndexedBoxes& in, TaskRunner* tasks) {
    try {
        if (built_) {
            follow(in, tasks);
        } else {
            build(in);
        }
    } catch (...) {
        clear();
        throw;
    }
    changes_.forget();
    built_ = true;
}

template <class S> const S& LazyStructure<S>::current(const IndexedBoxes& in, TaskRunner* tasks) {
    changes_.use();
    if (current_.load(std::memory_order_acquire)) return structure_;
    const std::lock_guard guard(lock_);
    if (current_.load(std::memory_order_relaxed)) return structure_;
    update(in, tasks);
    current_.store(true, std::memory_order_release);
    return structure_;
}

template class LazyStructure<broad::RowGrid>;
template class LazyStructure<broad::WideBvh>;

void OnDemand::commit(std::span<const Proxy> changed, const IndexedBoxes& in) {
    if (!parts_) parts_ = std::make_unique<Parts>();
    parts_->in = in;
    parts_->rows.commit(changed, in.states.size());
    parts_->tree.commit(changed, in.states.size());
}

void OnDemand::clear() {
    if (!parts_) return;
    parts_->rows.clear();
    parts_->tree.clear();
}

std::string OnDemand::broken_invariant() const {
    if (!parts_) return "";
    const std::string rows = parts_->rows.broken_invariant();
    return rows.empty() ? parts_->tree.broken_invariant() : rows;
}

std::size_t OnDemand::bytes() const {
    return sizeof(*this) + (parts_ ? sizeof(Parts) + parts_->rows.bytes() + parts_->tree.bytes() : 0);
}

}  // namespace fase::query
