/// Buffers, views, accessors and meshes of a glTF document. Checks every offset in 64 bits before it allocates or
/// reads.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "fase/core/detail/files.hpp"
#include "fase/scene/detail/uri.hpp"
#include "fase/scene/gltf/document.hpp"

namespace fase::scene::gltf {
namespace {

constexpr std::size_t max_buffer_bytes = std::size_t{1} << 32;

std::uint64_t component_bytes(JsonValue at, std::uint64_t type) {
    switch (type) {
        case 5120:
        case 5121: return 1;
        case 5122:
        case 5123: return 2;
        case 5125:
        case 5126: return 4;
        default: refuse(at, fmt::format("found component type {}; expected 5120-5123, 5125 or 5126", type));
    }
}

struct ElementType {
    std::string_view name;
    std::uint64_t rows, columns;
};
constexpr ElementType element_types[]{{"SCALAR", 1, 1}, {"VEC2", 2, 1}, {"VEC3", 3, 1}, {"VEC4", 4, 1},
                                      {"MAT2", 2, 2},   {"MAT3", 3, 3}, {"MAT4", 4, 4}};

/// Bytes of one element. Columns of matrices start at multiples of 4 bytes.
std::uint64_t element_bytes(const ElementType& type, std::uint64_t component) {
    const std::uint64_t column = type.rows * component;
    return type.columns == 1 ? column : (column + 3) / 4 * 4 * type.columns;
}

/// Decodes one component; `type` was checked by component_bytes().
double decoded(const std::byte* bytes, std::uint64_t type, bool normalized) {
    const auto load = [bytes]<class T>(T value) {
        std::memcpy(&value, bytes, sizeof value);
        return value;
    };
    const auto scaled = [normalized](double value, double max_value) {
        return normalized ? std::max(value / max_value, -1.0) : value;
    };
    switch (type) {
        case 5120: return scaled(load(std::int8_t{}), 127);
        case 5121: return scaled(load(std::uint8_t{}), 255);
        case 5122: return scaled(load(std::int16_t{}), 32767);
        case 5123: return scaled(load(std::uint16_t{}), 65535);
        case 5125: return load(std::uint32_t{});
        default: return load(float{});
    }
}

}  // namespace

/// An accessor whose elements are inside its view.
struct Document::Accessor {
    JsonValue json;
    ElementType type{};
    std::uint64_t component_type = 5126, component = 4, count = 0, stride = 0;
    bool normalized = false;
    std::span<const std::byte> bytes;  ///< starts at the first element; empty: all zero
    std::optional<JsonValue> sparse;
};

void Document::load_buffers() {
    std::map<std::string, std::shared_ptr<const std::vector<std::byte>>> files;
    for (std::size_t i = 0; i < buffers_.size(); ++i) {
        const JsonValue buffer = buffers_[i];
        const JsonValue length_json = required_member(buffer, "byteLength", JsonKind::Number);
        const std::uint64_t length = *whole_in(buffer, "byteLength");
        if (length == 0) refuse(length_json, "found a buffer of 0 bytes; expected at least 1");
        const std::optional<std::string_view> uri = text_in(buffer, "uri");
        std::shared_ptr<const std::vector<std::byte>> bytes;
        std::uint64_t size = 0;
        if (!uri) {
            if (i == 0 && has_glb_buffer_)
                size = glb_buffer_.size();
            else {
                buffer_bytes_.push_back(nullptr);  // a placeholder: reading it is refused
                continue;
            }
        } else if (uri->starts_with("data:")) {
            Result<std::vector<std::byte>> data = decode_data_uri(*uri);
            if (!data) refuse(*buffer.find("uri"), data.error().problem);
            bytes = std::make_shared<const std::vector<std::byte>>(*std::move(data));
            size = bytes->size();
        } else {
            const Result<std::string> path = resolve_uri(folder_, *uri);
            if (!path)
                refuse(*buffer.find("uri"), path.error().problem, fmt::format("the uri is {}", quoted_short(*uri)));
            auto& file = files[*path];
            if (!file) {
                Result<std::vector<std::byte>> read = read_file(*path, max_buffer_bytes);
                if (!read)
                    refuse(*buffer.find("uri"), read.error().problem, fmt::format("the uri is {}", quoted_short(*uri)));
                file = std::make_shared<const std::vector<std::byte>>(*std::move(read));
                budget_ += 8 * file->size();
            }
            bytes = file;
            size = file->size();
        }
        if (length > size)
            refuse(length_json,
                   fmt::format("found a buffer of {} bytes; expected at most {}, the size of its data", length, size));
        if (!uri && size - length > 3)
            refuse(length_json,
                   fmt::format("found a buffer of {} bytes for a chunk of {}; expected at most 3 less", length, size));
        if (!bytes) bytes = std::make_shared<const std::vector<std::byte>>(glb_buffer_.begin(), glb_buffer_.end());
        buffer_bytes_.push_back(std::move(bytes));
    }
}

void Document::check_views() const {
    for (std::size_t i = 0; i < views_.size(); ++i) {
        const JsonValue view = views_[i];
        static_cast<void>(required_member(view, "buffer", JsonKind::Number));
        const JsonValue buffer = buffers_.empty()
                                     ? (refuse(view, "found a buffer view; expected buffers in the file"), view)
                                     : buffers_[index_of(*view.find("buffer"), buffers_.size(), "buffers")];
        const std::uint64_t size = *whole_in(buffer, "byteLength"), offset = whole_in(view, "byteOffset").value_or(0);
        const JsonValue length_json = required_member(view, "byteLength", JsonKind::Number);
        const std::uint64_t length = *whole_in(view, "byteLength");
        if (length == 0) refuse(length_json, "found a view of 0 bytes; expected at least 1");
        if (offset > size || length > size - offset) {
            refuse(view, fmt::format("found bytes {} to {}; expected them within the buffer's {}", offset,
                                     offset + length, size));
        }
        const std::optional<std::uint64_t> stride = whole_in(view, "byteStride");
        if (!stride) continue;
        if (*stride < 4 || *stride > 252 || *stride % 4 != 0 || *stride > length) {
            refuse(*view.find("byteStride"),
                   fmt::format("found a stride of {}; expected a multiple of 4 from 4 to 252, at most the view's {}",
                               *stride, length));
        }
    }
}

std::span<const std::byte> Document::view(std::uint32_t index) const {
    const JsonValue view = views_[index];
    const auto& bytes = buffer_bytes_[index_of(*view.find("buffer"), buffers_.size(), "buffers")];
    if (!bytes) refuse(*view.find("buffer"), "found a buffer without data; expected a uri or a GLB's binary chunk");
    return std::span(*bytes).subspan(static_cast<std::size_t>(whole_in(view, "byteOffset").value_or(0)),
                                     static_cast<std::size_t>(*whole_in(view, "byteLength")));
}

Document::Accessor Document::accessor(std::uint32_t index) const {
    Accessor a;
    a.json = accessors_[index];
    const JsonValue count_json = required_member(a.json, "count", JsonKind::Number);
    a.count = *whole_in(a.json, "count", 0xffffffff);
    if (a.count == 0) refuse(count_json, "found 0 elements; expected at least 1");
    const JsonValue component_json = required_member(a.json, "componentType", JsonKind::Number);
    a.component_type = *whole_in(a.json, "componentType");
    a.component = component_bytes(component_json, a.component_type);
    const JsonValue type_json = required_member(a.json, "type", JsonKind::String);
    const auto* type = std::find_if(std::begin(element_types), std::end(element_types),
                                    [&](const ElementType& t) { return t.name == type_json.string(); });
    if (type == std::end(element_types))
        refuse(type_json,
               fmt::format("found type {}; expected SCALAR, VEC2-4 or MAT2-4", quoted_short(type_json.string())));
    a.type = *type;
    a.normalized = flag_in(a.json, "normalized", false);
    a.sparse = member(a.json, "sparse", JsonKind::Object);
    const std::uint64_t element = element_bytes(a.type, a.component);
    a.stride = element;
    const std::optional<std::uint32_t> view_index = index_in(a.json, "bufferView", views_.size(), "bufferViews");
    const std::uint64_t offset = whole_in(a.json, "byteOffset").value_or(0);
    if (!view_index) return a;
    const JsonValue view_json = views_[*view_index];
    const std::uint64_t length = *whole_in(view_json, "byteLength");
    a.stride = whole_in(view_json, "byteStride").value_or(element);
    if (a.stride < element)
        refuse(a.json, fmt::format("found elements of {} bytes {} apart; expected no overlap", element, a.stride));
    if (offset % a.component != 0 || a.stride % a.component != 0 ||
        (whole_in(view_json, "byteOffset").value_or(0) + offset) % a.component != 0) {
        refuse(a.json, fmt::format("found components of {} bytes at offset {}; expected offsets and strides that are "
                                   "multiples of that size",
                                   a.component, offset));
    }
    // count < 2^32 and stride <= 252: no overflow.
    const std::uint64_t need = a.stride * (a.count - 1) + element;
    if (offset > length || need > length - offset) {
        refuse(a.json, fmt::format("found {} elements up to byte {}; expected them within the view's {}", a.count,
                                   offset + need, length));
    }
    if (buffer_bytes_[index_of(*view_json.find("buffer"), buffers_.size(), "buffers")]) {
        a.bytes = view(*view_index).subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(need));
    }
    return a;
}

