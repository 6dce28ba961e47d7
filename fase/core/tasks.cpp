/// The serial runner and the runner on threads: oneTBB's where Fase is built with it, else the built-in pool.
#include "fase/core/tasks.hpp"

#ifdef FASE_HAS_TBB
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <optional>
#else
#include "fase/core/detail/thread_pool.hpp"
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

#ifdef FASE_HAS_TBB
class ThreadRunner final : public TaskRunner {
public:
    explicit ThreadRunner(int threads) {
        const auto requested = static_cast<std::size_t>(threads > 0 ? threads : 0);
        if (requested > static_cast<std::size_t>(tbb::info::default_concurrency())) {
            more_.emplace(tbb::global_control::max_allowed_parallelism, requested);
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
    // oneTBB uses at most as many threads as there are cores unless told otherwise; the smallest of all limits counts.
    std::optional<tbb::global_control> more_;
    tbb::task_arena arena_;
};
#endif
}  // namespace

std::unique_ptr<TaskRunner> make_serial_runner() { return std::make_unique<SerialRunner>(); }

std::unique_ptr<TaskRunner> make_thread_runner(int threads) {
    if (threads == 1) return make_serial_runner();
#ifdef FASE_HAS_TBB
    return std::make_unique<ThreadRunner>(threads);
#else
    return detail::make_thread_pool(threads);
#endif
}

}  // namespace fase
