/// Every structure of the registry against brute force, through random lives of boxes of every kind of scene.
#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "fase/broad/find_pairs.hpp"
#include "tests/conformance/lives.hpp"

namespace fase::conformance {
namespace {

class EveryStructure : public ::testing::TestWithParam<std::tuple<std::string, Scene>> {
protected:
    Lives lives(std::uint64_t seed) const { return {std::get<0>(GetParam()), std::get<1>(GetParam()), seed}; }
};

TEST_P(EveryStructure, ReportsWhatBruteForceReportsAllItsLife) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        Lives life = lives(seed);
        life.insert(100 + 40 * seed);
        life.commit();
        ASSERT_NO_FATAL_FAILURE(life.expect_same());
        for (int step = 0; step < 24; ++step) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", step " + std::to_string(step));
            if (step % 3 == 0) life.insert(life.random().below(12));
            life.move(step % 2 == 0 ? 16 : 1);
            if (step % 4 == 1) life.erase(life.random().below(6));
            if (step % 4 == 3) life.move(3);  // twice before one commit
            life.commit();
            ASSERT_NO_FATAL_FAILURE(life.expect_same());
        }
    }
}

TEST_P(EveryStructure, CanBeEmptiedAndFilledAgain) {
    Lives life = lives(7);
    life.commit();
    ASSERT_NO_FATAL_FAILURE(life.expect_same());
    for (const std::size_t count : {1u, 2u, 3u, 60u, 1u, 30u}) {
        life.insert(count);
        life.commit();
        ASSERT_NO_FATAL_FAILURE(life.expect_same());
        life.insert(2);  // born, moved and dead between two commits
        life.move(16);
        life.erase(16);
        ASSERT_EQ(life.tested.size(), 0u);
        life.commit();
        ASSERT_NO_FATAL_FAILURE(life.expect_same());
    }
}

TEST_P(EveryStructure, VisitsEachBoxOnceAndStopsWhenTold) {
    Lives life = lives(8);
    life.insert(80);
    life.commit();
    life.move(16);
    life.commit();
    std::vector<Proxy> seen;
    life.tested.traverse(broad::Everything{}, [&](Proxy p, const Aabb&) {
        seen.push_back(p);
        return true;
    });
    std::sort(seen.begin(), seen.end());
    std::sort(life.alive.begin(), life.alive.end());
    EXPECT_EQ(seen, life.alive);
    for (const int wanted : {1, 2, 37}) {
        int visited = 0;
        life.tested.traverse(broad::Everything{}, [&](Proxy, const Aabb&) { return ++visited < wanted; });
        EXPECT_EQ(visited, wanted);
    }
}

TEST_P(EveryStructure, HandsOutTheExactBoxes) {
    Lives life = lives(9);
    life.insert(50);
    life.commit();
    life.move(16);
    life.commit();
    const auto boxes_of = [](const AnyStructure& s) {
        std::vector<std::pair<Proxy, std::string>> boxes;
        s.traverse(broad::Everything{}, [&](Proxy p, const Aabb& box) {
            boxes.emplace_back(p, std::string(reinterpret_cast<const char*>(&box), sizeof box));
            return true;
        });
        std::sort(boxes.begin(), boxes.end());
        return boxes;
    };
    EXPECT_EQ(boxes_of(life.tested), boxes_of(life.judge));
}

TEST_P(EveryStructure, FindsTheSamePairsForAnyNumberOfThreads) {
    Lives life = lives(10);
    life.insert(700);
    life.commit();
    life.move(8);
    life.commit();
    const std::vector<Pair> expected = all_pairs(life.judge);
    std::vector<Pair> with_two;
    for (const int threads : {1, 2, 4}) {
        const auto tasks = make_thread_runner(threads);
        std::vector<Pair> pairs;
        life.tested.find_pairs(*tasks, pairs);
        if (threads == 2) with_two = pairs;
        if (threads == 4) {
            EXPECT_EQ(pairs, with_two) << "the order depends on the number of threads";
        }
        std::sort(pairs.begin(), pairs.end());
        EXPECT_EQ(pairs, expected);
    }
}

