#pragma once
/// Divides a step into batches that can be solved one after the other, or in parallel.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/dynamics/solver/constraint.hpp"
#include "fase/dynamics/solver/islands.hpp"

namespace fase::dynamics {

/// Bodies and constraints that are solved together: spans of rows and of Batches::constraints().
struct Batch {
    std::uint32_t first_row = 0;
    std::uint32_t first_body = 0,
                  bodies = 0;  ///< the row after those of the bodies receives the writes of unused lanes
    std::uint32_t first_constraint = 0, constraints = 0;

    [[nodiscard]] std::uint32_t unused_row() const { return first_row + bodies; }
};

/// Packs groups of bodies into batches whose data stay in the cache for all sub-steps. A group is what constraints
/// connect through bodies that move, so no batch reads what another one writes. The result depends on the order of
/// bodies and constraints alone.
class Batches {
public:
    /// Constraints that a batch holds at most, unless it is the first: about 300 kB of blocks.
    static constexpr std::size_t capacity = 1024;

    struct Input {
        std::span<const std::uint32_t> awake;  ///< bodies, ascending
        std::span<const Constraint> constraints;
        std::span<const std::uint32_t> row_of_body;  ///< 0: static or asleep; the other values are not read
        std::span<const std::uint8_t> in_hub;        ///< by constraint: 1: no colour was free
    };
    /// `groups`: sets of bodies that touch; constraints that only come near are added. The first batch holds the
    /// groups of more than `capacity` constraints and those with hubs, the others the rest. Constraints that move
    /// neither body are in no batch. O(bodies + constraints).
    void divide(const Input& in, DisjointSets& groups);
    [[nodiscard]] std::span<const Batch> all() const { return batches_; }
    /// The awake bodies, in the order of their rows within each batch.
    [[nodiscard]] std::span<const std::uint32_t> bodies_of(const Batch& batch) const {
        return std::span(bodies_).subspan(batch.first_body, batch.bodies);
    }
    /// The constraints of a batch, ascending.
    [[nodiscard]] std::span<const std::uint32_t> constraints_of(const Batch& batch) const {
        return std::span(constraints_).subspan(batch.first_constraint, batch.constraints);
    }
    /// The number of rows: row 0 is the static world.
    [[nodiscard]] std::size_t rows() const { return batches_.back().unused_row() + std::size_t{1}; }

private:
    std::vector<Batch> batches_;
    std::vector<std::uint32_t> bodies_, constraints_;
    std::vector<std::uint32_t> size_of_, batch_of_;  // by body; sizes are valid for representatives
};

}  // namespace fase::dynamics
