#pragma once
/// Random sequences of operations, applied both to a structure and to brute force as the reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "fase/broad/any_structure.hpp"
#include "fase/broad/registry.hpp"
#include "tests/conformance/scenes.hpp"

namespace fase::conformance {

using broad::AnyStructure;
using broad::Move;
using broad::Pair;
using broad::Proxy;

inline std::vector<std::string> structure_names() {
    std::vector<std::string> names;
    broad::for_each_structure([&]<broad::Structure S>() { names.emplace_back(S::info.name); });
    return names;
}

template <class Find> std::vector<Pair> sorted_pairs(Find&& find) {
    std::vector<Pair> pairs;
    find(pairs);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}
inline std::vector<Pair> all_pairs(const AnyStructure& s) {
    return sorted_pairs([&](auto& out) { s.find_pairs(out); });
}
inline std::vector<Proxy> sorted_overlapping(const AnyStructure& s, const Aabb& box) {
    std::vector<Proxy> found;
    s.overlapping(box, found);
    std::sort(found.begin(), found.end());
    return found;
}

/// The structure under test and the reference, with the same operations applied to both.
class DifferentialRun {
public:
    DifferentialRun(std::string_view structure, const Scene& scene, std::uint64_t seed)
        : tested(*AnyStructure::named(structure)),
          reference(*AnyStructure::named("brute_force")),
          scene_(scene),
          random_(seed) {}

    AnyStructure tested, reference;
    std::vector<Proxy> stored;

    void insert(std::size_t count) {
        std::vector<Move> added;
        for (std::size_t i = 0; i < count; ++i) {
            Proxy p;
            if (free_proxies_.empty()) {
                p = next_++;
            } else {
                p = free_proxies_.back();
                free_proxies_.pop_back();
            }
            added.push_back({p, scene_.draw(random_)});
            stored.push_back(p);
        }
        tested.insert(added);
        reference.insert(added);
    }
    /// Moves each box with the given chance in 16: slightly, or (one time in four) to a new position.
    void move(std::uint64_t chance) {
        std::vector<Move> moved;
        for (const Proxy p : stored) {
            if (random_.below(16) >= chance) continue;
            Aabb box = scene_.draw(random_);
            if (random_.below(4) != 0) box = nudged(p);
            moved.push_back({p, box});
        }
        tested.move(moved);
        reference.move(moved);
    }
    void erase(std::uint64_t chance) {
        std::vector<Proxy> erased;
        for (const Proxy p : stored)
            if (random_.below(16) < chance) erased.push_back(p);
        for (const Proxy p : erased) stored.erase(std::find(stored.begin(), stored.end(), p));
        free_proxies_.insert(free_proxies_.end(), erased.begin(), erased.end());
        tested.erase(erased);
        reference.erase(erased);
    }
    /// Puts each box to sleep, or wakes it, with the given chance in 16.
    void change_awake(std::uint64_t chance) {
        for (const Proxy p : stored) {
            if (random_.below(16) >= chance) continue;
            const bool awake = random_.below(3) == 0;
            tested.set_awake(std::span(&p, 1), awake);
            reference.set_awake(std::span(&p, 1), awake);
        }
    }
    Aabb draw() { return scene_.draw(random_); }
    void commit() {
        tested.commit();
        reference.commit();
    }
    void expect_same() {
        ASSERT_EQ(tested.broken_invariant(), "");
        ASSERT_EQ(reference.broken_invariant(), "");
        ASSERT_EQ(tested.size(), stored.size());
        ASSERT_EQ(all_pairs(tested), all_pairs(reference));
        for (int i = 0; i < 4; ++i) {
            const Aabb box = scene_.draw(random_);
            ASSERT_EQ(sorted_overlapping(tested, box), sorted_overlapping(reference, box));
        }
    }
    Random& random() { return random_; }

private:
    Scene scene_;
    Random random_;
    Proxy next_ = 0;
    std::vector<Proxy> free_proxies_;

    Aabb nudged(Proxy p) {
        Aabb box;
        reference.traverse(broad::Everything{}, [&](Proxy q, const Aabb& found) {
            if (q == p) box = found;
            return q != p;
        });
        const Vec3 by = point_in(random_, -0.1f, 0.1f);
        return {box.lo + by, box.hi + by};
    }
};

}  // namespace fase::conformance
