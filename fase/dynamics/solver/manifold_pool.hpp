#pragma once
/// The manifolds of all contacts.
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/dynamics/solver/contact.hpp"

namespace fase::dynamics {

/// Stores the manifolds of each contact next to each other, in spans of 1, 2, 4 … places. Freed spans are reused. Where
/// a span lies does not influence a simulation, so snapshots hold the manifolds only.
class ManifoldPool {
public:
    static constexpr std::size_t max_per_contact = 1u << 14;

    void clear() {
        all_.clear();
        for (std::vector<std::uint32_t>& list : free_) list.clear();
    }
    [[nodiscard]] std::span<ContactManifold> of(const Contact& c) { return span_at(c, c.manifolds); }
    [[nodiscard]] std::span<const ContactManifold> of(const Contact& c) const {
        return {all_.data() + (c.manifolds ? c.first_manifold : 0), c.manifolds};
    }
    /// The manifolds that may have a colour: those in use, and those that ended since colours were last updated.
    [[nodiscard]] std::span<ContactManifold> coloured(const Contact& c) { return span_at(c, c.coloured); }
    /// All places of a contact.
    [[nodiscard]] std::span<ContactManifold> places(const Contact& c) { return span_at(c, c.capacity); }
    [[nodiscard]] ContactManifold& operator[](std::uint32_t index) { return all_[index]; }
    [[nodiscard]] const ContactManifold& operator[](std::uint32_t index) const { return all_[index]; }

    /// Makes room for `count` manifolds of a contact, 1 to max_per_contact, and keeps those it has. New manifolds are
    /// empty: their friction and restitution are 0 until update_materials() of world/detail/contacts.hpp sets them.
    /// Amortised O(count).
    void reserve(Contact& c, std::size_t count) {
        if (count <= c.capacity) return;
        const int size_class = std::bit_width(count - 1);
        const std::size_t size = std::size_t{1} << size_class;
        std::vector<std::uint32_t>& free = free_[static_cast<std::size_t>(size_class)];
        std::uint32_t first = 0;
        if (free.empty()) {
            first = static_cast<std::uint32_t>(all_.size());
            all_.resize(all_.size() + size);
        } else {
            first = free.back();
            free.pop_back();
        }
        const Contact before = c;
        c.first_manifold = first;
        c.capacity = static_cast<std::uint16_t>(size);
        std::ranges::copy(places(before), places(c).begin());
        if (before.capacity != 0) release_span(before);
    }
    /// Allocates for the manifolds of `count` new contacts of one manifold each, twice as much as there is when the
    /// pool must grow.
    void reserve_for(std::size_t count) {
        const std::size_t size = all_.size() + count;
        if (all_.capacity() < size) all_.reserve(std::max(size, 2 * all_.capacity()));
    }
    /// Frees the places of a contact that ends.
    void release(Contact& c) {
        if (c.capacity == 0) return;
        release_span(c);
        c.first_manifold = no_index;
        c.manifolds = c.coloured = c.capacity = c.points = 0;
    }
    [[nodiscard]] std::size_t size() const { return all_.size(); }
    [[nodiscard]] std::size_t bytes() const { return all_.capacity() * sizeof(ContactManifold); }

private:
    [[nodiscard]] std::span<ContactManifold> span_at(const Contact& c, std::size_t count) {
        return {all_.data() + (count ? c.first_manifold : 0), count};
    }
    void release_span(const Contact& c) {
        std::ranges::fill(places(c), ContactManifold{});
        free_[static_cast<std::size_t>(std::bit_width(c.capacity - 1u))].push_back(c.first_manifold);
    }
    std::vector<ContactManifold> all_;
    std::array<std::vector<std::uint32_t>, 15> free_;  // first places of free spans of 2^i
};

}  // namespace fase::dynamics