TEST_P(EveryStructure, AnswersQueriesStoredOrNot) {
    Lives life = lives(11);
    life.insert(600);
    life.commit();
    std::vector<Move> query_boxes;
    std::vector<std::uint8_t> is_query(500, 0);
    life.judge.traverse(broad::Everything{}, [&](Proxy p, const Aabb& box) {
        if (p % 2 == 0 && p < 500) {
            query_boxes.push_back({p, box});
            is_query[p] = 1;
        }
        return true;
    });
    const auto touches_query = [&](Pair pair) {
        return (pair.a < 500 && is_query[pair.a] != 0) || (pair.b < 500 && is_query[pair.b] != 0);
    };
    std::vector<Pair> expected;
    for (const Pair pair : all_pairs(life.judge))
        if (touches_query(pair)) expected.push_back(pair);
    EXPECT_EQ(sorted_pairs([&](auto& out) { life.tested.find_pairs_of(query_boxes, is_query, out); }), expected);
    const auto tasks = make_thread_runner(3);
    EXPECT_EQ(sorted_pairs([&](auto& out) { life.tested.find_pairs_of(*tasks, query_boxes, is_query, out); }),
              expected);

    std::vector<Pair> twice = expected;  // pairs of two askers are found from both sides when nothing marks them
    for (const Pair pair : expected)
        if (pair.a < 500 && is_query[pair.a] != 0 && pair.b < 500 && is_query[pair.b] != 0) twice.push_back(pair);
    std::sort(twice.begin(), twice.end());
    EXPECT_EQ(sorted_pairs([&](auto& out) { life.tested.find_pairs_of(query_boxes, out); }), twice);

    const Move stranger{5000, std::get<1>(GetParam()).draw(life.random())};
    std::vector<Pair> strange;
    for (const Proxy p : sorted_overlapping(life.judge, stranger.box)) strange.push_back({p, stranger.proxy});
    EXPECT_EQ(sorted_pairs([&](auto& out) { life.tested.find_pairs_of(std::span(&stranger, 1), out); }), strange);
}

TEST_P(EveryStructure, AnswersManyQueriesAsItAnswersOneByOne) {
    Lives life = lives(14);
    life.insert(700);
    life.commit();
    std::vector<Move> query_boxes;
    life.judge.traverse(broad::Everything{}, [&](Proxy p, const Aabb& box) {
        if (p % 5 != 0) query_boxes.push_back({p, p % 7 == 0 ? std::get<1>(GetParam()).draw(life.random()) : box});
        return true;
    });
    for (Proxy p = 1000; p < 1100; ++p) query_boxes.push_back({p, std::get<1>(GetParam()).draw(life.random())});
    std::vector<std::uint8_t> some_marked(900);
    for (std::uint8_t& mark : some_marked) mark = life.random().below(2) == 0 ? 0 : 4;
    for (const auto& marks : {std::vector<std::uint8_t>{}, some_marked}) {
        const auto expected = sorted_pairs([&](auto& out) { life.judge.find_pairs_of(query_boxes, marks, out); });
        EXPECT_EQ(sorted_pairs([&](auto& out) { life.tested.find_pairs_of(query_boxes, marks, out); }), expected);
        for (const int threads : {1, 2}) {
            const auto tasks = make_thread_runner(threads);
            EXPECT_EQ(sorted_pairs([&](auto& out) { life.tested.find_pairs_of(*tasks, query_boxes, marks, out); }),
                      expected);
        }
    }
}

TEST_P(EveryStructure, FindsThePairsBetweenTwo) {
    for (const std::string& other_name : structure_names()) {
        Lives life = lives(12);
        life.insert(200);
        life.commit();
        std::vector<Move> all;
        life.judge.traverse(broad::Everything{}, [&](Proxy p, const Aabb& box) {
            all.push_back({p, box});
            return true;
        });
        AnyStructure one = *AnyStructure::named(std::get<0>(GetParam()));
        AnyStructure other = *AnyStructure::named(other_name);
        for (const Move& m : all) (m.proxy % 3 == 0 ? one : other).insert(std::span(&m, 1));
        one.commit();
        other.commit();
        std::vector<Pair> expected;
        for (const Pair pair : all_pairs(life.judge))
            if ((pair.a % 3 == 0) != (pair.b % 3 == 0)) expected.push_back(pair);
        EXPECT_EQ(sorted_pairs([&](auto& out) { one.find_pairs_between(other, out); }), expected);
        EXPECT_EQ(sorted_pairs([&](auto& out) { other.find_pairs_between(one, out); }), expected);
    }
}

TEST_P(EveryStructure, DependsOnItsPastAlone) {
    const auto pairs_in_order = [&] {
        Lives life = lives(13);
        life.insert(300);
        life.commit();
        for (int i = 0; i < 5; ++i) {
            life.move(9);
            life.erase(1);
            life.insert(5);
            life.commit();
        }
        std::vector<Pair> pairs;
        life.tested.find_pairs(pairs);
        return pairs;
    };
    EXPECT_EQ(pairs_in_order(), pairs_in_order());
}

std::string name_of_case(const ::testing::TestParamInfo<EveryStructure::ParamType>& info) {
    return std::get<0>(info.param) + "_on_" + std::get<1>(info.param).name;
}
INSTANTIATE_TEST_SUITE_P(Registry, EveryStructure,
                         ::testing::Combine(::testing::ValuesIn(structure_names()), ::testing::ValuesIn(all_scenes())),
                         name_of_case);

TEST(Registry, NamesAreUniqueAndEveryStructureSaysWhatItIs) {
    std::set<std::string_view> names;
    broad::for_each_structure([&]<broad::Structure S>() {
        EXPECT_TRUE(names.insert(S::info.name).second) << S::info.name;
        EXPECT_FALSE(S::info.idea.empty());
        EXPECT_FALSE(S::info.source.empty());
    });
    EXPECT_TRUE(names.contains(broad::default_structure));
}

}  // namespace
}  // namespace fase::conformance
