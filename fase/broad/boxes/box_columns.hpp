#pragma once
/// Boxes as six columns of floats (structure of arrays), so that one instruction tests many of them.
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "fase/broad/structure.hpp"

namespace fase::broad {

/// The columns of a set of boxes, for the loops of box_scan.hpp. Index 0 is the sort axis of sorted boxes. After the
/// last box there are BoxColumns::padding more boxes that overlap nothing.
struct ColumnsView {
    std::array<const float*, 3> lo{}, hi{};
    const Proxy* proxies = nullptr;
    std::size_t count = 0;
};

/// Boxes and their proxies by index, one array per bound.
class BoxColumns {
public:
    static constexpr std::size_t padding = 16;

    BoxColumns() { resize(0); }

    /// New boxes overlap nothing.
    void resize(std::size_t count) {
        constexpr float nan = std::numeric_limits<float>::quiet_NaN();
        for (std::vector<float>& bound : bounds_) {
            bound.resize(count + padding, nan);
            for (std::size_t i = count; i < count + padding; ++i) bound[i] = nan;
        }
        proxies_.resize(count + padding);
        count_ = count;
    }
    void put(std::size_t at, Proxy p, const Aabb& box) {
        bounds_[0][at] = box.lo.x;
        bounds_[1][at] = box.lo.y;
        bounds_[2][at] = box.lo.z;
        bounds_[3][at] = box.hi.x;
        bounds_[4][at] = box.hi.y;
        bounds_[5][at] = box.hi.z;
        proxies_[at] = p;
    }
    [[nodiscard]] Aabb box(std::size_t at) const {
        return {{bounds_[0][at], bounds_[1][at], bounds_[2][at]}, {bounds_[3][at], bounds_[4][at], bounds_[5][at]}};
    }
    [[nodiscard]] Proxy proxy(std::size_t at) const { return proxies_[at]; }
    [[nodiscard]] std::span<const Proxy> proxies() const { return {proxies_.data(), count_}; }
    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] std::size_t bytes() const {
        return 6 * bounds_[0].capacity() * sizeof(float) + proxies_.capacity() * sizeof(Proxy);
    }
    /// Returns the columns with `axis` (0 to 2) at index 0.
    [[nodiscard]] ColumnsView view(int axis = 0) const {
        ColumnsView columns{.proxies = proxies_.data(), .count = count_};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t source = (k + static_cast<std::size_t>(axis)) % 3;
            columns.lo[k] = bounds_[source].data();
            columns.hi[k] = bounds_[source + 3].data();
        }
        return columns;
    }

private:
    std::array<std::vector<float>, 6> bounds_;  // lo x, y, z, hi x, y, z
    std::vector<Proxy> proxies_;
    std::size_t count_ = 0;
};

}  // namespace fase::broad
