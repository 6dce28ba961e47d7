#pragma once
/// An array that grows without moving its elements.
#include <cstddef>
#include <vector>

namespace fase::broad {

/// Values by index, in pages of a fixed size: growth by one allocates at most one page, and never copies the elements.
template <class T> class PagedArray {
public:
    static constexpr std::size_t page = 4096;

    /// Grows to at least `count` elements; never shrinks.
    void grow_to(std::size_t count) {
        while (pages_.size() * page < count) pages_.emplace_back(page);
    }
    void clear() { pages_.clear(); }
    [[nodiscard]] std::size_t size() const { return pages_.size() * page; }
    [[nodiscard]] T& operator[](std::size_t i) { return pages_[i / page][i % page]; }
    [[nodiscard]] const T& operator[](std::size_t i) const { return pages_[i / page][i % page]; }
    [[nodiscard]] std::size_t bytes() const {
        return pages_.capacity() * sizeof(pages_[0]) + pages_.size() * page * sizeof(T);
    }

private:
    std::vector<std::vector<T>> pages_;
};

}  // namespace fase::broad
