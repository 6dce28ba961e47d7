/// Compares every structure of the registry with brute force over random sequences of operations, for every kind of
/// scene.
#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "fase/broad/find_pairs.hpp"
#include "fase/broad/registry.hpp"
#include "tests/conformance/lives.hpp"

namespace fase::conformance {
namespace {

class EveryStructure : public ::testing::TestWithParam<std::tuple<std::string, Scene>> {
protected:
    DifferentialRun start_run(std::uint64_t seed) const {
        return {std::get<0>(GetParam()), std::get<1>(GetParam()), seed};
    }
};

TEST_P(EveryStructure, ReportsTheSameAsBruteForceAfterManyChanges) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        DifferentialRun run = start_run(seed);
        run.insert(100 + 40 * seed);
        run.commit();
        ASSERT_NO_FATAL_FAILURE(run.expect_same());
        for (int step = 0; step < 24; ++step) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", step " + std::to_string(step));
            if (step % 3 == 0) run.insert(run.random().below(12));
            run.move(step % 2 == 0 ? 16 : 1);
            if (step % 4 == 1) run.erase(run.random().below(6));
            if (step % 4 == 3) run.move(3);  // twice before one commit
            run.commit();
            ASSERT_NO_FATAL_FAILURE(run.expect_same());
        }
    }
}

TEST_P(EveryStructure, CanBeEmptiedAndFilledAgain) {
    DifferentialRun run = start_run(7);
    run.commit();
    ASSERT_NO_FATAL_FAILURE(run.expect_same());
    for (const std::size_t count : {1u, 2u, 3u, 60u, 1u, 30u}) {
        run.insert(count);
        run.commit();
        ASSERT_NO_FATAL_FAILURE(run.expect_same());
        run.insert(2);  // added, moved and erased between two commits
        run.move(16);
        run.erase(16);
        ASSERT_EQ(run.tested.size(), 0u);
        run.commit();
        ASSERT_NO_FATAL_FAILURE(run.expect_same());
    }
}

TEST_P(EveryStructure, VisitsEachBoxOnceAndStopsOnRequest) {
    DifferentialRun run = start_run(8);
    run.insert(80);
    run.commit();
    run.move(16);
    run.commit();
    std::vector<Proxy> seen;
    run.tested.traverse(broad::Everything{}, [&](Proxy p, const Aabb&) {
        seen.push_back(p);
        return true;
    });
    std::sort(seen.begin(), seen.end());
    std::sort(run.stored.begin(), run.stored.end());
    EXPECT_EQ(seen, run.stored);
    for (const int limit : {1, 2, 37}) {
        int visited = 0;
        run.tested.traverse(broad::Everything{}, [&](Proxy, const Aabb&) { return ++visited < limit; });
        EXPECT_EQ(visited, limit);
    }
}

TEST_P(EveryStructure, VisitsTheExactBoxes) {
    DifferentialRun run = start_run(9);
    run.insert(50);
    run.commit();
    run.move(16);
    run.commit();
    const auto boxes_of = [](const AnyStructure& s) {
        std::vector<std::pair<Proxy, std::string>> boxes;
        s.traverse(broad::Everything{}, [&](Proxy p, const Aabb& box) {
            boxes.emplace_back(p, std::string(reinterpret_cast<const char*>(&box), sizeof box));
            return true;
        });
        std::sort(boxes.begin(), boxes.end());
        return boxes;
    };
    EXPECT_EQ(boxes_of(run.tested), boxes_of(run.reference));
}

TEST_P(EveryStructure, FindsTheSamePairsForAnyNumberOfThreads) {
    DifferentialRun run = start_run(10);
    run.insert(700);
    run.commit();
    run.move(8);
    run.commit();
    const std::vector<Pair> expected = all_pairs(run.reference);
    std::vector<Pair> with_two;
    for (const int threads : {1, 2, 4}) {
        const auto tasks = make_thread_runner(threads);
        std::vector<Pair> pairs;
        run.tested.find_pairs(*tasks, pairs);
        if (threads == 2) with_two = pairs;
        if (threads == 4) {
            EXPECT_EQ(pairs, with_two) << "the order depends on the number of threads";
        }
        std::sort(pairs.begin(), pairs.end());
        EXPECT_EQ(pairs, expected);
    }
}

