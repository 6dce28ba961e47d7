#pragma once
/// The changes that a structure built on demand has yet to take over, and how long it has not been used.
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "fase/broad/structure.hpp"

namespace fase::query {

/// Collects the proxies that changed since the last update of a structure, each once, and counts the commits without a
/// use. Several threads may call use() between two commits.
class PendingChanges {
public:
    using Proxy = broad::Proxy;
    /// A structure that nobody used for so many commits should be freed. Ten seconds of a game, because a new one costs
    /// twenty times as much as the changes of a frame, which a game that asks once a second should not pay each time.
    static constexpr std::uint32_t commits_until_freed = 600;

    PendingChanges() = default;
    PendingChanges(const PendingChanges&) = delete;
    PendingChanges& operator=(PendingChanges&& other) noexcept {
        proxies_ = std::move(other.proxies_);
        flags_ = std::move(other.flags_);
        idle_ = other.idle_;
        used_.store(other.used_.load());
        return *this;
    }

    /// Call whenever the structure is used.
    void use() {
        if (!used_.load(std::memory_order_relaxed)) used_.store(true, std::memory_order_relaxed);
    }
    /// Counts a commit, and notes its changes if the structure exists; proxies are below `proxies`. Returns false when
    /// the structure should be freed. When an allocation fails, changes nothing.
    [[nodiscard]] bool commit(bool exists, std::span<const Proxy> changed, std::size_t proxies) {
        const std::uint32_t idle = used_.load(std::memory_order_relaxed) ? 0 : idle_ + 1;
        const bool keep = !exists || idle < commits_until_freed;
        if (exists && keep) note(changed, proxies);
        idle_ = idle;
        used_.store(false, std::memory_order_relaxed);
        return keep;
    }
    /// Marks one change as taken over: it is no longer pending, but listed until forget().
    void settle(Proxy p) { flags_[p] = 0; }
    /// Forgets the changes, after an update; keeps the memory.
    void forget() {
        for (const Proxy p : proxies_) flags_[p] = 0;
        proxies_.clear();
    }
    /// Forgets the changes and frees the memory.
    void clear() { *this = PendingChanges(); }

    /// The proxies that changed, in the order of their first change.
    [[nodiscard]] std::span<const Proxy> proxies() const { return proxies_; }
    /// Whether a proxy below the number given to commit() is pending.
    [[nodiscard]] bool is_pending(Proxy p) const { return flags_[p] != 0; }
    [[nodiscard]] std::size_t bytes() const { return proxies_.capacity() * sizeof(Proxy) + flags_.capacity(); }

private:
    void note(std::span<const Proxy> changed, std::size_t proxies) {
        if (flags_.size() < proxies) flags_.resize(proxies + proxies / 2, 0);
        proxies_.reserve(std::min(proxies_.size() + changed.size(), flags_.size()));
        for (const Proxy p : changed) {
            if (flags_[p]) continue;
            flags_[p] = 1;
            proxies_.push_back(p);
        }
    }

    std::vector<Proxy> proxies_;
    std::vector<std::uint8_t> flags_;  // by proxy
    std::uint32_t idle_ = 0;           // commits since the last use
    std::atomic<bool> used_ = false;
};

}  // namespace fase::query
