#pragma once
/// Removes ghost hits: contacts of a moving shape with faces and edges that its neighbours hide.
#include <cstdint>
#include <span>

#include "fase/geometry/shapes.hpp"
#include "fase/math/transform_d.hpp"
#include "fase/narrow/manifold.hpp"

namespace fase::narrow {

/// A shape that moves over pieces of the ground. Frame: any that is near the shape; the same for all pieces.
struct SeamMover {
    const Shape* shape = nullptr;
    TransformD pose;
    Vec3d path;              ///< metres that it moves until the next step
    double margin = 0;       ///< contacts are made at this distance
    bool is_fast = false;    ///< its path is long against its size
    float inner_radius = 0;  ///< metres; sets the scale of the tolerances
    double detour = 0;       ///< metres by which forces, spin and other bodies may move its surface from the path
};

/// What a piece of the ground is to the moving shape.
struct SeamPiece {
    const Shape* shape = nullptr;  ///< only boxes, hulls and half-spaces have faces that can hide or be hidden
    TransformD pose;
    std::uint32_t frame = 0;  ///< pieces of the same number do not move against each other; 0: they rest
};

/// The contact of the moving shape with one piece.
struct SeamContact {
    SeamPiece piece;
    Manifold manifold;     ///< in the frame of the mover; the normal points from the piece to the mover
    bool is_kept = false;  ///< an old manifold that stays as it is
    bool changed = false;  ///< set by correct_seams(): `manifold` is another one, or has no points any more

    // Inside correct_seams().
    Vec3d normal, point;    ///< the direction that may be hidden, and the point of the piece where it is
    double separation = 0;  ///< the smallest one
    bool is_live = false;
    double clearance = 0;  ///< metres that the path leaves to the piece
    int hidden_by = -1, hiding_face = -1, own_face = -1;
    Vec3d lean;  ///< from the point along the hiding face
};

/// Corrects the contacts of one moving shape with all pieces near it, so that these act as one surface:
/// - A contact that the path of a fast shape misses ends: by more than other contacts can push the shape aside.
/// - A contact whose normal leans over a face of a neighbour at the same height is hidden. It becomes the contact with
///   the plane of the piece's own face there, or it ends when a contact with the plane of the hiding face is kept.
/// - A contact with a side that the path does not enter becomes that with the plane of the face that it passes over.
/// Contacts within reach end only when another plane keeps the shape out. Steps lower than 2 mm (or a twentieth of the
/// inner radius) and gaps narrower than 1 mm are none. Deterministic, thread-safe, allocates nothing. Cost: contacts ×
/// faces.
void correct_seams(const SeamMover& mover, std::span<SeamContact> contacts);

}  // namespace fase::narrow
