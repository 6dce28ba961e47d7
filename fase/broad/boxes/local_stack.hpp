#pragma once
/// A stack for walks through trees: lives in the caller's frame, moves to the heap only when it grows past N.
#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>

namespace fase::broad {

/// Last in, first out, of plain values. The first N allocate nothing; there is no upper limit.
template <class T, std::size_t N> class LocalStack {
public:
    LocalStack() = default;
    LocalStack(const LocalStack&) = delete;
    LocalStack& operator=(const LocalStack&) = delete;

    void push(T value) {
        make_room(1);
        data_[count_++] = value;
    }
    /// The next `more` push_if() have room.
    void make_room(std::size_t more) {
        if (count_ + more > capacity_) grow();
    }
    /// Pushes when `wanted`, without a branch; make_room() comes first.
    void push_if(bool wanted, T value) {
        data_[count_] = value;
        count_ += wanted ? 1 : 0;
    }
    /// The stack must not be empty.
    T pop() { return data_[--count_]; }
    [[nodiscard]] bool empty() const { return count_ == 0; }
    [[nodiscard]] std::size_t size() const { return count_; }
    /// All that was pushed and not popped, the newest last; valid until the next push.
    [[nodiscard]] T* data() { return data_; }

private:
    std::array<T, N> near_;
    std::unique_ptr<T[]> far_;
    T* data_ = near_.data();
    std::size_t count_ = 0, capacity_ = N;

    void grow() {
        std::unique_ptr<T[]> larger(new T[capacity_ * 2]);
        std::copy_n(data_, count_, larger.get());
        far_ = std::move(larger);
        data_ = far_.get();
        capacity_ *= 2;
    }
};

}  // namespace fase::broad
