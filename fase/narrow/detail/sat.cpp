/// Exact penetration of two polyhedra, by the separating-axis test.
#include "fase/narrow/detail/sat.hpp"

#include <array>
#include <limits>

#include "fase/narrow/detail/infinity.hpp"

namespace fase::narrow {
namespace {

/// An edge with its vector for the Gauss map test.
struct MappedEdge {
    CoreEdge edge;
    Vec3d across;  ///< cross(right, left)
};

class EdgePairs {
public:
    EdgePairs(const CoreView& a, const CoreView& b, const TransformD& b_in_a, double bias, Penetration& best)
        : a_(a), b_(b), b_in_a_(b_in_a), bias_(bias), best_(best) {}

    /// Tests all pairs. Reads the edges of b in blocks, so that it allocates nothing and computes each edge of b once.
    void run() {
        constexpr int block = 48;
        Buffer<MappedEdge, block> edges_b;
        const int count_a = a_.table->edge_count(a_.shape), count_b = b_.table->edge_count(b_.shape);
        for (int begin = 0; begin < count_b; begin += block) {
            const int size = count_b - begin < block ? count_b - begin : block;
            for (int i = 0; i < size; ++i) {
                const CoreEdge edge = b_.table->edge(b_.shape, begin + i);
                edges_b[static_cast<std::size_t>(i)] = {edge, cross(edge.right, edge.left)};
            }
            for (int i = 0; i < count_a; ++i) against(in_b(a_.table->edge(a_.shape, i)), edges_b, size);
        }
    }

private:
    [[nodiscard]] CoreEdge in_b(const CoreEdge& edge) const {
        const Mat3d& r = b_in_a_.rotation;
        return {transform_back(b_in_a_, edge.from), transpose_times(r, edge.along), transpose_times(r, edge.left),
                transpose_times(r, edge.right)};
    }

    template <std::size_t N> void against(const CoreEdge& edge, const Buffer<MappedEdge, N>& edges_b, int size) {
        const bool wire = a_.table->wire || b_.table->wire;
        const Vec3d across = cross(edge.right, edge.left);
        for (int i = 0; i < size; ++i) {
            const MappedEdge& other = edges_b[static_cast<std::size_t>(i)];
            if (a_.table->wire != b_.table->wire) {
                // The normals of a wire are a great circle: tests whether the arc of the other edge crosses it.
                const Vec3d& along = a_.table->wire ? edge.along : other.edge.along;
                const CoreEdge& bounded = a_.table->wire ? other.edge : edge;
                if (!(dot(bounded.left, along) * dot(bounded.right, along) < 0)) continue;
            } else if (!wire && !arcs_cross(edge, across, other)) {
                continue;
            }
            const Vec3d axis = cross(edge.along, other.edge.along);
            const double squared = length_squared(axis);
            const double bound = length_squared(edge.along) * length_squared(other.edge.along);
            if (!(squared > 1e-20 * bound)) continue;
            Vec3d normal = axis * (1 / std::sqrt(squared));
            if (a_.table->wire && b_.table->wire) {
                consider(normal);
                consider(-normal);
                continue;
            }
            if (wire) {
                // The outward direction of the edge that has faces.
                const Vec3d outward = a_.table->wire ? -(other.edge.left + other.edge.right) : edge.left + edge.right;
                consider(dot(normal, outward) < 0 ? -normal : normal);
                continue;
            }
            if (dot(normal, edge.left + edge.right) < 0) normal = -normal;
            if (dot(normal, edge.from - other.edge.from) + bias_ < best_.depth) consider(normal);
        }
    }

    /// Whether the arcs of edge a and of the mirrored edge b cross on the unit sphere.
    [[nodiscard]] static bool arcs_cross(const CoreEdge& a, Vec3d across_a, const MappedEdge& b) {
        const double left_b = -dot(b.edge.left, across_a), right_b = -dot(b.edge.right, across_a);
        if (!(left_b * right_b < 0)) return false;
        const double left_a = dot(a.left, b.across), right_a = dot(a.right, b.across);
        return left_a * right_a < 0 && left_b * right_a > 0;
    }

    void consider(Vec3d normal_in_b) {
        const Vec3d normal = b_in_a_.rotation * normal_in_b;
        const double depth = depth_along(a_, b_, b_in_a_, normal);
        if (!(depth + bias_ < best_.depth)) return;
        best_.normal = normal;
        best_.depth = depth;
        best_.source = Penetration::Source::Edges;
    }

    const CoreView& a_;
    const CoreView& b_;
    const TransformD& b_in_a_;
    double bias_;
    Penetration& best_;
};

/// Returns a normal for cores without volume and crossing edges: perpendicular to an edge, if there is one.
Vec3d any_normal(const CoreView& a, const CoreView& b, const TransformD& b_in_a) {
    Vec3d along;
    if (a.table->edge_count(a.shape) > 0) {
        along = a.table->edge(a.shape, 0).along;
    } else if (b.table->edge_count(b.shape) > 0) {
        along = b_in_a.rotation * b.table->edge(b.shape, 0).along;
    }
    along = normalized(along);
    return length_squared(along) > 0 ? any_perpendicular(along) : Vec3d{0, 1, 0};
}

/// Returns the minimum penetration along a face normal of either core; depth is infinite when neither has a face.
Penetration best_face(const CoreView& a, const CoreView& b, const TransformD& b_in_a) {
    Penetration best;
    best.depth = infinity;
    const int count_a = a.table->face_count(a.shape), count_b = b.table->face_count(b.shape);
    for (int i = 0; i < count_a; ++i) {
        const CoreFace face = a.table->face(a.shape, i);
        const Vec3d nearest = transform(b_in_a, b.support(transpose_times(b_in_a.rotation, -face.normal)));
        const double depth = face.offset - dot(face.normal, nearest);
        if (depth < best.depth) best = {face.normal, depth, Penetration::Source::FaceOfA};
    }
    for (int i = 0; i < count_b; ++i) {
        const CoreFace face = b.table->face(b.shape, i);
        const Vec3d normal = b_in_a.rotation * face.normal;
        const Vec3d nearest = transform_back(b_in_a, a.support(-normal));
        const double depth = face.offset - dot(face.normal, nearest);
        if (depth < best.depth) best = {-normal, depth, Penetration::Source::FaceOfB};
    }
    return best;
}

}  // namespace

Penetration sat(const CoreView& a, const CoreView& b, const TransformD& b_in_a, double edge_bias) {
    Penetration best = best_face(a, b, b_in_a);
    EdgePairs(a, b, b_in_a, edge_bias, best).run();
    if (!(best.depth < infinity)) {
        best.normal = any_normal(a, b, b_in_a);
        best.depth = depth_along(a, b, b_in_a, best.normal);
        best.source = Penetration::Source::Edges;
    }
    return best;
}

}  // namespace fase::narrow