void Document::check_accessors() const {
    for (std::uint32_t i = 0; i < accessors_.size(); ++i) {
        const Accessor a = accessor(i);
        if (!a.sparse) continue;
        const JsonValue indices = required_member(*a.sparse, "indices", JsonKind::Object),
                        values = required_member(*a.sparse, "values", JsonKind::Object);
        const JsonValue count_json = required_member(*a.sparse, "count", JsonKind::Number);
        const std::uint64_t count = *whole_in(*a.sparse, "count", 0xffffffff);
        if (count == 0 || count > a.count)
            refuse(count_json, fmt::format("found {} replaced elements; expected 1 to {}", count, a.count));
        const JsonValue type_json = required_member(indices, "componentType", JsonKind::Number);
        const std::uint64_t type = *whole_in(indices, "componentType");
        if (type != 5121 && type != 5123 && type != 5125)
            refuse(type_json, fmt::format("found component type {}; expected 5121, 5123 or 5125", type));
        const std::uint64_t sizes[]{component_bytes(type_json, type), element_bytes(a.type, a.component)};
        const JsonValue parts[]{indices, values};
        for (int k = 0; k < 2; ++k) {
            static_cast<void>(required_member(parts[k], "bufferView", JsonKind::Number));
            const std::uint32_t view_index = index_of(*parts[k].find("bufferView"), views_.size(), "bufferViews");
            const std::uint64_t length = *whole_in(views_[view_index], "byteLength"),
                                offset = whole_in(parts[k], "byteOffset").value_or(0);
            if (offset > length || count * sizes[k] > length - offset) {
                refuse(parts[k],
                       fmt::format("found {} elements of {} bytes from {}; expected them within the view's {}", count,
                                   sizes[k], offset, length));
            }
        }
    }
}

