#pragma once
/// Loads memory into the cache before it is used.
#include <cstddef>

namespace fase::detail {

/// Requests the cache lines of an object. Lists are in the order of pairs, and what they refer to lies anywhere:
/// hardware prefetchers do not find it.
template <class T> void prefetch(const T& object) {
#if defined(__GNUC__)
    const auto* bytes = reinterpret_cast<const char*>(&object);
    for (std::size_t line = 0; line < sizeof(T); line += 64) __builtin_prefetch(bytes + line);
#else
    (void)object;
#endif
}

}  // namespace fase::detail
