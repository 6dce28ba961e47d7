#pragma once
/// Sets the processor's floating-point mode to the IEEE default while a step runs.
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace fase {

/// Sets round to nearest, denormals on, traps off for this thread, and restores the previous mode in its destructor.
/// So a host program that flushes denormals to zero gets the same bits as any other.
class StandardFloats {
public:
#if defined(__SSE__)
    StandardFloats() : before_(_mm_getcsr()) {
        if (before_ != standard) _mm_setcsr(standard);
    }
    ~StandardFloats() {
        if (before_ != standard) _mm_setcsr(before_);
    }

private:
    static constexpr unsigned standard = 0x1f80;
    unsigned before_;
#else
    StandardFloats() = default;
#endif

public:
    StandardFloats(const StandardFloats&) = delete;
    StandardFloats& operator=(const StandardFloats&) = delete;
};

}  // namespace fase
