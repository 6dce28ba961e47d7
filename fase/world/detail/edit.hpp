#pragma once
/// Helpers of the functions that change a world: memory, boxes, masses, shared shapes.
///
/// Every edit has three parts: checks, then all allocations, then changes that cannot fail. So an edit that returns an
/// Error has changed nothing, whatever the reason.
#include <new>
#include <stdexcept>
#include <string>

#include "fase/world/check_values.hpp"
#include "fase/world/detail/motion_states.hpp"
#include "fase/world/detail/state.hpp"
#include "fase/world/world.hpp"

namespace fase {

/// Returns the Error for an id that the world does not contain: the default one, one of another world, one that was
/// never issued, or one whose body or collider was removed.
[[nodiscard]] Error invalid_id(const WorldState& state, BodyId id, const char* where);
[[nodiscard]] Error invalid_id(const WorldState& state, ColliderId id, const char* where);
/// Returns a BadArgument error: "where: found …; expected …".
[[nodiscard]] Error refused(std::string where, std::string found, std::string expected, std::string remedy = "");
/// Returns the Error for a world whose last step ran out of memory.
[[nodiscard]] Error broken_world(const char* where);
/// Returns a NoMemory error without an allocation: short texts lie inside the strings.
template <std::size_t n> [[nodiscard]] Error out_of_memory(const char (&where)[n]) noexcept {
    static_assert(n <= 16);
    return {Status::NoMemory, where, "out of memory", ""};
}
/// Runs a public function of a world. Refuses it in a broken world; returns an Error when memory runs out, also for the
/// text of another Error.
template <std::size_t n, class F>
[[nodiscard]] auto guarded(const WorldState& state, const char (&where)[n], const F& call) -> decltype(call()) {
    try {
        if (state.broken) return broken_world(where);
        return call();
    } catch (const std::bad_alloc&) {
        return out_of_memory(where);
    } catch (const std::length_error&) {
        return out_of_memory(where);
    }
}

/// Makes empty sets of boxes for the value of Setup::structure, which must be valid.
[[nodiscard]] pairs::BoxSets make_box_sets(const std::string& structure);

/// Grows the capacity to `size` or more. Doubles, so that many calls take amortised O(1).
template <class V> void reserve_for(V& v, std::size_t size) {
    if (v.capacity() < size) v.reserve(std::max(size, 2 * v.capacity()));
}
/// Allocates for `count` calls of request_wake() or disturb().
inline void reserve_wakes(WorldState& state, std::size_t count) {
    reserve_for(state.bodies.to_wake, state.bodies.to_wake.size() + count);
}
/// Allocates what one more body or `count` more colliders need; the next edits of any body then allocate nothing for
/// them.
void reserve_body(WorldState& state);
void reserve_colliders(WorldState& state, std::size_t count);

/// Packs locks into bits. Bits 0..2: linear x, y, z; bits 3..5: angular.
[[nodiscard]] std::uint8_t bits_of(AxisLocks locks);
/// Sets the motion state of a body from its kind and velocity, and moves its pairs. The next step moves its boxes and
/// queries its pairs. Call reserve_pair_moves() before.
void update_motion_state(WorldState& state, std::uint32_t body);
void reserve_pair_moves(WorldState& state, std::uint32_t body);

/// Recomputes the box of a collider. The next step updates it in its broad-phase structure and queries its pairs.
void update_box(WorldState& state, std::uint32_t collider);
/// The same for all colliders of a body.
void update_boxes(WorldState& state, std::uint32_t body);

/// What the mass and the colliders of a body determine.
struct BodyShape {
    MassProperties mass;
    LocalPose principal;
    float inverse_mass = 0;
    Vec3 inverse_moments;
    float reach = 0, inner_radius = 0;
};
/// A body as an edit would leave it.
struct BodyEdit {
    BodyKind kind = BodyKind::Dynamic;
    bool mass_given = false;
    MassProperties mass;  ///< when it is given
    std::uint32_t first_collider = no_index;
    std::uint32_t removed = no_index;  ///< a collider to leave out
    const Shape* added = nullptr;      ///< a shape to add, as `added_def` says
    const ColliderDef* added_def = nullptr;
    std::span<const ColliderShape> parts;  ///< shapes to add
};
/// Returns the body as it is.
[[nodiscard]] BodyEdit edit_of(const WorldState& state, std::uint32_t body);
/// Computes what an edit would make of a body. Allocates; changes nothing.
[[nodiscard]] BodyShape shape_of(const WorldState& state, const BodyEdit& edit);
/// The same, checked: an Error when mass, inertia or the place of the centre would be out of range. `pose` is that of
/// the body's frame.
Result<BodyShape> checked_shape_of(const WorldState& state, const BodyEdit& edit, const Pose& pose,
                                   const std::string& where);
/// Gives a body its new shape. The body's frame does not move; the velocity becomes that of the new centre.
void set_shape(WorldState& state, std::uint32_t body, const BodyShape& shape);

/// Returns the index of a shared shape equal to `shape`, added when there is none, and increments its user count. When
/// memory runs out, nothing has changed.
[[nodiscard]] std::uint32_t share_shape(WorldState& state, const Shape& shape);
/// The same for all shapes of a compound.
[[nodiscard]] std::vector<std::uint32_t> share_shapes(WorldState& state, std::span<const ColliderShape> parts);
/// Decrements the user count of a shared shape, and frees the shape at 0.
void release_shape(WorldState& state, std::uint32_t index);
/// What messages call a shape without a mass.
[[nodiscard]] inline const char* noun_of(const Shape& shape) { return is_mesh(shape) ? "mesh" : "half-space"; }
/// Returns the hash of a shape's content, SharedShape::key.
[[nodiscard]] std::uint64_t content_key(const Shape& shape);

}  // namespace fase
