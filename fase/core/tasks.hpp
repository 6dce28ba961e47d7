#pragma once
/// Who runs parallel work: oneTBB, one thread, or a scheduler of the user's own, behind one small interface.
#include <cstddef>
#include <functional>
#include <memory>

#include "fase/core/detail/float_mode.hpp"

namespace fase {

/// Runs a loop's chunks on as many threads as it has. Results never depend on it: work is cut by count, not by threads.
class TaskRunner {
public:
    virtual ~TaskRunner() = default;
    /// Calls `chunk(i)` once for each i in 0..count-1, in any order, from any threads, and returns when all are done.
    /// `chunk` does not throw. Called from inside a chunk it may run the inner loop serially.
    virtual void run(std::size_t count, const std::function<void(std::size_t)>& chunk) = 0;
    /// How many chunks may run at once; at least 1. Advice for how finely to cut.
    [[nodiscard]] virtual int threads() const = 0;
};

/// Runs everything on the calling thread, in order.
[[nodiscard]] std::unique_ptr<TaskRunner> make_serial_runner();

/// Runs on `threads` threads of oneTBB, the caller among them; 0: as many as the machine has cores. 1 equals the serial
/// runner. Several runners may live at once.
[[nodiscard]] std::unique_ptr<TaskRunner> make_thread_runner(int threads);

/// Keeps the arithmetic of a chunk behind the change of the floating-point mode: compilers move it across when they see
/// both.
template <class F> [[gnu::noinline]] void call_range(const F& body, std::size_t begin, std::size_t end) {
    body(begin, end);
}

/// Calls `body(begin, end)` for consecutive ranges of at most `grain` items that cover 0..count, in parallel.
/// The ranges depend on count and grain alone. Runs on the caller when one range covers all. Chunks of more threads
/// compute in the standard floating-point mode.
template <class F> void parallel_ranges(TaskRunner& tasks, std::size_t count, std::size_t grain, const F& body) {
    if (count == 0) return;
    const std::size_t chunks = (count + grain - 1) / grain;
    if (chunks == 1) {
        body(std::size_t{0}, count);
        return;
    }
    tasks.run(chunks, [&](std::size_t i) {
        const StandardFloats floats;
        const std::size_t begin = i * grain;
        call_range(body, begin, begin + grain < count ? begin + grain : count);
    });
}

}  // namespace fase