void Document::check_meshes() const {
    for (std::uint32_t i = 0; i < meshes_.size(); ++i) static_cast<void>(primitives(i));
    for (std::uint32_t i = 0; i < materials_.size(); ++i) static_cast<void>(colour(i));
}

std::vector<Primitive> Document::primitives(std::uint32_t mesh) const {
    std::vector<Primitive> all;
    const JsonValue list = required_member(meshes_[mesh], "primitives", JsonKind::Array);
    if (list.size() == 0) refuse(list, "found an empty array; expected at least one primitive");
    list.for_each_element([&](JsonValue json) {
        Primitive primitive;
        primitive.mesh = mesh;
        primitive.number = static_cast<std::uint32_t>(all.size());
        const JsonValue attributes = required_member(json, "attributes", JsonKind::Object);
        primitive.mode = whole_in(json, "mode", 6).value_or(4);
        attributes.for_each_member([&](std::string_view, JsonValue value) {
            static_cast<void>(index_of(value, accessors_.size(), "accessors"));
        });
        const std::optional<JsonValue> positions = attributes.find("POSITION");
        primitive.positions = positions ? index_of(*positions, accessors_.size(), "accessors") : 0;
        if (!positions)
            primitive.mode = 0;
        else if (accessor(primitive.positions).type.name != "VEC3")
            refuse(*positions, "found positions of another type; expected VEC3");
        primitive.indices = index_in(json, "indices", accessors_.size(), "accessors");
        if (primitive.indices) {
            const Accessor indices = accessor(*primitive.indices);
            const bool is_unsigned =
                indices.type.name == "SCALAR" &&
                (indices.component_type == 5121 || indices.component_type == 5123 || indices.component_type == 5125);
            if (!is_unsigned) refuse(*json.find("indices"), "found indices of another type; expected unsigned SCALAR");
        }
        primitive.material = index_in(json, "material", materials_.size(), "materials");
        all.push_back(primitive);
    });
    return all;
}

Colour Document::colour(std::optional<std::uint32_t> material) const {
    double c[4] = {1, 1, 1, 1};
    if (material) {
        const std::optional<JsonValue> surface =
            member(materials_[*material], "pbrMetallicRoughness", JsonKind::Object);
        if (surface && numbers_in(*surface, "baseColorFactor", c)) {
            for (const double part : c) {
                if (!(part >= 0 && part <= 1))
                    refuse(*surface->find("baseColorFactor"), fmt::format("found {}; expected 0 to 1", part));
            }
        }
    }
    return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2]), static_cast<float>(c[3])};
}