TEST_P(EveryStructure, AnswersQueriesStoredOrNot) {
    DifferentialRun run = start_run(11);
    run.insert(600);
    run.commit();
    std::vector<Move> query_boxes;
    std::vector<std::uint8_t> is_query(500, 0);
    run.reference.traverse(broad::Everything{}, [&](Proxy p, const Aabb& box) {
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
    for (const Pair pair : all_pairs(run.reference))
        if (touches_query(pair)) expected.push_back(pair);
    EXPECT_EQ(sorted_pairs([&](auto& out) { run.tested.find_pairs_of(query_boxes, is_query, out); }), expected);
    const auto tasks = make_thread_runner(3);
    EXPECT_EQ(sorted_pairs([&](auto& out) { run.tested.find_pairs_of(*tasks, query_boxes, is_query, out); }), expected);

    std::vector<Pair> twice = expected;  // unmarked pairs of two query boxes are found from both sides
    for (const Pair pair : expected)
        if (pair.a < 500 && is_query[pair.a] != 0 && pair.b < 500 && is_query[pair.b] != 0) twice.push_back(pair);
    std::sort(twice.begin(), twice.end());
    EXPECT_EQ(sorted_pairs([&](auto& out) { run.tested.find_pairs_of(query_boxes, out); }), twice);

    const Move not_stored{5000, std::get<1>(GetParam()).draw(run.random())};
    std::vector<Pair> expected_of_not_stored;
    for (const Proxy p : sorted_overlapping(run.reference, not_stored.box))
        expected_of_not_stored.push_back({p, not_stored.proxy});
    EXPECT_EQ(sorted_pairs([&](auto& out) { run.tested.find_pairs_of(std::span(&not_stored, 1), out); }),
              expected_of_not_stored);
}

TEST_P(EveryStructure, AnswersManyQueriesAsItAnswersOneByOne) {
    DifferentialRun run = start_run(14);
    run.insert(700);
    run.commit();
    std::vector<Move> query_boxes;
    run.reference.traverse(broad::Everything{}, [&](Proxy p, const Aabb& box) {
        if (p % 5 != 0) query_boxes.push_back({p, p % 7 == 0 ? std::get<1>(GetParam()).draw(run.random()) : box});
        return true;
    });
    for (Proxy p = 1000; p < 1100; ++p) query_boxes.push_back({p, std::get<1>(GetParam()).draw(run.random())});
    std::vector<std::uint8_t> some_marked(900);
    for (std::uint8_t& mark : some_marked) mark = run.random().below(2) == 0 ? 0 : 4;
    for (const auto& marks : {std::vector<std::uint8_t>{}, some_marked}) {
        const auto expected = sorted_pairs([&](auto& out) { run.reference.find_pairs_of(query_boxes, marks, out); });
        EXPECT_EQ(sorted_pairs([&](auto& out) { run.tested.find_pairs_of(query_boxes, marks, out); }), expected);
        for (const int threads : {1, 2}) {
            const auto tasks = make_thread_runner(threads);
            EXPECT_EQ(sorted_pairs([&](auto& out) { run.tested.find_pairs_of(*tasks, query_boxes, marks, out); }),
                      expected);
        }
    }
}

TEST_P(EveryStructure, FindsThePairsBetweenTwoStructures) {
    for (const std::string& other_name : structure_names()) {
        DifferentialRun run = start_run(12);
        run.insert(200);
        run.commit();
        std::vector<Move> all;
        run.reference.traverse(broad::Everything{}, [&](Proxy p, const Aabb& box) {
            all.push_back({p, box});
            return true;
        });
        AnyStructure one = *AnyStructure::named(std::get<0>(GetParam()));
        AnyStructure other = *AnyStructure::named(other_name);
        for (const Move& m : all) (m.proxy % 3 == 0 ? one : other).insert(std::span(&m, 1));
        one.commit();
        other.commit();
        std::vector<Pair> expected;
        for (const Pair pair : all_pairs(run.reference))
            if ((pair.a % 3 == 0) != (pair.b % 3 == 0)) expected.push_back(pair);
        EXPECT_EQ(sorted_pairs([&](auto& out) { one.find_pairs_between(other, out); }), expected);
        EXPECT_EQ(sorted_pairs([&](auto& out) { other.find_pairs_between(one, out); }), expected);
    }
}

TEST_P(EveryStructure, IsDeterministic) {
    const auto pairs_in_order = [&] {
        DifferentialRun run = start_run(13);
        run.insert(300);
        run.commit();
        for (int i = 0; i < 5; ++i) {
            run.move(9);
            run.erase(1);
            run.insert(5);
            run.commit();
        }
        std::vector<Pair> pairs;
        run.tested.find_pairs(pairs);
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

TEST(Registry, NamesAreUniqueAndEveryStructureHasADescription) {
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
