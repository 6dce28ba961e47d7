#pragma once
/// The load that each contact is known to bear when all bodies rest.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/core/tasks.hpp"
#include "fase/dynamics/solver/bodies.hpp"
#include "fase/dynamics/solver/contact_lanes.hpp"
#include "fase/dynamics/solver/manifold_pool.hpp"

namespace fase::dynamics {

/// Passes weight down over the contacts: from the highest body to the lowest, the weight of a body and what lies on it
/// is shared between the contacts below, in proportion to the cosines of their normals. Without it, a soft contact
/// learns its load only by giving way, and stacks sag. The result depends on the arguments alone. O(contacts + bodies).
/// Source of the order: Guendelman, Bridson, Fedkiw 2003, Nonconvex rigid bodies with stacking (shock propagation;
/// there for masses).
class KnownLoads {
public:
    struct Input {
        const ConstraintInput& list;
        const ManifoldPool& manifolds;
        const Bodies& bodies;
        std::span<const std::uint32_t> awake;        ///< bodies
        std::span<const std::uint32_t> row_of_body;  ///< 0: static or asleep
        std::span<const SolverMotion> motions;       ///< by row
        Vec3 gravity;                                ///< m/s²
        float resting_gap = 0;                       ///< m; contacts that are farther apart carry nothing
    };
    /// Returns for each constraint the impulse along its normal, N s per sub-step, valid until the next call.
    [[nodiscard]] std::span<const float> find(const Input& in, TaskRunner& tasks);

private:
    /// A body that passes its load on to what it lies on.
    struct Carrier {
        double height = 0;  // of the centre of mass
        float load = 0;     // N s per sub-step: its own weight and what lies on it
        float cosines = 0;  // sum over the contacts below
        std::uint32_t first = 0, end = 0;
    };
    /// A contact as loads pass it: from the row `upper` (0: it carries nothing) to `lower`.
    struct Support {
        float cosine;  // of the angle between the normal and the vertical
        std::uint32_t upper, lower;
    };
    void weigh_bodies(const Input& in, Vec3 up);
    void find_supports(const Input& in, Vec3 up, TaskRunner& tasks);
    void list_contacts_below();
    /// Lists the rows that lie on contacts, the highest first when any lies on another.
    void sort_top_down(bool any_stack);

    std::vector<float> loads_;       // by constraint
    std::vector<Support> supports_;  // by constraint
    std::vector<Carrier> carriers_;  // by row
    std::vector<std::uint32_t> contacts_below_;
    std::vector<std::uint32_t> top_down_, sort_keys_, sort_scratch_;  // rows; keys by row
};

}  // namespace fase::dynamics
