#pragma once
/// A fixed-size array without initialisation, for the stack.
#include <cstddef>
#include <type_traits>

namespace fase::narrow {

/// Holds N uninitialised items of a trivial type; copying copies all of them.
template <class T, std::size_t N> class Buffer {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

public:
    Buffer() {}  // leaves the items uninitialised
    T& operator[](std::size_t i) { return items_[i]; }
    const T& operator[](std::size_t i) const { return items_[i]; }

private:
    union {
        T items_[N];
    };
};

}  // namespace fase::narrow
