/// Threads that sleep between loops and take chunks from a shared counter.
#include "fase/core/detail/thread_pool.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace fase::detail {
namespace {

class ThreadPool final : public TaskRunner {
public:
    explicit ThreadPool(int threads) {
        const int requested =
            threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
        try {
            for (int i = 1; i < requested; ++i) workers_.emplace_back([this] { work_until_stopped(); });
        } catch (const std::system_error&) {
            // The system grants no more threads; those that were started serve.
        }
    }
    ~ThreadPool() override {
        {
            const std::lock_guard lock(mutex_);
            stop_ = true;
        }
        start_.notify_all();
        for (std::thread& worker : workers_) worker.join();
    }
    void run(std::size_t count, const std::function<void(std::size_t)>& chunk) override {
        if (count < 2 || workers_.empty() || running_.test_and_set(std::memory_order_acquire)) {
            for (std::size_t i = 0; i < count; ++i) chunk(i);
            return;
        }
        Loop loop{chunk, count};
        {
            const std::lock_guard lock(mutex_);
            loop_ = &loop;
            ++loops_started_;
        }
        start_.notify_all();
        loop.run_chunks();
        {
            std::unique_lock lock(mutex_);
            loop_ = nullptr;  // workers that wake up late do not join
            done_.wait(lock, [&] { return loop.workers == 0; });
        }
        running_.clear(std::memory_order_release);
    }
    [[nodiscard]] int threads() const override { return static_cast<int>(workers_.size()) + 1; }

private:
    struct Loop {
        const std::function<void(std::size_t)>& chunk;
        const std::size_t count;
        std::atomic<std::size_t> next = 0;
        std::size_t workers = 0;  // that run chunks of it; guarded by the pool's mutex

        void run_chunks() {
            for (std::size_t i = next++; i < count; i = next++) chunk(i);
        }
    };

    void work_until_stopped() {
        std::uint64_t seen = 0;
        std::unique_lock lock(mutex_);
        while (true) {
            start_.wait(lock, [&] { return stop_ || (loop_ != nullptr && loops_started_ != seen); });
            if (stop_) return;
            seen = loops_started_;
            Loop& loop = *loop_;
            ++loop.workers;
            lock.unlock();
            loop.run_chunks();
            lock.lock();
            if (--loop.workers == 0) done_.notify_one();
        }
    }

    std::atomic_flag running_;
    std::mutex mutex_;
    std::condition_variable start_, done_;
    Loop* loop_ = nullptr;             // the loop that runs now
    std::uint64_t loops_started_ = 0;  // so that a worker joins each loop once
    bool stop_ = false;
    std::vector<std::thread> workers_;  // last: they use the members above
};

}  // namespace

std::unique_ptr<TaskRunner> make_thread_pool(int threads) { return std::make_unique<ThreadPool>(threads); }

}  // namespace fase::detail
