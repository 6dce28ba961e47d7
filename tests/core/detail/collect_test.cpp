/// Stream compaction: the same result for any number of threads.
#include "fase/core/detail/collect.hpp"

#include <gtest/gtest.h>

namespace fase {
namespace {

std::vector<std::uint32_t> multiples_of_seven(std::size_t count, int threads, std::vector<std::uint32_t>& scratch) {
    const auto tasks = make_thread_runner(threads);
    const auto list = collect(*tasks, count, scratch, [](std::size_t begin, std::size_t end, std::uint32_t* out) {
        std::size_t found = 0;
        for (std::size_t i = begin; i < end; ++i)
            if (i % 7 == 0) out[found++] = static_cast<std::uint32_t>(i);
        return found;
    });
    return {list.begin(), list.end()};
}

TEST(Collect, ListsInOrderForAnyNumberOfThreads) {
    std::vector<std::uint32_t> scratch;  // reused: its previous content must not matter
    for (const std::size_t count : {0u, 1u, 16384u, 16385u, 100000u, 1500000u, 20u}) {
        std::vector<std::uint32_t> expected;
        for (std::uint32_t i = 0; i < count; i += 7) expected.push_back(i);
        for (const int threads : {1, 2, 3}) ASSERT_EQ(multiples_of_seven(count, threads, scratch), expected) << count;
    }
}

TEST(Collect, ListsAllOrNone) {
    const auto tasks = make_thread_runner(2);
    std::vector<std::uint32_t> scratch;
    const auto all = collect(*tasks, 50000, scratch, [](std::size_t begin, std::size_t end, std::uint32_t* out) {
        for (std::size_t i = begin; i < end; ++i) *out++ = static_cast<std::uint32_t>(i);
        return end - begin;
    });
    ASSERT_EQ(all.size(), 50000u);
    for (std::uint32_t i = 0; i < all.size(); ++i) ASSERT_EQ(all[i], i);
    EXPECT_TRUE(collect(*tasks, 50000, scratch, [](std::size_t, std::size_t, std::uint32_t*) {
                    return std::size_t{0};
                }).empty());
}

}  // namespace
}  // namespace fase
