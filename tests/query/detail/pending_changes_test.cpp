#include "fase/query/detail/pending_changes.hpp"

#include <gtest/gtest.h>

namespace fase::query {
namespace {

using Proxies = std::vector<broad::Proxy>;
Proxies pending(const PendingChanges& changes) { return {changes.proxies().begin(), changes.proxies().end()}; }

TEST(PendingChanges, ListsEachProxyOnceUntilItIsForgotten) {
    PendingChanges changes;
    EXPECT_TRUE(changes.commit(true, Proxies{3, 1}, 4));
    EXPECT_TRUE(changes.commit(true, Proxies{1, 9}, 10));
    EXPECT_EQ(pending(changes), (Proxies{3, 1, 9}));
    changes.settle(1);
    EXPECT_TRUE(changes.is_pending(3) && changes.is_pending(9));
    EXPECT_FALSE(changes.is_pending(1) || changes.is_pending(2));
    changes.forget();
    EXPECT_EQ(pending(changes), Proxies{});
    EXPECT_FALSE(changes.is_pending(3));
    EXPECT_TRUE(changes.commit(true, Proxies{3}, 10));
    EXPECT_EQ(pending(changes), Proxies{3});
}

TEST(PendingChanges, AStructureThatDoesNotExistHasNoChanges) {
    PendingChanges changes;
    for (int i = 0; i < 100; ++i) EXPECT_TRUE(changes.commit(false, Proxies{3, 1}, 4));
    EXPECT_EQ(pending(changes), Proxies{});
}

TEST(PendingChanges, TellsAfter600CommitsWithoutAUse) {
    PendingChanges changes;
    changes.use();
    for (int round = 0; round < 2; ++round) {
        EXPECT_TRUE(changes.commit(true, {}, 0)) << "it was used";
        for (int i = 1; i < 600; ++i) EXPECT_TRUE(changes.commit(true, {}, 0)) << i;
        if (round == 0) changes.use();
    }
    EXPECT_FALSE(changes.commit(true, {}, 0));
}

}  // namespace
}  // namespace fase::query
