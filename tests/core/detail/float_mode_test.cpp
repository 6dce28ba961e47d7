/// The standard floating-point mode is set in any mode of the host program.
#include "fase/core/detail/float_mode.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "fase/core/tasks.hpp"

namespace fase {
namespace {

#if defined(__SSE__)

/// Not inlined, because compilers move arithmetic across a change of the mode.
[[gnu::noinline]] float half_of_the_smallest_normal() {
    volatile float smallest = std::numeric_limits<float>::min();
    return smallest / 2;
}

/// A host that flushes denormals; comparisons with denormals are correct only after its destruction.
class FlushingHost {
public:
    FlushingHost() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040); }
    ~FlushingHost() { _mm_setcsr(before_); }
    FlushingHost(const FlushingHost&) = delete;
    FlushingHost& operator=(const FlushingHost&) = delete;

private:
    unsigned before_;
};

TEST(StandardFloats, keep_denormals_and_restore_the_mode_of_the_host) {
    float outside = 1, within = 0, after = 1;
    {
        const FlushingHost host;
        outside = half_of_the_smallest_normal();
        {
            const StandardFloats floats;
            within = half_of_the_smallest_normal();
        }
        after = half_of_the_smallest_normal();
    }
    EXPECT_EQ(outside, 0);
    EXPECT_GT(within, 0);
    EXPECT_EQ(after, 0);
}

TEST(StandardFloats, are_set_in_the_chunks_of_every_runner) {
    for (const auto& runner : {make_serial_runner(), make_thread_runner(3)}) {
        std::vector<float> found(100, std::numeric_limits<float>::min());
        {
            const FlushingHost host;
            parallel_ranges(*runner, found.size(), 1, [&](std::size_t begin, std::size_t) { found[begin] /= 2; });
        }
        for (const float f : found) ASSERT_GT(f, 0);
    }
}

#endif

}  // namespace
}  // namespace fase
