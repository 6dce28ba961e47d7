#pragma once
/// Holds the processor's floating-point mode at its standard while a step runs.
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace fase {

/// Round to nearest, denormals kept, traps off, on this thread, for as long as the object lives; then as before. A host
/// program that flushes denormals to zero gets the same bits as any other.
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
