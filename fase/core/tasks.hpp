#pragma once
/// Interface to a task scheduler: oneTBB, a single thread, or the user's scheduler.
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>

#include "fase/core/detail/float_mode.hpp"

namespace fase {

/// Runs the chunks of a loop on its threads. Results do not depend on it: work is split by item count, not by thread
/// count.
class TaskRunner {
public:
    virtual ~TaskRunner() = default;
    /// Calls `chunk(i)` once for each i in 0..count-1, in any order, from any threads, and returns when all are done.
    /// `chunk` does not throw: run_chunks() keeps exceptions inside. A nested call from inside a chunk may run
    /// serially.
    virtual void run(std::size_t count, const std::function<void(std::size_t)>& chunk) = 0;
    /// Number of chunks that may run in parallel, at least 1: a hint for the chunk size.
    [[nodiscard]] virtual int threads() const = 0;
};

/// Makes a runner that runs all chunks on the calling thread, in order.
[[nodiscard]] std::unique_ptr<TaskRunner> make_serial_runner();

/// Makes a runner on `threads` threads of oneTBB, the caller included; 0: the number of cores; 1: the serial runner.
/// Several runners may exist at the same time.
[[nodiscard]] std::unique_ptr<TaskRunner> make_thread_runner(int threads);

/// Runs chunks that may throw: runs all of them, then throws the first exception on the calling thread. A runner need
/// not know about exceptions.
template <class F> void run_chunks(TaskRunner& tasks, std::size_t count, const F& chunk) {
    std::atomic<bool> failed = false;
    std::exception_ptr first;
    tasks.run(count, [&](std::size_t i) {
        try {
            chunk(i);
        } catch (...) {
            if (!failed.exchange(true)) first = std::current_exception();
        }
    });
    if (failed) std::rethrow_exception(first);
}

/// Calls `body` without inlining, so that the compiler cannot move its arithmetic across the change of the
/// floating-point mode.
template <class F> [[gnu::noinline]] void call_range(const F& body, std::size_t begin, std::size_t end) {
    body(begin, end);
}

/// Calls `body(begin, end)` for consecutive ranges of at most `grain` items that cover 0..count, in parallel.
/// The ranges depend on count and grain alone. A single range runs on the caller. Several ranges run in the standard
/// floating-point mode.
template <class F> void parallel_ranges(TaskRunner& tasks, std::size_t count, std::size_t grain, const F& body) {
    if (count == 0) return;
    const std::size_t chunks = (count + grain - 1) / grain;
    if (chunks == 1) {
        body(std::size_t{0}, count);
        return;
    }
    run_chunks(tasks, chunks, [&](std::size_t i) {
        const StandardFloats floats;
        const std::size_t begin = i * grain;
        call_range(body, begin, begin + grain < count ? begin + grain : count);
    });
}

}  // namespace fase
