/// Divides a step into batches of groups that share nothing that moves.
#include "fase/dynamics/solver/batches.hpp"

#include <algorithm>

namespace fase::dynamics {
namespace {

constexpr std::uint32_t max_size = 1u << 30;  // sizes of large groups saturate
constexpr auto unassigned = static_cast<std::uint32_t>(-1);

}  // namespace

void Batches::divide(const Input& in, DisjointSets& groups) {
    size_of_.resize(in.row_of_body.size());
    batch_of_.resize(in.row_of_body.size());
    // What islands do not unite: bodies that only come near, and moving kinematic ones with all that they may touch.
    for (const Constraint& c : in.constraints)
        if (c.moves != Moves::Neither && in.row_of_body[c.body_a] && in.row_of_body[c.body_b] &&
            !(c.touches && c.moves == Moves::Both))
            groups.unite(c.body_a, c.body_b);
    for (const std::uint32_t body : in.awake) {
        const std::uint32_t group = groups.find(body);
        size_of_[group] = 0;
        batch_of_[group] = unassigned;
    }
    const auto member = [&](const Constraint& c) { return in.row_of_body[c.body_a] ? c.body_a : c.body_b; };
    for (std::size_t i = 0; i < in.constraints.size(); ++i) {
        const Constraint& c = in.constraints[i];
        if (c.moves == Moves::Neither) continue;
        std::uint32_t& size = size_of_[groups.find(member(c))];
        size = std::min(size + (in.in_hub[i] ? std::uint32_t{capacity} : 0u) + 1, max_size);
    }

    batches_.assign(1, {});
    for (const std::uint32_t body : in.awake) {
        std::uint32_t& batch = batch_of_[groups.find(body)];
        if (batch == unassigned) {
            const std::uint32_t size = size_of_[groups.find(body)];
            const Batch& open = batches_.back();
            batch = 0;
            if (size <= capacity) {
                if (batches_.size() == 1 || open.constraints + size > capacity || open.bodies >= capacity)
                    batches_.emplace_back();
                batch = static_cast<std::uint32_t>(batches_.size() - 1);
                batches_[batch].constraints += size;
            }
        }
        batch_of_[body] = batch;
        ++batches_[batch].bodies;
    }

    std::uint32_t row = 1, first_body = 0, first = 0;
    for (Batch& batch : batches_) batch.constraints = 0;
    for (const Constraint& c : in.constraints)
        if (c.moves != Moves::Neither) ++batches_[batch_of_[member(c)]].constraints;
    for (Batch& batch : batches_) {
        batch.first_row = row;
        batch.first_body = first_body;
        batch.first_constraint = first;
        row += batch.bodies + 1;
        first_body += batch.bodies;
        first += batch.constraints;
        batch.bodies = batch.constraints = 0;
    }
    bodies_.resize(in.awake.size());
    constraints_.resize(first);
    for (const std::uint32_t body : in.awake) {
        Batch& batch = batches_[batch_of_[body]];
        bodies_[batch.first_body + batch.bodies++] = body;
    }
    for (std::size_t i = 0; i < in.constraints.size(); ++i) {
        if (in.constraints[i].moves == Moves::Neither) continue;
        Batch& batch = batches_[batch_of_[member(in.constraints[i])]];
        constraints_[batch.first_constraint + batch.constraints++] = static_cast<std::uint32_t>(i);
    }
}

}  // namespace fase::dynamics
