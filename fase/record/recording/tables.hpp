#pragma once
/// What a recording says once: its head and its tables of shapes, meshes, bodies, colliders and visuals.
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/geometry/shapes.hpp"
#include "fase/math/pose.hpp"
#include "fase/record/format.hpp"
#include "fase/record/recording/bytes.hpp"

namespace fase::record {

/// sRGB; alpha 0: none given, the viewer chooses.
struct Colour {
    std::uint8_t red = 0, green = 0, blue = 0, alpha = 0;
    friend bool operator==(const Colour&, const Colour&) = default;
};

/// What holds for the whole recording.
struct Head {
    std::string title;
    std::string program;  ///< what wrote it
    float time_step = 1.0f / 60;
    Vec3 gravity;
    double quanta_per_metre = default_quanta_per_metre;
    bool contacts = false;  ///< frames list contact points
    std::vector<std::string> stage_names, counter_names;
    friend bool operator==(const Head&, const Head&) = default;
};

using Triangle = std::array<std::uint32_t, 3>;

/// How a recorded shape is told. The numbers stand in files.
enum class ShapeKind : std::uint8_t { Sphere, Box, Capsule, Cylinder, Hull, HalfSpace, Triangles };

/// A shape by its numbers: a round one by `size`, a hull by its corners and triangles.
struct RecordedShape {
    ShapeKind kind = ShapeKind::Sphere;
    /// Sphere: radius; box: half sizes; capsule: radius, half length; cylinder: radius, half height.
    std::array<float, 3> size{};
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;  ///< counter-clockwise from outside
    friend bool operator==(const RecordedShape&, const RecordedShape&) = default;
};
/// The shape as it is told; a hull's faces are cut into fans of triangles.
[[nodiscard]] RecordedShape recorded(const Shape& shape);

/// A mesh for the picture.
struct RecordedMesh {
    std::vector<Vec3> vertices;
    std::vector<Vec3> normals;  ///< unit, one a vertex; or empty
    std::vector<Triangle> triangles;
    friend bool operator==(const RecordedMesh&, const RecordedMesh&) = default;
};
struct RecordedBody {
    std::uint32_t index = 0;
    std::uint16_t generation = 0;
    std::uint8_t kind = 2;  ///< 0 static, 1 kinematic, 2 dynamic: as it was when it came
    std::uint64_t user = 0;
    float mass = 0;
    Colour colour;
    std::string name;
    friend bool operator==(const RecordedBody&, const RecordedBody&) = default;
};
struct RecordedCollider {
    std::uint32_t index = 0;
    std::uint16_t generation = 0;
    bool sensor = false;
    std::uint32_t body = 0;   ///< row
    std::uint32_t shape = 0;  ///< row
    std::uint64_t first_frame = 0;
    std::uint64_t end_frame =
        std::numeric_limits<std::uint64_t>::max();  ///< the first without it; told apart from the row
    LocalPose pose;                                 ///< of the shape in the body
    friend bool operator==(const RecordedCollider&, const RecordedCollider&) = default;
};
/// A mesh on a body.
struct RecordedVisual {
    std::uint32_t body = 0;  ///< row
    std::uint32_t mesh = 0;  ///< row
    LocalPose pose;          ///< of the mesh in the body
    Colour colour;
    friend bool operator==(const RecordedVisual&, const RecordedVisual&) = default;
};
struct ColliderEnd {
    std::uint32_t collider = 0;
    std::uint64_t frame = 0;
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

void write(ByteWriter& out, const Head& head);
void write(ByteWriter& out, const RecordedShape& shape);
void write(ByteWriter& out, const RecordedMesh& mesh);
void write(ByteWriter& out, const RecordedBody& body);
void write(ByteWriter& out, const RecordedCollider& collider);
void write(ByteWriter& out, const RecordedVisual& visual);
void write(ByteWriter& out, const ColliderEnd& end);

/// Reads the unpacked head. Format when it is not one.
Result<Head> read_head(std::span<const std::byte> raw);
/// Adds the rows of one table chunk, each checked against the tables so far. Format, naming the row, when one is wrong;
/// then `tables` may hold the rows before it. Only for the types that hold tables.
Result<void> read_rows(ChunkType type, std::span<const std::byte> raw, Tables& tables);
/// Whether read_rows() knows the type.
[[nodiscard]] bool holds_rows(ChunkType type);

}  // namespace fase::record
