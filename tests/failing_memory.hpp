#pragma once
/// Replaces operator new of the whole test program, so that the Nth allocation can fail. Include it in one source only.
#include <cstddef>
#include <cstdlib>
#include <new>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define FASE_TEST_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define FASE_TEST_SANITIZED 1
#endif
#endif

#ifndef FASE_TEST_SANITIZED
namespace fase::test {

inline thread_local long allocations_left = -1;  ///< until one fails; below 0: none fails
inline thread_local bool an_allocation_failed = false;

inline void* allocate(std::size_t size, std::size_t alignment) {
    if (allocations_left >= 0 && allocations_left-- == 0) {
        an_allocation_failed = true;
        throw std::bad_alloc();
    }
    size = size == 0 ? 1 : size;
    void* memory = alignment > alignof(std::max_align_t)
                       ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                       : std::malloc(size);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

/// Not inlined: the compiler would compare it with the replaced operator new.
[[gnu::noinline]] inline void release(void* memory) noexcept { std::free(memory); }

/// Calls `call`; allocation number `n` on this thread, counted from 0, throws std::bad_alloc. Returns false when an
/// exception leaves the call. `an_allocation_failed` tells whether there were so many.
template <class F> bool run_with_failing_allocation(long n, const F& call) {
    an_allocation_failed = false;
    allocations_left = n;
    bool returned = true;
    try {
        call();
    } catch (...) {
        returned = false;
    }
    allocations_left = -1;
    return returned;
}

}  // namespace fase::test

[[gnu::noinline]] void* operator new(std::size_t size) { return fase::test::allocate(size, 0); }
[[gnu::noinline]] void* operator new[](std::size_t size) { return fase::test::allocate(size, 0); }
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
    return fase::test::allocate(size, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void* operator new[](std::size_t size, std::align_val_t alignment) {
    return fase::test::allocate(size, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { fase::test::release(memory); }
[[gnu::noinline]] void operator delete[](void* memory) noexcept { fase::test::release(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { fase::test::release(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::size_t) noexcept { fase::test::release(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept { fase::test::release(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::align_val_t) noexcept { fase::test::release(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    fase::test::release(memory);
}
[[gnu::noinline]] void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
    fase::test::release(memory);
}
#endif