void Document::spend(JsonValue at, std::uint64_t bytes) {
    if (bytes > budget_)
        refuse(at,
               fmt::format("found data that grows to {} bytes or more when read; expected data within the memory limit",
                           bytes));
    budget_ -= bytes;
}

void Document::spend(JsonValue at, const Shape& shape) {
    if (const auto* mesh = std::get_if<fase::Mesh>(&shape)) spend(at, mesh->data->bytes());
    if (const auto* hull = std::get_if<ConvexHull>(&shape)) {
        spend(at, hull->vertices.size() * sizeof(Vec3) + hull->faces.size() * sizeof(ConvexHull::Face) +
                      hull->face_vertices.size() * sizeof(std::uint32_t) +
                      hull->edges.size() * sizeof(ConvexHull::Edge));
    }
}

std::vector<double> Document::elements(std::uint32_t index, int components) {
    const Accessor a = accessor(index);
    const auto width = static_cast<std::uint64_t>(components);
    if (a.type.rows * a.type.columns != width)
        refuse(a.json, fmt::format("found {} numbers per element; expected {}", a.type.rows * a.type.columns, width));
    spend(a.json, a.count * width * sizeof(double));
    if (a.json.find("bufferView") && a.bytes.empty())
        refuse(a.json, "found a buffer without data; expected a uri or a GLB's binary chunk");
    std::vector<double> out(static_cast<std::size_t>(a.count * width), 0);
    const auto store = [&](std::size_t element, const std::byte* from) {
        for (std::size_t k = 0; k < width; ++k)
            out[element * width + k] = decoded(from + k * a.component, a.component_type, a.normalized);
    };
    if (!a.bytes.empty()) {
        for (std::size_t i = 0; i < a.count; ++i) store(i, a.bytes.data() + i * a.stride);
    }
    if (a.sparse) {
        const JsonValue indices = *a.sparse->find("indices"), values = *a.sparse->find("values");
        const std::uint64_t count = *whole_in(*a.sparse, "count"), type = *whole_in(indices, "componentType");
        const auto start = [&](JsonValue part) {
            return view(index_of(*part.find("bufferView"), views_.size(), "bufferViews"))
                .subspan(static_cast<std::size_t>(whole_in(part, "byteOffset").value_or(0)));
        };
        const std::span<const std::byte> index_bytes = start(indices), value_bytes = start(values);
        for (std::size_t i = 0; i < count; ++i) {
            const auto element = static_cast<std::uint64_t>(
                decoded(index_bytes.data() + i * component_bytes(indices, type), type, false));
            if (element >= a.count)
                refuse(indices, fmt::format("found index {}; expected one below {}", element, a.count));
            store(static_cast<std::size_t>(element), value_bytes.data() + i * element_bytes(a.type, a.component));
        }
    }
    return out;
}

std::vector<Vec3> Document::positions(const Primitive& primitive) {
    const std::vector<double> numbers = elements(primitive.positions, 3);
    std::vector<Vec3> points(numbers.size() / 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3d p{numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
        if (!is_finite(p) || std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > 1e30) {
            refuse(accessors_[primitive.positions],
                   fmt::format("found ({}, {}, {}) as point {}; expected finite numbers", p.x, p.y, p.z, i));
        }
        points[i] = to_float(p);
    }
    return points;
}

std::vector<std::uint32_t> Document::triangles(const Primitive& primitive, std::size_t points) {
    if (primitive.mode < 4) return {};
    std::vector<std::uint32_t> corners;
    if (primitive.indices) {
        const std::vector<double> numbers = elements(*primitive.indices, 1);
        for (const double number : numbers) {
            if (number >= static_cast<double>(points))
                refuse(accessors_[*primitive.indices],
                       fmt::format("found index {}; expected one below {}, the number of points", number, points));
            corners.push_back(static_cast<std::uint32_t>(number));
        }
    } else {
        for (std::uint32_t i = 0; i < points; ++i) corners.push_back(i);
    }
    if (primitive.mode == 4) {
        corners.resize(corners.size() / 3 * 3);
        return corners;
    }
    std::vector<std::uint32_t> out;
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
        const bool fan = primitive.mode == 6, odd = i % 2 == 1;
        out.push_back(fan ? corners[i + 1] : corners[odd ? i + 1 : i]);
        out.push_back(fan ? corners[i + 2] : corners[odd ? i : i + 1]);
        out.push_back(fan ? corners[0] : corners[i + 2]);
    }
    return out;
}

}  // namespace fase::scene::gltf
