/// Ids: valid ids are found; stale, foreign and random ids are refused.
#include "fase/core/ids.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <set>
#include <unordered_map>
#include <vector>

#include "fase/core/random.hpp"

namespace fase {
namespace {

struct Thing;
using ThingId = Id<Thing>;
using Pool = IdPool<Thing>;

TEST(Id, by_default_identifies_no_object) {
    Pool pool(0);
    EXPECT_FALSE(pool.contains({}));
    (void)pool.add();
    EXPECT_FALSE(pool.contains({}));
    EXPECT_EQ(sizeof(ThingId), 8u);
}

TEST(IdPool, issues_dense_indices_from_0_and_reuses_the_last_freed_first) {
    Pool pool(7);
    const ThingId a = pool.add(), b = pool.add(), c = pool.add();
    EXPECT_EQ(a.index, 0u);
    EXPECT_EQ(b.index, 1u);
    EXPECT_EQ(c.index, 2u);
    EXPECT_EQ(a.owner, 7);
    EXPECT_TRUE(pool.remove(a));
    EXPECT_TRUE(pool.remove(b));
    EXPECT_EQ(pool.count(), 1u);
    EXPECT_EQ(pool.size(), 3u);
    const ThingId d = pool.add();
    EXPECT_EQ(d.index, b.index);
    EXPECT_NE(d, b);
    EXPECT_EQ(pool.id_at(1), d);
    EXPECT_EQ(pool.id_at(0), std::nullopt);
    EXPECT_EQ(pool.id_at(9), std::nullopt);
    EXPECT_FALSE(pool.alive_at(9));
}

TEST(IdPool, refuses_a_stale_id_after_its_slot_is_reused) {
    Pool pool(1);
    const ThingId old = pool.add();
    EXPECT_TRUE(pool.remove(old));
    EXPECT_FALSE(pool.contains(old));
    EXPECT_FALSE(pool.remove(old)) << "twice";
    const ThingId reused = pool.add();
    ASSERT_EQ(reused.index, old.index);
    EXPECT_FALSE(pool.contains(old));
    EXPECT_FALSE(pool.remove(old));
    EXPECT_TRUE(pool.contains(reused));
}

TEST(IdPool, refuses_the_ids_of_another_pool) {
    Pool mine(1), other(2);
    const ThingId foreign = other.add();
    const ThingId own = mine.add();
    EXPECT_EQ(foreign.index, own.index);
    EXPECT_EQ(foreign.generation, own.generation);
    EXPECT_FALSE(mine.contains(foreign));
    EXPECT_FALSE(mine.remove(foreign));
    EXPECT_TRUE(mine.contains(own));
}

TEST(IdPool, refuses_random_numbers) {
    Pool pool(3);
    for (int i = 0; i < 1000; ++i) (void)pool.add();
    Random random(1);
    for (int i = 0; i < 1000000; ++i) {
        const std::uint64_t bits = random.next();
        const auto id = std::bit_cast<ThingId>(bits);
        // Valid by chance: a real owner, index and generation.
        const bool real = id.owner == 3 && id.index < 1000 && id.generation == 1;
        ASSERT_EQ(pool.contains(id), real);
    }
}

TEST(IdPool, retires_a_slot_whose_generations_are_used_up) {
    Pool pool(1);
    const ThingId first = pool.add();
    ThingId last = first;
    for (int i = 1; i < 65535; ++i) {
        ASSERT_TRUE(pool.remove(last));
        last = pool.add();
        ASSERT_EQ(last.index, first.index) << "generation " << i;
        ASSERT_NE(last, first);
    }
    EXPECT_EQ(last.generation, 65535);
    EXPECT_TRUE(pool.remove(last));
    const ThingId next = pool.add();
    EXPECT_NE(next.index, first.index) << "the retired slot must not be reused with an old generation";
    EXPECT_FALSE(pool.contains(first));
    EXPECT_FALSE(pool.contains(last));
    EXPECT_FALSE(pool.alive_at(first.index));
    EXPECT_EQ(pool.count(), 1u);
}

TEST(IdPool, restored_from_its_parts_continues_as_before) {
    Pool pool(1);
    std::vector<ThingId> ids;
    for (int i = 0; i < 20; ++i) ids.push_back(pool.add());
    for (const std::size_t i : {3u, 17u, 5u}) (void)pool.remove(ids[i]);
    Pool copy(1);
    ASSERT_TRUE(copy.restore(pool.slots(), pool.free_list(), pool.newest()));
    EXPECT_EQ(copy.count(), pool.count());
    EXPECT_EQ(copy.size(), pool.size());
    for (const ThingId id : ids) EXPECT_EQ(copy.contains(id), pool.contains(id));
    for (int i = 0; i < 6; ++i) EXPECT_EQ(copy.add(), pool.add());
}

TEST(IdPool, refuses_parts_that_no_pool_has) {
    using Slots = std::vector<Pool::Slot>;
    Pool pool(1);
    EXPECT_TRUE(pool.restore(Slots{{1, true}, {2, false}}, {1}, {1, 2}));
    EXPECT_FALSE(pool.restore(Slots{{1, true}, {2, false}}, {0, 1}, {1, 2})) << "a slot in use is free";
    EXPECT_FALSE(pool.restore(Slots{{1, true}, {2, false}}, {1, 1}, {1, 2})) << "a slot is free twice";
    EXPECT_FALSE(pool.restore(Slots{{1, true}, {2, false}}, {}, {1, 2})) << "a free slot is not listed";
    EXPECT_FALSE(pool.restore(Slots{{1, true}, {2, false}}, {7}, {1, 2})) << "no such slot";
    EXPECT_FALSE(pool.restore(Slots{{3, true}}, {}, {2})) << "a generation that was not issued";
    EXPECT_FALSE(pool.restore(Slots{{0, true}}, {}, {2})) << "generation 0";
    EXPECT_FALSE(pool.restore(Slots{{1, true}}, {}, {})) << "newest generations are missing";
    EXPECT_EQ(pool.count(), 1u);
    EXPECT_TRUE(pool.contains({0, 1, 1}));
}

TEST(IdPool, that_goes_back_issues_no_id_twice) {
    Pool pool(1);
    const ThingId a = pool.add();
    const Pool saved = pool;
    const ThingId b = pool.add();
    pool.remove(a);
    const ThingId a2 = pool.add();
    Pool back(1);
    ASSERT_TRUE(back.restore(saved.slots(), saved.free_list(), saved.newest()));
    back.continue_after(pool.newest());
    EXPECT_TRUE(back.contains(a));
    EXPECT_FALSE(back.contains(b));
    EXPECT_FALSE(back.contains(a2));
    const ThingId b2 = back.add();
    EXPECT_EQ(b2.index, b.index);
    EXPECT_FALSE(back.contains(b));
    back.remove(a);
    const ThingId a3 = back.add();
    EXPECT_EQ(a3.index, a.index);
    EXPECT_FALSE(back.contains(a2));
    EXPECT_NE(a3, a2);
}

/// Compares with a list of all issued ids.
TEST(IdPool, agrees_with_a_plain_list_over_many_random_operations) {
    Pool pool(9);
    std::vector<ThingId> issued;
    std::vector<bool> alive;
    Random random(2);
    for (int round = 0; round < 3000; ++round) {
        if (issued.empty() || random.below(5) < 3) {
            issued.push_back(pool.add());
            alive.push_back(true);
        } else {
            const std::size_t i = random.below(issued.size());
            ASSERT_EQ(pool.remove(issued[i]), alive[i]);
            alive[i] = false;
        }
        if (round % 50 != 0) continue;
        std::uint32_t count = 0;
        for (std::size_t i = 0; i < issued.size(); ++i) {
            ASSERT_EQ(pool.contains(issued[i]), alive[i]);
            count += alive[i] ? 1 : 0;
        }
        ASSERT_EQ(pool.count(), count);
    }
}

TEST(Ids, are_keys_of_hash_maps) {
    IdPool<Thing> pool(7);
    std::unordered_map<Id<Thing>, int> number;
    std::set<std::size_t> low_bits;
    for (int i = 0; i < 1000; ++i) {
        const Id<Thing> id = pool.add();
        number[id] = i;
        low_bits.insert(std::hash<Id<Thing>>{}(id) % 1024);
    }
    EXPECT_EQ(number.size(), 1000u);
    EXPECT_EQ(number.at(*pool.id_at(17)), 17);
    EXPECT_GT(low_bits.size(), 500u) << "hashes of ids in a row fall into many buckets";
}

}  // namespace
}  // namespace fase
