/// Building collision meshes.
#include "fase/geometry/collision_mesh.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <new>
#include <stdexcept>
#include <string>

#include "fase/core/detail/text.hpp"
#include "fase/core/hash.hpp"
#include "fase/core/no_index.hpp"
#include "fase/geometry/shape_description.hpp"

namespace fase {
namespace {

using Corners = std::array<std::uint32_t, 3>;

Error refused(std::string found, std::string expected, std::string remedy = {}) {
    return {Status::BadArgument, "mesh", "found " + std::move(found) + "; expected " + std::move(expected),
            std::move(remedy)};
}

/// A table of indices with open addressing; what they stand for is compared by the caller.
class IndexTable {
public:
    explicit IndexTable(std::size_t count) : slots_(std::bit_ceil(2 * count + 2), no_index) {}

    /// Returns the index with this hash for which equal(index) holds, or stores `index`, and returns it.
    template <class Equal> std::uint32_t find_or_add(std::uint64_t hash, std::uint32_t index, const Equal& equal) {
        const std::size_t mask = slots_.size() - 1;
        for (std::size_t at = hash & mask;; at = (at + 1) & mask) {
            if (slots_[at] == no_index) return slots_[at] = index;
            if (equal(slots_[at])) return slots_[at];
        }
    }

private:
    std::vector<std::uint32_t> slots_;
};

bool is_valid(Vec3 p) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(p[axis]) <= max_shape_size)) return false;
    return true;
}

/// Whether a triangle has an area that float arithmetic can tell: its height is above a millionth of its longest side.
bool has_area(Vec3 a, Vec3 b, Vec3 c) {
    const Vec3d u = to_double(b) - to_double(a), v = to_double(c) - to_double(a), w = v - u;
    const double longest = std::max({length_squared(u), length_squared(v), length_squared(w)});
    return length_squared(cross(u, v)) > 1e-12 * longest * longest;
}

Result<void> check_input(std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
                         const MeshOptions& options) {
    if (indices.size() % 3 != 0)
        return refused(detail::format("{} indices", indices.size()), "three for each triangle");
    if (indices.size() / 3 > CollisionMesh::max_triangles)
        return refused(detail::format("{} triangles", indices.size() / 3),
                       detail::format("at most {}", CollisionMesh::max_triangles), "divide the mesh");
    if (!options.materials.empty() && options.materials.size() != indices.size() / 3)
        return refused(detail::format("{} materials", options.materials.size()),
                       detail::format("one for each of {} triangles, or none", indices.size() / 3));
    for (std::size_t i = 0; i < indices.size(); ++i)
        if (indices[i] >= positions.size())
            return refused(detail::format("index {} in triangle {}", indices[i], i / 3),
                           detail::format("an index below {}", positions.size()));
    for (std::size_t i = 0; i < positions.size(); ++i)
        if (!is_valid(positions[i]))
            return refused(detail::format("position {} out of range", i), "finite coordinates within 1e5 m");
    return {};
}

}  // namespace

class CollisionMeshBuilder {
public:
    CollisionMeshBuilder() : mesh_(std::make_shared<CollisionMesh>()) {}

    void add(std::span<const Vec3> positions, std::span<const std::uint32_t> indices, const MeshOptions& options) {
        mesh_->two_sided_ = options.two_sided;
        const std::vector<std::uint32_t> vertex_of = weld(positions, indices);
        IndexTable seen(indices.size() / 3);
        mesh_->corners_.reserve(indices.size() / 3);
        mesh_->numbers_.reserve(indices.size() / 3);
        for (std::size_t t = 0; t < indices.size() / 3; ++t) {
            const Corners corners{vertex_of[indices[3 * t]], vertex_of[indices[3 * t + 1]],
                                  vertex_of[indices[3 * t + 2]]};
            const std::vector<Vec3>& v = mesh_->vertices_;
            if (!has_area(v[corners[0]], v[corners[1]], v[corners[2]])) {
                ++mesh_->report_.degenerate;
                continue;
            }
            const auto place = static_cast<std::uint32_t>(mesh_->corners_.size());
            const Corners first = from_smallest(corners);
            const std::uint64_t hash =
                mix_bits((std::uint64_t{first[0]} << 32 | first[1]) ^ mix_bits(std::uint64_t{first[2]}));
            const auto same = [&](std::uint32_t other) { return from_smallest(mesh_->corners_[other]) == first; };
            if (seen.find_or_add(hash, place, same) != place) {
                ++mesh_->report_.duplicate;
                continue;
            }
            mesh_->corners_.push_back(corners);
            mesh_->numbers_.push_back(static_cast<std::uint32_t>(t));
            if (!options.materials.empty()) mesh_->materials_.push_back(options.materials[t]);
        }
    }

