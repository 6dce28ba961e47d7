#pragma once
/// The contacts of each collider as linked lists, so that edits, wakes and sleeps cost their own contacts only.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fase/core/no_index.hpp"

namespace fase {

/// Links every contact into the lists of its two colliders, and knows the places of resting contacts in the list of
/// resting pairs. The order of a collider's list depends on the history: sort what depends on it. Rebuilt from the pair
/// lists after a restore.
class ContactGraph {
public:
    void clear() {
        nodes_.clear();
        heads_.clear();
    }
    /// Allocates for contacts with indices below `size`.
    void reserve(std::size_t size) {
        if (nodes_.capacity() < size) nodes_.reserve(std::max(size, 2 * nodes_.capacity()));
    }
    /// Links a contact that is not linked. O(1).
    void add(std::uint32_t contact, std::uint32_t collider_a, std::uint32_t collider_b) {
        if (nodes_.size() <= contact) nodes_.resize(contact + std::size_t{1});
        const std::size_t colliders = std::max(collider_a, collider_b) + std::size_t{1};
        if (heads_.size() < colliders) heads_.resize(colliders, no_index);
        nodes_[contact] = {};
        nodes_[contact].collider = {collider_a, collider_b};
        for (const std::uint32_t link : {2 * contact, 2 * contact + 1}) {
            std::uint32_t& head = heads_[nodes_[contact].collider[link & 1]];
            nodes_[contact].next[link & 1] = head;
            if (head != no_index) nodes_[head / 2].previous[head & 1] = link;
            head = link;
        }
    }
    /// Unlinks a contact. O(1).
    void remove(std::uint32_t contact) {
        Node& node = nodes_[contact];
        for (const std::size_t side : {0u, 1u}) {
            const std::uint32_t next = node.next[side], previous = node.previous[side];
            if (next != no_index) nodes_[next / 2].previous[next & 1] = previous;
            if (previous != no_index) {
                nodes_[previous / 2].next[previous & 1] = next;
            } else {
                heads_[node.collider[side]] = next;
            }
        }
        node.resting_at = no_index;
    }
    /// Calls f(contact) for each contact of a collider, in unspecified order. f must not add or remove contacts.
    template <class F> void for_each_of(std::uint32_t collider, F&& f) const {
        if (collider >= heads_.size()) return;
        for (std::uint32_t link = heads_[collider]; link != no_index; link = nodes_[link / 2].next[link & 1])
            f(link / 2);
    }
    /// The place of a contact in the list of resting pairs; no_index for others.
    [[nodiscard]] std::uint32_t resting_at(std::uint32_t contact) const {
        return contact < nodes_.size() ? nodes_[contact].resting_at : no_index;
    }
    void set_resting_at(std::uint32_t contact, std::uint32_t place) { nodes_[contact].resting_at = place; }
    [[nodiscard]] std::size_t bytes() const {
        return nodes_.capacity() * sizeof(Node) + heads_.capacity() * sizeof heads_[0];
    }

private:
    // A link is 2 * contact + side; side 1 is collider b.
    struct Node {
        std::array<std::uint32_t, 2> collider{no_index, no_index};
        std::array<std::uint32_t, 2> next{no_index, no_index}, previous{no_index, no_index};
        std::uint32_t resting_at = no_index;
    };
    std::vector<Node> nodes_;           // by contact
    std::vector<std::uint32_t> heads_;  // by collider
};

}  // namespace fase
