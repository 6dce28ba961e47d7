#pragma once
/// The head of a recording and its tables of shapes, meshes, bodies, colliders and visuals.
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/geometry/shapes.hpp"
#include "fase/math/pose.hpp"
#include "fase/record/format.hpp"
#include "fase/record/recording/bytes.hpp"

namespace fase::record {

/// An sRGB colour; alpha 0: not given, the viewer selects one.
struct Colour {
    std::uint8_t red = 0, green = 0, blue = 0, alpha = 0;
    friend bool operator==(const Colour&, const Colour&) = default;
};

/// Settings of the whole recording.
struct Head {
    std::string title;
    std::string program;  ///< the program that wrote the recording
    float time_step = 1.0f / 60;
    Vec3 gravity;
    double quanta_per_metre = default_quanta_per_metre;
    bool contacts = false;  ///< whether frames list contact points
    std::vector<std::string> stage_names, counter_names;
    friend bool operator==(const Head&, const Head&) = default;
};

/// Three vertex indices.
using Triangle = std::array<std::uint32_t, 3>;

/// The kind of a recorded shape. Files contain its number: append new kinds, never renumber.
enum class ShapeKind : std::uint8_t { Sphere, Box, Capsule, Cylinder, Hull, HalfSpace, Triangles };

/// A stored shape: its numbers in `size`, or vertices and triangles. ShapeCode says which, for each shape.
struct RecordedShape {
    ShapeKind kind = ShapeKind::Sphere;
    /// Sphere: radius; box: half sizes; capsule: radius, half length; cylinder: radius, half height.
    std::array<float, 3> size{};
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;  ///< counter-clockwise from outside
    friend bool operator==(const RecordedShape&, const RecordedShape&) = default;
};
/// Returns the stored form of a shape; splits the faces of a hull into fans of triangles.
[[nodiscard]] RecordedShape recorded(const Shape& shape);
/// Returns the shape of the library; nullopt for a kind that is stored as vertices and triangles.
[[nodiscard]] std::optional<Shape> shape_of(const RecordedShape& recorded);

/// A mesh that is drawn instead of shapes.
struct RecordedMesh {
    std::vector<Vec3> vertices;
    std::vector<Vec3> normals;  ///< unit, one per vertex; or empty
    std::vector<Triangle> triangles;
    friend bool operator==(const RecordedMesh&, const RecordedMesh&) = default;
};
/// A body; a reused slot of the world is a new row.
struct RecordedBody {
    std::uint32_t index = 0;
    std::uint16_t generation = 0;
    std::uint8_t kind = 2;   ///< 0 static, 1 kinematic, 2 dynamic: when it was added
    std::uint64_t user = 0;  ///< the user's number
    float mass = 0;          ///< kg; 0 unless dynamic
    Colour colour;
    std::string name;
    friend bool operator==(const RecordedBody&, const RecordedBody&) = default;
};
/// A collider.
struct RecordedCollider {
    std::uint32_t index = 0;
    std::uint16_t generation = 0;
    bool sensor = false;
    std::uint32_t body = 0;                                               ///< row
    std::uint32_t shape = 0;                                              ///< row
    std::uint64_t first_frame = 0;                                        ///< the first frame with it
    std::uint64_t end_frame = std::numeric_limits<std::uint64_t>::max();  ///< the first frame without it; stored in
                                                                          ///< another table (ColliderEnd)
    LocalPose pose;                                                       ///< of the shape in the body
    friend bool operator==(const RecordedCollider&, const RecordedCollider&) = default;
};
/// A mesh that is attached to a body.
struct RecordedVisual {
    std::uint32_t body = 0;  ///< row
    std::uint32_t mesh = 0;  ///< row
    LocalPose pose;          ///< of the mesh in the body
    Colour colour;
    friend bool operator==(const RecordedVisual&, const RecordedVisual&) = default;
};
/// The removal of a collider from a body that stays.
struct ColliderEnd {
    std::uint32_t collider = 0;  ///< row
    std::uint64_t frame = 0;     ///< the first without it
};

/// All tables of a recording.
struct Tables {
    Head head;
    std::vector<RecordedShape> shapes;
    std::vector<RecordedMesh> meshes;
    std::vector<RecordedBody> bodies;
    std::vector<RecordedCollider> colliders;
    std::vector<RecordedVisual> visuals;
};

// Append one row (or the head) in the format of format.md.
void write(ByteWriter& out, const Head& head);
void write(ByteWriter& out, const RecordedShape& shape);
void write(ByteWriter& out, const RecordedMesh& mesh);
void write(ByteWriter& out, const RecordedBody& body);
void write(ByteWriter& out, const RecordedCollider& collider);
void write(ByteWriter& out, const RecordedVisual& visual);
void write(ByteWriter& out, const ColliderEnd& end);

/// Decodes the unpacked head. Error Format if it is invalid.
Result<Head> read_head(std::span<const std::byte> raw);
/// Appends the rows of one table chunk to `tables`; checks each row against the tables so far. Error Format, with the
/// row, if a row is invalid (`tables` then may contain the rows before it) or the chunk type has no rows.
Result<void> read_rows(ChunkType type, std::span<const std::byte> raw, Tables& tables);
/// Returns whether a chunk type contains table rows.
[[nodiscard]] bool holds_rows(ChunkType type);

}  // namespace fase::record
