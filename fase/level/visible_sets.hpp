#pragma once
/// Visible sets of all sub-sectors, run-length encoded.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fase::level {

/// For each sub-sector, the set of those that are visible from some point in it, as alternating lengths of runs of
/// hidden and visible ones. All const calls are safe from any number of threads and allocate nothing.
class VisibleSets {
public:
    /// Encodes `count` sets. `row(i)` returns the bits of the set of sub-sector i: (count + 63) / 64 words of 64 bits.
    template <class Row> static VisibleSets of(std::size_t count, Row&& row) {
        VisibleSets sets;
        sets.begin_.push_back(0);
        for (std::size_t i = 0; i < count; ++i) {
            sets.append(row(i), count);
            sets.begin_.push_back(sets.runs_.size());
        }
        return sets;
    }

    /// Returns the number of sub-sectors.
    [[nodiscard]] std::size_t size() const { return begin_.empty() ? 0 : begin_.size() - 1; }
    /// Calls visit(sub-sector) for each that `from` sees, sorted by index.
    template <class Visit> void for_each_seen(std::uint32_t from, Visit&& visit) const {
        for_each_run(from, [&](std::uint32_t first, std::uint32_t end) {
            for (std::uint32_t i = first; i < end; ++i) visit(i);
            return true;
        });
    }
    /// Returns whether some point in `to` may be visible from some point in `from`. O(runs of `from`).
    [[nodiscard]] bool sees(std::uint32_t from, std::uint32_t to) const {
        bool seen = false;
        for_each_run(from, [&](std::uint32_t first, std::uint32_t end) {
            seen = first <= to && to < end;
            return end <= to;
        });
        return seen;
    }
    /// Returns the number of sub-sectors that `from` sees.
    [[nodiscard]] std::size_t seen_by(std::uint32_t from) const {
        std::size_t sum = 0;
        for_each_run(from, [&](std::uint32_t first, std::uint32_t end) {
            sum += end - first;
            return true;
        });
        return sum;
    }
    /// Returns the sum of seen_by().
    [[nodiscard]] std::size_t pairs() const {
        std::size_t sum = 0;
        for (std::uint32_t i = 0; i < size(); ++i) sum += seen_by(i);
        return sum;
    }
    /// Returns the memory of the runs and their offsets.
    [[nodiscard]] std::size_t bytes() const { return runs_.size() + begin_.size() * sizeof(std::size_t); }

    friend bool operator==(const VisibleSets&, const VisibleSets&) = default;

private:
    std::vector<std::size_t> begin_;  ///< by sub-sector: offset of its runs; then the end of the last
    std::vector<std::uint8_t>
        runs_;  ///< lengths as varints: seven bits a byte, lowest first, bit 7 set on all but the last

    /// Calls visit(first, end) for each visible run until it returns false.
    template <class Visit> void for_each_run(std::uint32_t from, Visit&& visit) const {
        std::uint32_t at = 0;
        bool seen = false;
        for (std::size_t i = begin_[from]; i < begin_[from + 1]; seen = !seen) {
            std::uint32_t length = 0;
            for (unsigned shift = 0;; shift += 7) {
                const std::uint8_t byte = runs_[i++];
                length |= std::uint32_t{byte & 127u} << shift;
                if (byte < 128) break;
            }
            if (seen && !visit(at, at + length)) return;
            at += length;
        }
    }
    void append(std::span<const std::uint64_t> bits, std::size_t count);
};

}  // namespace fase::level
