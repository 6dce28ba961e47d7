#pragma once
/// A fixed array that is not cleared: room on the stack that costs nothing until it is used.
#include <cstddef>
#include <type_traits>

namespace fase::narrow {

/// Room for N items of a plain type. Items hold nothing until they are written; copying copies all of them.
template <class T, std::size_t N> class Buffer {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

public:
    Buffer() {}  // leaves the items as they are
    T& operator[](std::size_t i) { return items_[i]; }
    const T& operator[](std::size_t i) const { return items_[i]; }

private:
    union {
        T items_[N];
    };
};

}  // namespace fase::narrow
