/// Task runners: each runs every chunk once, and all give the same results.
#include "fase/core/tasks.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

#include "fase/core/detail/thread_pool.hpp"
#include "fase/core/random.hpp"

namespace fase {
namespace {

/// A user's scheduler: one thread for each of two halves, the second in reverse order.
class TwoThreads final : public TaskRunner {
public:
    void run(std::size_t count, const std::function<void(std::size_t)>& chunk) override {
        ++runs;
        const std::size_t middle = count / 2;
        std::thread helper([&] {
            for (std::size_t i = count; i > middle; --i) chunk(i - 1);
        });
        for (std::size_t i = 0; i < middle; ++i) chunk(i);
        helper.join();
    }
    [[nodiscard]] int threads() const override { return 2; }
    std::atomic<int> runs = 0;
};

/// All runners, with names.
struct NamedRunner {
    const char* name;
    std::unique_ptr<TaskRunner> runner;
};
std::vector<NamedRunner> all_runners() {
    std::vector<NamedRunner> runners;
    runners.push_back({"serial", make_serial_runner()});
    runners.push_back({"one thread", make_thread_runner(1)});
    runners.push_back({"two threads", make_thread_runner(2)});
    runners.push_back({"four threads", make_thread_runner(4)});
    runners.push_back({"one thread per core", make_thread_runner(0)});
    runners.push_back({"two threads of the pool", detail::make_thread_pool(2)});
    runners.push_back({"four threads of the pool", detail::make_thread_pool(4)});
    runners.push_back({"user's runner", std::make_unique<TwoThreads>()});
    return runners;
}

TEST(TaskRunner, calls_every_chunk_exactly_once) {
    for (const auto& [name, runner] : all_runners()) {
        for (const std::size_t count : {0u, 1u, 2u, 3u, 1000u}) {
            std::vector<std::atomic<int>> calls(count);
            runner->run(count, [&](std::size_t i) { ++calls[i]; });
            for (const auto& c : calls) ASSERT_EQ(c, 1) << name;
        }
        EXPECT_GE(runner->threads(), 1) << name;
    }
    EXPECT_EQ(make_serial_runner()->threads(), 1);
    EXPECT_EQ(make_thread_runner(1)->threads(), 1);
}

TEST(TaskRunner, serial_runs_on_the_caller_in_order) {
    const auto serial = make_serial_runner();
    std::vector<std::size_t> order;
    const auto caller = std::this_thread::get_id();
    serial->run(5, [&](std::size_t i) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        order.push_back(i);
    });
    EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
}

TEST(ParallelRanges, cover_all_items_once_with_ranges_that_depend_on_count_and_grain_only) {
    for (const auto& [name, runner] : all_runners()) {
        for (const std::size_t count : {0u, 1u, 9u, 10u, 11u, 1000u, 1003u}) {
            constexpr std::size_t grain = 10;
            std::vector<std::atomic<int>> calls(count);
            std::atomic<int> wrong = 0;
            parallel_ranges(*runner, count, grain, [&](std::size_t begin, std::size_t end) {
                if (begin % grain != 0 || end != std::min(begin + grain, count) || begin >= end) ++wrong;
                for (std::size_t i = begin; i < end; ++i) ++calls[i];
            });
            EXPECT_EQ(wrong, 0) << name;
            for (const auto& c : calls) ASSERT_EQ(c, 1) << name;
        }
    }
}

/// A sum of floats depends on the order; the ranges do not depend on the runner, so the bits do not either.
TEST(ParallelRanges, give_the_same_bits_on_every_runner) {
    Random random(1);
    std::vector<float> values(100003);
    for (float& v : values) v = random.between(-1, 1);
    const auto sum_on = [&](TaskRunner& runner) {
        constexpr std::size_t grain = 512;
        std::vector<float> parts((values.size() + grain - 1) / grain);
        parallel_ranges(runner, values.size(), grain, [&](std::size_t begin, std::size_t end) {
            float sum = 0;
            for (std::size_t i = begin; i < end; ++i) sum += values[i];
            parts[begin / grain] = sum;
        });
        float sum = 0;
        for (const float part : parts) sum += part;
        return sum;
    };
    const auto runners = all_runners();
    const float expected = sum_on(*runners[0].runner);
    for (const auto& [name, runner] : runners) {
        for (int repeat = 0; repeat < 20; ++repeat) ASSERT_EQ(sum_on(*runner), expected) << name;
    }
}

TEST(ParallelRanges, may_be_nested) {
    for (const auto& [name, runner] : all_runners()) {
        TaskRunner& tasks = *runner;
        std::vector<std::atomic<int>> calls(40 * 30);
        parallel_ranges(tasks, 40, 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                parallel_ranges(tasks, 30, 7, [&](std::size_t from, std::size_t to) {
                    for (std::size_t j = from; j < to; ++j) ++calls[i * 30 + j];
                });
            }
        });
        for (const auto& c : calls) ASSERT_EQ(c, 1) << name;
    }
}

TEST(TaskRunner, may_have_more_threads_than_the_machine_has_cores) {
    const int requested = static_cast<int>(std::thread::hardware_concurrency()) + 2;
    testing::internal::CaptureStderr();
    const auto many = make_thread_runner(requested);
    EXPECT_EQ(many->threads(), requested);
    // Each chunk waits until all have started, so it ends only with one thread per chunk, or at the deadline.
    std::atomic<int> started = 0;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    many->run(static_cast<std::size_t>(requested), [&](std::size_t) {
        ++started;
        while (started < requested && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
    });
    EXPECT_LT(std::chrono::steady_clock::now(), deadline) << "fewer threads than requested";
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "the library prints nothing";
}

TEST(ParallelRanges, do_not_use_the_runner_for_one_range) {
    TwoThreads runner;
    const auto caller = std::this_thread::get_id();
    parallel_ranges(runner, 10, 10, [&](std::size_t, std::size_t) { EXPECT_EQ(std::this_thread::get_id(), caller); });
    EXPECT_EQ(runner.runs, 0);
    parallel_ranges(runner, 11, 10, [](std::size_t, std::size_t) {});
    EXPECT_EQ(runner.runs, 1);
}

TEST(TaskRunner, several_can_exist_at_the_same_time) {
    const auto two = make_thread_runner(2), four = make_thread_runner(4);
    std::atomic<int> sum = 0;
    std::thread other([&] { two->run(1000, [&](std::size_t) { ++sum; }); });
    four->run(1000, [&](std::size_t) { ++sum; });
    other.join();
    EXPECT_EQ(sum, 2000);
}

}  // namespace
}  // namespace fase
