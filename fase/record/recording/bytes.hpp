#pragma once
/// Writes and reads little-endian numbers; the reader checks all bounds.
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "fase/math/pose.hpp"

namespace fase::record {

/// An integer or floating-point type, without bool.
template <class T>
concept PlainNumber = std::is_arithmetic_v<T> && !std::is_same_v<T, bool>;

/// Maps 0, -1, 1, -2 … to 0, 1, 2, 3 …
constexpr std::uint64_t zigzag(std::int64_t value) {
    return (static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63);
}
/// Reverses zigzag().
constexpr std::int64_t unzigzag(std::uint64_t code) {
    return static_cast<std::int64_t>(code >> 1) ^ -static_cast<std::int64_t>(code & 1);
}

/// Appends numbers to a growing byte buffer.
class ByteWriter {
public:
    template <PlainNumber T> void put(T value) {
        using Bits =
            std::conditional_t<sizeof(T) == 8, std::uint64_t,
                               std::conditional_t<sizeof(T) == 4, std::uint32_t,
                                                  std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint8_t>>>;
        const Bits bits = std::bit_cast<Bits>(value);
        for (std::size_t i = 0; i < sizeof(T); ++i) bytes_.push_back(static_cast<std::byte>(bits >> (8 * i)));
    }
    void put_varuint(std::uint64_t value) {
        while (value >= 128) {
            bytes_.push_back(static_cast<std::byte>(value | 128));
            value >>= 7;
        }
        bytes_.push_back(static_cast<std::byte>(value));
    }
    void put_varint(std::int64_t value) { put_varuint(zigzag(value)); }
    void put_bytes(std::span<const std::byte> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }
    /// Appends the letters without their count.
    void put_letters(std::string_view letters) { put_bytes(std::as_bytes(std::span(letters))); }
    void put_text(std::string_view text) {
        put_varuint(text.size());
        put_letters(text);
    }
    void put_vec3(Vec3 v) {
        put(v.x);
        put(v.y);
        put(v.z);
    }
    void put_pose(const LocalPose& pose) {
        put_vec3(pose.position);
        put_vec3(pose.rotation.vector());
        put(pose.rotation.w);
    }
    /// Overwrites four bytes written before.
    void set_u32(std::size_t at, std::uint32_t value) {
        for (std::size_t i = 0; i < 4; ++i) bytes_[at + i] = static_cast<std::byte>(value >> (8 * i));
    }
    [[nodiscard]] std::size_t size() const { return bytes_.size(); }
    [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }
    void clear() { bytes_.clear(); }
    void swap(ByteWriter& other) { bytes_.swap(other.bytes_); }

private:
    std::vector<std::byte> bytes_;
};

/// Reads what ByteWriter wrote. A read past the end or of an invalid value returns 0 and makes failed() true for good;
/// all later reads return 0. Callers read several numbers and check failed() once, before they use them.
class ByteReader {
public:
    explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    template <PlainNumber T> T get() {
        using Bits =
            std::conditional_t<sizeof(T) == 8, std::uint64_t,
                               std::conditional_t<sizeof(T) == 4, std::uint32_t,
                                                  std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint8_t>>>;
        if (!has(sizeof(T))) return fail<T>();
        Bits bits = 0;
        for (std::size_t i = 0; i < sizeof(T); ++i) {
            bits = static_cast<Bits>(bits | static_cast<Bits>(static_cast<Bits>(bytes_[offset_ + i]) << (8 * i)));
        }
        offset_ += sizeof(T);
        return std::bit_cast<T>(bits);
    }
    /// Reads a number below 2^53; fails otherwise.
    std::uint64_t get_varuint() {
        std::uint64_t value = 0;
        for (int shift = 0; shift < 56; shift += 7) {
            if (!has(1)) return fail<std::uint64_t>();
            const auto byte = static_cast<std::uint64_t>(bytes_[offset_++]);
            value |= (byte & 127) << shift;
            if (byte < 128) return value < (std::uint64_t(1) << 53) ? value : fail<std::uint64_t>();
        }
        return fail<std::uint64_t>();
    }
    std::int64_t get_varint() { return unzigzag(get_varuint()); }
    /// Reads a count of items of at least `min_bytes` each; fails if the remaining bytes cannot hold that many.
    std::size_t get_count(std::uint64_t min_bytes) { return checked_count(get_varuint(), min_bytes); }
    std::size_t get_u32_count(std::uint64_t min_bytes) { return checked_count(get<std::uint32_t>(), min_bytes); }
    std::span<const std::byte> get_bytes(std::size_t count) {
        if (!has(count)) {
            fail<int>();
            return {};
        }
        const auto part = bytes_.subspan(offset_, count);
        offset_ += count;
        return part;
    }
    std::string get_text() {
        const auto part = get_bytes(get_count(1));
        return {reinterpret_cast<const char*>(part.data()), part.size()};
    }
    Vec3 get_vec3() {
        const float x = get<float>(), y = get<float>();
        return {x, y, get<float>()};
    }
    LocalPose get_pose() {
        const Vec3 position = get_vec3(), vector = get_vec3();
        return {position, {vector.x, vector.y, vector.z, get<float>()}};
    }
    /// Marks the input as invalid.
    void set_failed() { fail<int>(); }
    [[nodiscard]] bool failed() const { return failed_; }
    [[nodiscard]] std::size_t remaining() const { return bytes_.size() - offset_; }
    [[nodiscard]] std::size_t offset() const { return offset_; }

private:
    [[nodiscard]] bool has(std::size_t count) const { return !failed_ && count <= bytes_.size() - offset_; }
    std::size_t checked_count(std::uint64_t count, std::uint64_t min_bytes) {
        return failed_ || count > remaining() / min_bytes ? fail<std::size_t>() : static_cast<std::size_t>(count);
    }
    template <class T> T fail() {
        failed_ = true;
        return T{};
    }
    std::span<const std::byte> bytes_;
    std::size_t offset_ = 0;
    bool failed_ = false;
};

}  // namespace fase::record
