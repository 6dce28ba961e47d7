#pragma once
/// Random lives of boxes, led by a structure and by brute force at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "fase/broad/any_structure.hpp"
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

/// The structure under test and the judge, living the same life.
class Lives {
public:
    Lives(std::string_view structure, const Scene& scene, std::uint64_t seed)
        : tested(*AnyStructure::named(structure)),
          judge(*AnyStructure::named("brute_force")),
          scene_(scene),
          random_(seed) {}

    AnyStructure tested, judge;
    std::vector<Proxy> alive;

    void insert(std::size_t count) {
        std::vector<Move> born;
        for (std::size_t i = 0; i < count; ++i) {
            Proxy p;
            if (dead_.empty()) {
                p = next_++;
            } else {
                p = dead_.back();
                dead_.pop_back();
            }
            born.push_back({p, scene_.draw(random_)});
            alive.push_back(p);
        }
        tested.insert(born);
        judge.insert(born);
    }
    /// Each box with the given chance in 16: a nudge, or (one time in four) a leap to a fresh place.
    void move(std::uint64_t chance) {
        std::vector<Move> moved;
        for (const Proxy p : alive) {
            if (random_.below(16) >= chance) continue;
            Aabb box = scene_.draw(random_);
            if (random_.below(4) != 0) box = nudged(p);
            moved.push_back({p, box});
        }
        tested.move(moved);
        judge.move(moved);
    }
    void erase(std::uint64_t chance) {
        std::vector<Proxy> gone;
        for (const Proxy p : alive)
            if (random_.below(16) < chance) gone.push_back(p);
        for (const Proxy p : gone) alive.erase(std::find(alive.begin(), alive.end(), p));
        dead_.insert(dead_.end(), gone.begin(), gone.end());
        tested.erase(gone);
        judge.erase(gone);
    }
    /// Each box with the given chance in 16 falls asleep, or wakes.
    void change_awake(std::uint64_t chance) {
        for (const Proxy p : alive) {
            if (random_.below(16) >= chance) continue;
            const bool awake = random_.below(3) == 0;
            tested.set_awake(std::span(&p, 1), awake);
            judge.set_awake(std::span(&p, 1), awake);
        }
    }
    Aabb draw() { return scene_.draw(random_); }
    void commit() {
        tested.commit();
        judge.commit();
    }
    void expect_same() {
        ASSERT_EQ(tested.broken_invariant(), "");
        ASSERT_EQ(judge.broken_invariant(), "");
        ASSERT_EQ(tested.size(), alive.size());
        ASSERT_EQ(all_pairs(tested), all_pairs(judge));
        for (int i = 0; i < 4; ++i) {
            const Aabb box = scene_.draw(random_);
            ASSERT_EQ(sorted_overlapping(tested, box), sorted_overlapping(judge, box));
        }
    }
    Random& random() { return random_; }

private:
    Scene scene_;
    Random random_;
    Proxy next_ = 0;
    std::vector<Proxy> dead_;

    Aabb nudged(Proxy p) {
        Aabb box;
        judge.traverse(broad::Everything{}, [&](Proxy q, const Aabb& found) {
            if (q == p) box = found;
            return q != p;
        });
        const Vec3 by = point_in(random_, -0.1f, 0.1f);
        return {box.lo + by, box.hi + by};
    }
};

}  // namespace fase::conformance