    void set(std::vector<Vec3> vertices, std::vector<Corners> corners, std::vector<std::uint32_t> numbers,
             std::vector<std::uint8_t> materials, const MeshReport& report, bool two_sided) {
        mesh_->vertices_ = std::move(vertices);
        mesh_->corners_ = std::move(corners);
        mesh_->numbers_ = std::move(numbers);
        mesh_->materials_ = std::move(materials);
        mesh_->report_ = report;
        mesh_->two_sided_ = two_sided;
    }

    /// Counts open and non-manifold edges: lists the edges at their smaller vertex.
    void count_edges() {
        struct Half {
            std::uint32_t to;
            std::int32_t direction;
        };
        const std::vector<Corners>& corners = mesh_->corners_;
        std::vector<std::uint32_t> begin(mesh_->vertices_.size() + 1, 0);
        const auto for_each_edge = [&](const auto& f) {
            for (const Corners& c : corners)
                for (std::size_t k = 0; k < 3; ++k) f(c[k], c[(k + 1) % 3]);
        };
        for_each_edge([&](std::uint32_t a, std::uint32_t b) { ++begin[std::min(a, b) + 1]; });
        for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
        std::vector<Half> halves(3 * corners.size());
        std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
        for_each_edge([&](std::uint32_t a, std::uint32_t b) {
            halves[next[std::min(a, b)]++] = {std::max(a, b), a < b ? 1 : -1};
        });
        for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
            const std::span<Half> here(halves.data() + begin[v], begin[v + 1] - begin[v]);
            std::ranges::sort(here, {}, &Half::to);
            for (std::size_t i = 0; i < here.size();) {
                std::size_t end = i;
                std::int32_t sum = 0;
                for (; end < here.size() && here[end].to == here[i].to; ++end) sum += here[end].direction;
                mesh_->report_.open_edges += end - i == 1 ? 1 : 0;
                mesh_->report_.non_manifold_edges += end - i > 2 || (end - i == 2 && sum != 0) ? 1 : 0;
                i = end;
            }
        }
    }

    /// Builds the tree and brings the triangles into its order.
    void sort() {
        std::vector<Aabb> boxes(mesh_->corners_.size());
        for (std::size_t t = 0; t < boxes.size(); ++t)
            for (const Vec3 corner : mesh_->triangle(t)) boxes[t] = merge(boxes[t], {corner, corner});
        const std::vector<std::uint32_t> order = mesh_->tree_.build(boxes);
        reorder(mesh_->corners_, order);
        reorder(mesh_->numbers_, order);
        if (!mesh_->materials_.empty()) reorder(mesh_->materials_, order);
    }

    [[nodiscard]] std::shared_ptr<const CollisionMesh> finish() {
        mesh_->content_hash_ = hash();
        return std::move(mesh_);
    }

    [[nodiscard]] bool is_empty() const { return mesh_->corners_.empty(); }

