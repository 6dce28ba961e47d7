#include "fase/broad/find_pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "fase/broad/brute_force.hpp"
#include "fase/core/random.hpp"

namespace fase::broad {
namespace {

/// A structure without refinements.
class Plain {
public:
    static constexpr StructureInfo info{"plain", "hides the refinements of brute force", "test"};
    void insert(Proxy p, const Aabb& box) { boxes_.insert(p, box); }
    void move(Proxy p, const Aabb& box) { boxes_.move(p, box); }
    void erase(Proxy p) { boxes_.erase(p); }
    void set_awake(Proxy p, bool awake) { boxes_.set_awake(p, awake); }
    [[nodiscard]] bool is_awake(Proxy p) const { return boxes_.is_awake(p); }
    void clear() { boxes_.clear(); }
    void commit() {}
    template <Region R, class Visit> void traverse(const R& region, Visit&& visit) const {
        boxes_.traverse(region, visit);
    }
    template <class Visit> void for_each_leaf(Visit&& visit) const { boxes_.for_each_leaf(visit); }
    [[nodiscard]] std::size_t nodes() const { return 1; }
    [[nodiscard]] std::size_t size() const { return boxes_.size(); }
    [[nodiscard]] std::size_t bytes() const { return boxes_.bytes(); }
    [[nodiscard]] std::string broken_invariant() const { return boxes_.broken_invariant(); }

private:
    BruteForce boxes_;
};
static_assert(Structure<Plain> && !FindsOwnPairs<Plain> && !Drawable<Plain>);
static_assert(!FindsAwakePairs<Plain> && !BestFirst<Plain> && !CullsBranches<Plain>);
static_assert(FindsOwnPairs<BruteForce> && FindsAwakePairs<BruteForce>);

template <class S> S random_set(std::size_t count, Proxy first) {
    Random random(5);
    S s;
    for (Proxy p = first; p < first + count; ++p) {
        const float x = random.between(0, 9), y = random.between(0, 9), z = random.between(0, 9);
        s.insert(p, {{x, y, z}, {x + 1, y + 1, z + 1}});
    }
    s.commit();
    return s;
}

template <class Find> std::vector<Pair> sorted(Find&& find) {
    std::vector<Pair> pairs;
    find(pairs);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

TEST(FindPairs, QueriesBoxByBoxWithoutRefinements) {
    const auto plain = random_set<Plain>(1200, 10);
    const auto reference = random_set<BruteForce>(1200, 10);
    const std::vector<Pair> expected = sorted([&](auto& out) { find_pairs(reference, out); });
    EXPECT_GT(expected.size(), 1000u);
    EXPECT_EQ(sorted([&](auto& out) { find_pairs(plain, out); }), expected);
    for (const int threads : {1, 2, 3}) {
        const auto tasks = make_thread_runner(threads);
        EXPECT_EQ(sorted([&](auto& out) { find_pairs(*tasks, plain, out); }), expected);
    }
}

TEST(FindPairs, AppendsToExistingPairs) {
    std::vector<Pair> out{{90, 91}};
    find_pairs(random_set<BruteForce>(50, 0), out);
    EXPECT_EQ(out[0], (Pair{90, 91}));
}

TEST(FindPairs, FindsNoneWithAnEmptySet) {
    std::vector<Pair> out;
    find_pairs_between(Plain{}, random_set<BruteForce>(50, 0), out);
    find_pairs_between(random_set<Plain>(50, 0), BruteForce{}, out);
    find_pairs(Plain{}, out);
    const auto tasks = make_thread_runner(2);
    find_pairs(*tasks, Plain{}, out);
    EXPECT_TRUE(out.empty());
}

}  // namespace
}  // namespace fase::broad
