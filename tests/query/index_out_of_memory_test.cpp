// An index in which the Nth allocation fails, for every N and every structure.
#include "fase/broad/registry.hpp"
#include "fase/core/random.hpp"
#include "fase/query/detail/pending_changes.hpp"
#include "fase/query/index.hpp"

#include <gtest/gtest.h>

#include "tests/failing_memory.hpp"

#ifndef FASE_TEST_SANITIZED
namespace fase {
namespace {

using namespace test;

Aabb random_box(Random& random) {
    const Vec3 at{random.between(-9, 9), random.between(-9, 9), random.between(-9, 9)};
    return {at, at + Vec3{1, 1, 1}};
}

template <class S> std::string_view name_of() {
    if constexpr (broad::Structure<S>) return S::info.name;
    return "on demand";
}

/// A program of edits and commits; each is tried again when memory ran out. Returns what the index then finds.
template <class S> std::vector<int> play(long n, long& failures) {
    const auto at = [n] { return std::string(name_of<S>()) + " at " + std::to_string(n); };
    Index<int, S> index;
    std::vector<typename Index<int, S>::Id> ids;
    ids.reserve(400);
    Random random(3);
    const auto commit = [&] {
        bool done = false;
        EXPECT_TRUE(run_with_failing_allocation(n, [&] { done = index.commit(); })) << at();
        EXPECT_TRUE(done || an_allocation_failed);
        failures += an_allocation_failed ? 1 : 0;
        if (!done) {
            EXPECT_TRUE(index.commit());
        }
    };
    for (int round = 0; round < 6; ++round) {
        for (int i = 0; i < 40; ++i) {
            const Aabb box = random_box(random);
            typename Index<int, S>::Id id;
            EXPECT_TRUE(run_with_failing_allocation(n, [&] { id = index.insert(box, 100 * round + i); }));
            failures += an_allocation_failed ? 1 : 0;
            if (!index.contains(id)) {
                EXPECT_TRUE(an_allocation_failed);
                EXPECT_EQ(index.size(), ids.size());
                id = index.insert(box, 100 * round + i);
            }
            ids.push_back(id);
        }
        commit();
        for (std::size_t i = 0; i < ids.size(); i += 3) EXPECT_TRUE(index.move(ids[i], random_box(random)));
        for (std::size_t i = 0; i < ids.size(); i += 5) EXPECT_TRUE(index.set_awake(ids[i], round % 2 == 0));
        commit();
        for (int i = 0; i < 10; ++i) {
            EXPECT_TRUE(index.erase(ids.back()));
            ids.pop_back();
        }
        commit();
        EXPECT_EQ(index.structure().broken_invariant(), "");
    }
    // A query of the default structure may build one; it throws before it calls back, and the next call works.
    std::vector<int> found;
    const auto ask = [&](const auto& question) {
        const std::size_t before = found.size();
        if (run_with_failing_allocation(n, question)) {
            failures += an_allocation_failed ? 1 : 0;
            if (!an_allocation_failed) return;
        } else {
            ++failures;
            found.resize(before);
        }
        found.resize(before);
        question();
    };
    found.reserve(100'000);
    index.for_each([&](int value) { found.push_back(value); });
    ask([&] { index.pairs(in_order, [&](int a, int b) { found.push_back(1000 * a + b); }); });
    ask([&] { index.neighbours(in_order, 0.5f, [&](int a, int b) { found.push_back(1000 * a + b); }); });
    ask([&] { index.awake_pairs([&](int a, int b) { found.push_back(1000 * a + b); }); });
    ask([&] {
        index.overlapping(in_order, Aabb{{-3, -3, -3}, {3, 3, 3}}, [&](int value) { found.push_back(value); });
    });
    ask([&] {
        for (const auto& hit : index.nearest({0, 0, 0}, 5)) found.push_back(index.value(hit.id));
    });
    return found;
}

template <class S> void fail_each_allocation() {
    long none = 0;
    const std::vector<int> right = play<S>(-1, none);
    EXPECT_EQ(none, 0);
    for (long n = 0;; ++n) {
        ASSERT_LT(n, 3000);
        long failures = 0;
        ASSERT_EQ(play<S>(n, failures), right) << name_of<S>() << " at " << n;
        if (failures == 0) break;
    }
}

TEST(IndexOutOfMemory, changes_nothing_and_the_next_call_works) {
    fail_each_allocation<query::OnDemand>();
    broad::for_each_structure([]<broad::Structure S>() { fail_each_allocation<S>(); });
}

TEST(IndexOutOfMemory, a_commit_of_pending_changes_changes_nothing) {
    using Proxies = std::vector<broad::Proxy>;
    const Proxies first{3, 1}, second{2, 7, 1};
    const auto pending = [](const query::PendingChanges& changes) {
        return Proxies(changes.proxies().begin(), changes.proxies().end());
    };
    for (long n = 0;; ++n) {
        ASSERT_LT(n, 10);
        query::PendingChanges changes;
        ASSERT_TRUE(changes.commit(true, first, 4));
        changes.use();
        if (run_with_failing_allocation(n, [&] { (void)changes.commit(true, second, 8); })) {
            EXPECT_EQ(pending(changes), (Proxies{3, 1, 2, 7}));
            break;
        }
        EXPECT_EQ(pending(changes), first);
        for (int i = 0; i < 600; ++i) ASSERT_TRUE(changes.commit(true, {}, 8)) << "the use still counts";
    }
}

}  // namespace
}  // namespace fase
#endif
