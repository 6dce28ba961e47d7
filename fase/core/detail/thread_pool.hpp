#pragma once
/// The built-in runner on threads, which needs no library.
#include <memory>

#include "fase/core/tasks.hpp"

namespace fase::detail {

/// Runs loops on `threads` threads, the caller among them; 0: as many as the machine has cores. The threads sleep
/// between loops. A loop that starts while another one runs (inside a chunk, or on a second thread) runs serially on
/// its caller. When the system refuses a thread, the pool works with those it has.
[[nodiscard]] std::unique_ptr<TaskRunner> make_thread_pool(int threads);

}  // namespace fase::detail
