#pragma once
/// Boxes by motion state: the static, the sleeping and the awake ones, each set in a structure of its own.
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fase/broad/auto_structure.hpp"
#include "fase/core/motion_state.hpp"
#include "fase/core/tasks.hpp"

namespace fase::pairs {

/// Three structures, one for each motion state. Awake boxes pair with all others, so what rests costs nothing until an
/// awake box comes near. A world and a PairFinder keep their boxes in these sets and search through them. The caller
/// knows in which set a proxy is, and names the set in each edit. Edits are cheap; commit() makes them visible to
/// searches, which are then safe from any number of threads. Which structures are chosen changes the order of pairs,
/// never the pairs.
class BoxSets {
public:
    /// @param kind an empty structure: all three sets use copies of it
    explicit BoxSets(const broad::AnyStructure& kind = {}) : sets_{kind, kind, kind} {}
    /// Sets whose structures follow their sizes; see broad::choose_structure(). @param awake_use whether the awake set
    /// mostly finds its own pairs, or is mostly queried by the few of its boxes that moved.
    [[nodiscard]] static BoxSets automatic(broad::BoxUse awake_use);

    [[nodiscard]] const broad::AnyStructure& of(MotionState state) const {
        return sets_[static_cast<std::size_t>(state)];
    }
    /// For edits; state is Static, Asleep or Awake.
    [[nodiscard]] broad::AnyStructure& of(MotionState state) { return sets_[static_cast<std::size_t>(state)]; }
    /// Replaces all boxes of a set by boxes in the structure that suits them, and commits.
    void build(MotionState state, std::span<const broad::Move> boxes);
    /// Moves to structures that suit the new sizes (automatic sets only), and commits. `inspect`: also looks at sizes
    /// and places of boxes where these matter; to be set now and then.
    void commit(TaskRunner& tasks, bool inspect = false);
    /// Commits without changing structures: after many boxes were inserted in a row, as by a restored snapshot.
    void commit_as_they_are();
    /// Empties all sets; keeps the kind and the automatic choice.
    void clear();

    /// Appends each pair with at least one awake box once, smaller proxy first, in no particular order.
    void find_awake_pairs(TaskRunner& tasks, std::vector<broad::Pair>& out) const;
    /// Appends the pairs of the query boxes with the boxes of all sets; see broad::find_pairs_of(). `is_query` marks
    /// the proxies that query, so that a pair of two is found once.
    void find_pairs_of(TaskRunner& tasks, std::span<const broad::Move> queries, std::span<const std::uint8_t> is_query,
                       std::vector<broad::Pair>& out) const;

    [[nodiscard]] bool is_automatic() const { return automatic_; }
    /// The structure of a set, and why; the reason is empty for a structure that was named by the user.
    [[nodiscard]] broad::StructureChoice chosen(MotionState state) const;
    [[nodiscard]] std::size_t size() const { return sets_[0].size() + sets_[1].size() + sets_[2].size(); }
    /// Memory in use, spare capacity included.
    [[nodiscard]] std::size_t bytes() const { return sets_[0].bytes() + sets_[1].bytes() + sets_[2].bytes(); }

private:
    std::array<broad::AnyStructure, 3> sets_;  // by MotionState: static, asleep, awake
    bool automatic_ = false;
    broad::BoxUse awake_use_ = broad::BoxUse::FindsPairs;

    [[nodiscard]] broad::BoxUse use_of(MotionState state) const {
        return state == MotionState::Awake ? awake_use_ : broad::BoxUse::IsQueried;
    }
};

}  // namespace fase::pairs