private:
    static Corners from_smallest(Corners c) {
        const std::size_t k = c[0] < c[1] && c[0] < c[2] ? 0 : c[1] < c[2] ? 1 : 2;
        return {c[k], c[(k + 1) % 3], c[(k + 2) % 3]};
    }

    template <class T> static void reorder(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
        std::vector<T> sorted;
        sorted.reserve(values.size());
        for (const std::uint32_t i : order) sorted.push_back(values[i]);
        values = std::move(sorted);
    }

    /// Makes a vertex of each position that a triangle uses, one for equal ones. Returns it by position.
    std::vector<std::uint32_t> weld(std::span<const Vec3> positions, std::span<const std::uint32_t> indices) {
        std::vector<std::uint32_t> vertex_of(positions.size(), no_index);
        std::vector<Vec3>& vertices = mesh_->vertices_;
        vertices.reserve(std::min(positions.size(), indices.size()));
        IndexTable table(std::min(positions.size(), indices.size()));
        for (const std::uint32_t i : indices) {
            if (vertex_of[i] != no_index) continue;
            const Vec3 p = positions[i] + Vec3{};  // -0 becomes 0
            const std::uint64_t hash =
                mix_bits((std::uint64_t{std::bit_cast<std::uint32_t>(p.x)} << 32 | std::bit_cast<std::uint32_t>(p.y)) ^
                         mix_bits(std::bit_cast<std::uint32_t>(p.z)));
            const auto added = static_cast<std::uint32_t>(vertices.size());
            vertex_of[i] = table.find_or_add(hash, added, [&](std::uint32_t other) { return vertices[other] == p; });
            if (vertex_of[i] == added) vertices.push_back(p);
        }
        vertices.shrink_to_fit();
        return vertex_of;
    }

    [[nodiscard]] std::uint64_t hash() const {
        Hasher hasher;
        hasher.add(mesh_->two_sided_);
        hasher.add(mesh_->vertices_.size());
        for (const Vec3 v : mesh_->vertices_)
            for (int axis = 0; axis < 3; ++axis) hasher.add(v[axis]);
        // By number: two trees may order the same triangles differently.
        std::uint64_t sum = 0;
        for (std::size_t t = 0; t < mesh_->corners_.size(); ++t) {
            const Corners& c = mesh_->corners_[t];
            std::uint64_t word = mix_bits(std::uint64_t{mesh_->numbers_[t]} << 8 | mesh_->material(t));
            for (const std::uint32_t corner : c) word = mix_bits(word + corner);
            sum += word;
        }
        hasher.add(sum);
        return hasher.value();
    }

    std::shared_ptr<CollisionMesh> mesh_;
};

std::size_t CollisionMesh::bytes() const {
    return vertices_.capacity() * sizeof(Vec3) + corners_.capacity() * sizeof(Corners) +
           numbers_.capacity() * sizeof(std::uint32_t) + materials_.capacity() + tree_.bytes() + sizeof *this;
}

bool operator==(const CollisionMesh& a, const CollisionMesh& b) {
    return &a == &b ||
           (a.content_hash_ == b.content_hash_ && a.two_sided_ == b.two_sided_ && a.vertices_ == b.vertices_ &&
            a.corners_ == b.corners_ && a.numbers_ == b.numbers_ && a.materials_ == b.materials_);
}

Result<std::shared_ptr<const CollisionMesh>> CollisionMesh::build(std::span<const Vec3> positions,
                                                                  std::span<const std::uint32_t> indices,
                                                                  const MeshOptions& options) {
    if (auto checked = check_input(positions, indices, options); !checked) return checked.error();
    try {
        CollisionMeshBuilder builder;
        builder.add(positions, indices, options);
        if (builder.is_empty())
            return refused("no triangle with an area", "one or more",
                           "check the scale: a side must be above 1e-6 of the others");
        builder.count_edges();
        builder.sort();
        return builder.finish();
    } catch (const std::bad_alloc&) {
        return Error{Status::NoMemory, "mesh", "out of memory", ""};
    } catch (const std::length_error&) {
        return Error{Status::NoMemory, "mesh", "out of memory", ""};
    }
}

Result<std::shared_ptr<const CollisionMesh>> detail::assemble_mesh(std::vector<Vec3> vertices,
                                                                   std::vector<Corners> corners,
                                                                   std::vector<std::uint32_t> numbers,
                                                                   std::vector<std::uint8_t> materials,
                                                                   const MeshReport& report, bool two_sided) {
    const bool sizes = !corners.empty() && corners.size() <= CollisionMesh::max_triangles &&
                       numbers.size() == corners.size() && (materials.empty() || materials.size() == corners.size());
    if (!sizes) return refused("lists of different sizes", "one number for each triangle");
    if (!std::ranges::all_of(vertices, is_valid)) return refused("a position out of range", "coordinates within 1e5 m");
    for (const Corners& c : corners) {
        const bool in_range = std::ranges::all_of(c, [&](std::uint32_t i) { return i < vertices.size(); });
        if (!in_range || !has_area(vertices[c[0]], vertices[c[1]], vertices[c[2]]))
            return refused("a wrong triangle", "three vertices and an area");
    }
    CollisionMeshBuilder builder;
    builder.set(std::move(vertices), std::move(corners), std::move(numbers), std::move(materials), report, two_sided);
    builder.sort();
    return builder.finish();
}

}  // namespace fase
