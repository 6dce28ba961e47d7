/// The serial runner and the runner on threads: oneTBB's, or plain ones where a thread sanitizer watches.
#include "fase/core/tasks.hpp"

#ifdef FASE_PLAIN_THREADS
#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>
#else
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <optional>
#endif

namespace fase {
namespace {

class SerialRunner final : public TaskRunner {
public:
    void run(std::size_t count, const std::function<void(std::size_t)>& chunk) override {
        for (std::size_t i = 0; i < count; ++i) chunk(i);
    }
    [[nodiscard]] int threads() const override { return 1; }
};

#ifdef FASE_PLAIN_THREADS
// A thread sanitizer cannot see how the compiled oneTBB orders its threads and reports races that are none; with
// threads made anew for each loop it sees all, and so finds the races of the chunks.
class ThreadRunner final : public TaskRunner {
public:
    explicit ThreadRunner(int threads)
        : threads_(threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))) {}
    void run(std::size_t count, const std::function<void(std::size_t)>& chunk) override {
        std::atomic<std::size_t> next = 0;
        const auto work = [&] {
            for (std::size_t i = next++; i < count; i = next++) chunk(i);
        };
        std::vector<std::thread> helpers;
        for (int i = 1; i < threads_; ++i) helpers.emplace_back(work);
        work();
        for (std::thread& helper : helpers) helper.join();
    }
    [[nodiscard]] int threads() const override { return threads_; }

private:
    int threads_;
};
#else
class ThreadRunner final : public TaskRunner {
public:
    explicit ThreadRunner(int threads) {
        const auto wanted = static_cast<std::size_t>(threads > 0 ? threads : 0);
        if (wanted > static_cast<std::size_t>(tbb::info::default_concurrency())) {
            more_.emplace(tbb::global_control::max_allowed_parallelism, wanted);
        }
        arena_.initialize(threads > 0 ? threads : int{tbb::task_arena::automatic});
    }
    void run(std::size_t count, const std::function<void(std::size_t)>& chunk) override {
        arena_.execute([&] {
            tbb::parallel_for(
                std::size_t{0}, count, [&](std::size_t i) { chunk(i); }, tbb::simple_partitioner{});
        });
    }
    [[nodiscard]] int threads() const override { return arena_.max_concurrency(); }

private:
    // oneTBB stops at the number of cores unless told otherwise; of several who tell it, the least counts.
    std::optional<tbb::global_control> more_;
    tbb::task_arena arena_;
};
#endif

}  // namespace

std::unique_ptr<TaskRunner> make_serial_runner() { return std::make_unique<SerialRunner>(); }

std::unique_ptr<TaskRunner> make_thread_runner(int threads) {
    if (threads == 1) return make_serial_runner();
    return std::make_unique<ThreadRunner>(threads);
}

}  // namespace fase
