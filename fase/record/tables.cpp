/// Encodes and decodes the tables of a recording.
#include "fase/record/tables.hpp"

#include <cmath>
#include <optional>

#include "fase/record/format.hpp"
#include "fase/record/recording/shape_code.hpp"

namespace fase::record {
namespace {

void put_colour(ByteWriter& out, Colour colour) {
    out.put(colour.red);
    out.put(colour.green);
    out.put(colour.blue);
    out.put(colour.alpha);
}
Colour get_colour(ByteReader& in) {
    const auto red = in.get<std::uint8_t>(), green = in.get<std::uint8_t>(), blue = in.get<std::uint8_t>();
    return {red, green, blue, in.get<std::uint8_t>()};
}

void put_vertices(ByteWriter& out, std::span<const Vec3> vertices) {
    for (const Vec3 v : vertices) out.put_vec3(v);
}
void put_triangles(ByteWriter& out, std::span<const Triangle> triangles) {
    for (const Triangle& t : triangles) {
        for (const std::uint32_t corner : t) out.put(corner);
    }
}
std::vector<Vec3> get_vertices(ByteReader& in, std::size_t count) {
    if (in.failed() || count > in.remaining() / 12) {
        in.set_failed();
        return {};
    }
    std::vector<Vec3> vertices(count);
    for (Vec3& v : vertices) {
        v = in.get_vec3();
        if (!is_finite(v)) in.set_failed();
    }
    return vertices;
}
std::vector<Triangle> get_triangles(ByteReader& in, std::size_t count, std::size_t vertices) {
    if (in.failed() || count > in.remaining() / 12) {
        in.set_failed();
        return {};
    }
    std::vector<Triangle> triangles(count);
    for (Triangle& t : triangles) {
        for (std::uint32_t& corner : t) {
            corner = in.get<std::uint32_t>();
            if (corner >= vertices) in.set_failed();
        }
    }
    return triangles;
}
LocalPose get_checked_pose(ByteReader& in) {
    const LocalPose pose = in.get_pose();
    if (!is_finite(pose.position) || !is_finite(pose.rotation) || std::abs(length_squared(pose.rotation) - 1) > 0.01f) {
        in.set_failed();
    }
    return pose;
}
std::vector<std::string> get_names(ByteReader& in) {
    std::vector<std::string> names;
    const std::size_t count = in.get_count(1);
    if (count > 1000) in.set_failed();
    for (std::size_t i = 0; i < count && !in.failed(); ++i) names.push_back(in.get_text());
    return names;
}

/// What follows a shape's kind in the file.
struct ShapeContent {
    std::size_t number_count = 0;
    bool has_mesh = false;
};
/// Returns what is stored for a kind; nullopt for an unknown kind. Triangles is the only kind that is no shape of the
/// library.
std::optional<ShapeContent> content_of(ShapeKind kind) {
    if (kind == ShapeKind::Triangles) return ShapeContent{0, true};
    std::optional<ShapeContent> content;
    for_each_shape([&]<class S>() {
        if (kind != ShapeCode<S>::kind) return;
        if constexpr (StoredAsNumbers<S>) {
            content = ShapeContent{ShapeCode<S>::number_count, false};
        } else {
            content = ShapeContent{0, true};
        }
    });
    return content;
}

RecordedShape read_shape(ByteReader& in, const Tables&) {
    RecordedShape shape;
    const auto kind = in.get<std::uint8_t>();
    shape.kind = static_cast<ShapeKind>(kind);
    const std::optional<ShapeContent> content = content_of(shape.kind);
    if (!content) {
        in.set_failed();
        return shape;
    }
    for (std::size_t i = 0; i < content->number_count; ++i) {
        const float size = shape.size[i] = in.get<float>();
        if (!(size >= 0 && size < 1e9f)) in.set_failed();
    }
    if (content->has_mesh) {
        const auto vertices = in.get<std::uint32_t>(), triangles = in.get<std::uint32_t>();
        shape.vertices = get_vertices(in, vertices);
        shape.triangles = get_triangles(in, triangles, vertices);
    }
    return shape;
}
RecordedMesh read_mesh(ByteReader& in, const Tables&) {
    RecordedMesh mesh;
    const auto vertices = in.get<std::uint32_t>(), triangles = in.get<std::uint32_t>();
    const bool normals = (in.get<std::uint8_t>() & 1) != 0;
    mesh.vertices = get_vertices(in, vertices);
    if (normals) mesh.normals = get_vertices(in, vertices);
    mesh.triangles = get_triangles(in, triangles, vertices);
    return mesh;
}
RecordedBody read_body(ByteReader& in, const Tables&) {
    RecordedBody body;
    body.index = in.get<std::uint32_t>();
    body.generation = in.get<std::uint16_t>();
    body.kind = in.get<std::uint8_t>();
    in.get<std::uint8_t>();
    body.user = in.get<std::uint64_t>();
    body.mass = in.get<float>();
    body.colour = get_colour(in);
    body.name = in.get_text();
    if (body.kind > 2) in.set_failed();
    return body;
}
RecordedCollider read_collider(ByteReader& in, const Tables& tables) {
    RecordedCollider collider;
    collider.index = in.get<std::uint32_t>();
    collider.generation = in.get<std::uint16_t>();
    collider.sensor = (in.get<std::uint8_t>() & 1) != 0;
    in.get<std::uint8_t>();
    collider.body = in.get<std::uint32_t>();
    collider.shape = in.get<std::uint32_t>();
    collider.first_frame = in.get<std::uint64_t>();
    collider.pose = get_checked_pose(in);
    if (collider.body >= tables.bodies.size() || collider.shape >= tables.shapes.size()) in.set_failed();
    return collider;
}
RecordedVisual read_visual(ByteReader& in, const Tables& tables) {
    RecordedVisual visual;
    visual.body = in.get<std::uint32_t>();
    visual.mesh = in.get<std::uint32_t>();
    visual.pose = get_checked_pose(in);
    visual.colour = get_colour(in);
    if (visual.body >= tables.bodies.size() || visual.mesh >= tables.meshes.size()) in.set_failed();
    return visual;
}

template <class Row>
Result<void> read_table(ByteReader& in, const char* name, std::vector<Row>& rows,
                        Row (*read)(ByteReader&, const Tables&), const Tables& tables) {
    const std::size_t count = in.get_u32_count(1);
    for (std::size_t i = 0; i < count; ++i) {
        Row row = read(in, tables);
        if (in.failed() || rows.size() >= max_rows) {
            return Error{Status::Format,
                         std::string(name) + " row " + std::to_string(rows.size()),
                         "found an incomplete row or a reference to a missing row; expected a complete row with valid "
                         "references",
                         {}};
        }
        rows.push_back(std::move(row));
    }
    if (in.failed() || in.remaining() != 0) {
        return Error{Status::Format, std::string(name), "found a table whose length does not match its rows", {}};
    }
    return {};
}
Result<void> read_ends(ByteReader& in, Tables& tables) {
    const std::size_t count = in.get_u32_count(12);
    for (std::size_t i = 0; i < count; ++i) {
        const auto collider = in.get<std::uint32_t>();
        const auto frame = in.get<std::uint64_t>();
        if (in.failed() || collider >= tables.colliders.size()) {
            return Error{Status::Format, "collider ends", "found the row of a missing collider", {}};
        }
        tables.colliders[collider].end_frame = frame;
    }
    if (in.failed() || in.remaining() != 0) {
        return Error{Status::Format, "collider ends", "found a table whose length does not match its rows", {}};
    }
    return {};
}

}  // namespace

RecordedShape recorded(const Shape& shape) {
    return std::visit(
        []<class S>(const S& s) {
            if constexpr (StoredAsNumbers<S>) {
                return RecordedShape{ShapeCode<S>::kind, ShapeCode<S>::encode(s), {}, {}};
            } else {
                return ShapeCode<S>::encode_mesh(s);
            }
        },
        shape);
}

std::optional<Shape> shape_of(const RecordedShape& recorded) {
    std::optional<Shape> shape;
    for_each_shape([&]<class S>() {
        if constexpr (StoredAsNumbers<S>) {
            if (recorded.kind == ShapeCode<S>::kind) shape = ShapeCode<S>::decode(recorded.size);
        }
    });
    return shape;
}

void write(ByteWriter& out, const Head& head) {
    out.put_text(head.title);
    out.put_text(head.program);
    out.put(head.time_step);
    out.put_vec3(head.gravity);
    out.put(head.quanta_per_metre);
    out.put(std::uint32_t(head.contacts ? 1 : 0));
    for (const auto* names : {&head.stage_names, &head.counter_names}) {
        out.put_varuint(names->size());
        for (const std::string& name : *names) out.put_text(name);
    }
}
void write(ByteWriter& out, const RecordedShape& shape) {
    out.put(static_cast<std::uint8_t>(shape.kind));
    const ShapeContent content = content_of(shape.kind).value_or(ShapeContent{});
    for (std::size_t i = 0; i < content.number_count; ++i) out.put(shape.size[i]);
    if (!content.has_mesh) return;
    out.put(static_cast<std::uint32_t>(shape.vertices.size()));
    out.put(static_cast<std::uint32_t>(shape.triangles.size()));
    put_vertices(out, shape.vertices);
    put_triangles(out, shape.triangles);
}
void write(ByteWriter& out, const RecordedMesh& mesh) {
    out.put(static_cast<std::uint32_t>(mesh.vertices.size()));
    out.put(static_cast<std::uint32_t>(mesh.triangles.size()));
    out.put(static_cast<std::uint8_t>(mesh.normals.empty() ? 0 : 1));
    put_vertices(out, mesh.vertices);
    put_vertices(out, mesh.normals);
    put_triangles(out, mesh.triangles);
}
void write(ByteWriter& out, const RecordedBody& body) {
    out.put(body.index);
    out.put(body.generation);
    out.put(body.kind);
    out.put(std::uint8_t{0});
    out.put(body.user);
    out.put(body.mass);
    put_colour(out, body.colour);
    out.put_text(body.name);
}
void write(ByteWriter& out, const RecordedCollider& collider) {
    out.put(collider.index);
    out.put(collider.generation);
    out.put(static_cast<std::uint8_t>(collider.sensor ? 1 : 0));
    out.put(std::uint8_t{0});
    out.put(collider.body);
    out.put(collider.shape);
    out.put(collider.first_frame);
    out.put_pose(collider.pose);
}
void write(ByteWriter& out, const RecordedVisual& visual) {
    out.put(visual.body);
    out.put(visual.mesh);
    out.put_pose(visual.pose);
    put_colour(out, visual.colour);
}
void write(ByteWriter& out, const ColliderEnd& end) {
    out.put(end.collider);
    out.put(end.frame);
}

Result<Head> read_head(std::span<const std::byte> raw) {
    ByteReader in(raw);
    Head head;
    head.title = in.get_text();
    head.program = in.get_text();
    head.time_step = in.get<float>();
    head.gravity = in.get_vec3();
    head.quanta_per_metre = in.get<double>();
    head.contacts = (in.get<std::uint32_t>() & 1) != 0;
    head.stage_names = get_names(in);
    head.counter_names = get_names(in);
    if (in.failed() || !(head.quanta_per_metre > 1e-6 && head.quanta_per_metre < 1e9)) {
        return Error{Status::Format, "head", "found an incomplete or invalid head", {}};
    }
    return head;
}

bool holds_rows(ChunkType type) {
    return type == shapes_chunk || type == meshes_chunk || type == bodies_chunk || type == colliders_chunk ||
           type == collider_ends_chunk || type == visuals_chunk;
}

Result<void> read_rows(ChunkType type, std::span<const std::byte> raw, Tables& tables) {
    ByteReader in(raw);
    switch (type) {
        case shapes_chunk: return read_table(in, "shapes", tables.shapes, read_shape, tables);
        case meshes_chunk: return read_table(in, "meshes", tables.meshes, read_mesh, tables);
        case bodies_chunk: return read_table(in, "bodies", tables.bodies, read_body, tables);
        case colliders_chunk: return read_table(in, "colliders", tables.colliders, read_collider, tables);
        case visuals_chunk: return read_table(in, "visuals", tables.visuals, read_visual, tables);
        case collider_ends_chunk: return read_ends(in, tables);
        default: return Error{Status::Format, {}, "found a chunk without rows; expected a table chunk", {}};
    }
}

}  // namespace fase::record
