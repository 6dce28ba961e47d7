#pragma once
/// A stack for tree traversals: in the caller's frame; on the heap only when it grows past N.
#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>

namespace fase::broad {

/// A stack of trivially copyable values. The first N need no allocation; there is no upper limit.
template <class T, std::size_t N> class LocalStack {
public:
    LocalStack() = default;
    LocalStack(const LocalStack&) = delete;
    LocalStack& operator=(const LocalStack&) = delete;

    void push(T value) {
        reserve_more(1);
        data_[count_++] = value;
    }
    /// Reserves capacity for the next `more` calls of push_if().
    void reserve_more(std::size_t more) {
        if (count_ + more > capacity_) grow();
    }
    /// Pushes if `condition`, without a branch. Call reserve_more() first.
    void push_if(bool condition, T value) {
        data_[count_] = value;
        count_ += condition ? 1 : 0;
    }
    /// The stack must not be empty.
    T pop() { return data_[--count_]; }
    [[nodiscard]] bool empty() const { return count_ == 0; }
    [[nodiscard]] std::size_t size() const { return count_; }
    /// The stored values, newest last; valid until the next push.
    [[nodiscard]] T* data() { return data_; }

private:
    std::array<T, N> local_;
    std::unique_ptr<T[]> heap_;
    T* data_ = local_.data();
    std::size_t count_ = 0, capacity_ = N;

    void grow() {
        std::unique_ptr<T[]> larger(new T[capacity_ * 2]);
        std::copy_n(data_, count_, larger.get());
        heap_ = std::move(larger);
        data_ = heap_.get();
        capacity_ *= 2;
    }
};

}  // namespace fase::broad
