/// Loops over all triangles of a mesh.
#include "fase/level/triangles.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <vector>

namespace fase::level {

std::optional<PolygonHit> cast_ray_brute_force(const TriangleMesh& mesh, const Ray& ray) {
    std::optional<PolygonHit> nearest;
    for (std::uint32_t t = 0; t < mesh.indices.size() / 3; ++t) {
        const auto hit = ray_triangle(ray.origin, to_double(ray.direction), corners_of(mesh, t));
        if (hit && hit->distance <= double(ray.length) && (!nearest || hit->distance < nearest->distance))
            nearest = {t, hit->distance};
    }
    return nearest;
}

namespace {

/// Sums angles as a product of complex numbers, and counts full turns.
class AngleSum {
public:
    /// Adds the angle of (x, y), of any length.
    void add(double x, double y) {
        const double size = std::sqrt(x * x + y * y);
        if (!(size > 0)) return;
        const double re = (re_ * x - im_ * y) / size, im = (re_ * y + im_ * x) / size;
        if (im_ >= 0 && y >= 0 && im < 0) ++turns_;
        if (im_ < 0 && y < 0 && im >= 0) --turns_;
        const double factor = 1.5 - 0.5 * (re * re + im * im);  // renormalizes to length 1
        re_ = re * factor;
        im_ = im * factor;
    }
    /// Returns the sum, rounded to full turns.
    [[nodiscard]] int turns() const { return turns_; }

private:
    double re_ = 1, im_ = 0;
    int turns_ = 0;
};

}  // namespace

int winding_number(const TriangleMesh& mesh, Vec3d point) {
    AngleSum sum;  // of half solid angles
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        const TriangleCorners corners = corners_of(mesh, t);
        const Vec3d a = corners[0] - point, b = corners[1] - point, c = corners[2] - point;
        const double la = length(a), lb = length(b), lc = length(c);
        sum.add(la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb, dot(a, cross(b, c)));
    }
    return sum.turns();
}

int boundary_winding(std::span<const BoundaryEdge> boundary, Vec3d point, Vec3d direction) {
    AngleSum sum;
    for (const BoundaryEdge& edge : boundary) {
        const Vec3d a = edge.from - point, b = edge.to - point;
        const double la = length(a), lb = length(b);
        // The third corner is at infinity, in the given direction.
        const double x = la * lb + dot(a, b) + dot(b, direction) * la + dot(direction, a) * lb;
        const double y = dot(a, cross(b, direction));
        for (int i = 0; i < edge.count; ++i) sum.add(x, y);
    }
    return sum.turns();
}

std::vector<BoundaryEdge> boundary_of(const TriangleMesh& mesh) {
    // Merges corners with equal coordinates: the first one represents all.
    std::vector<std::uint32_t> order(mesh.positions.size()), merged(mesh.positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t i) {
        const Vec3 p = mesh.positions[i] + Vec3{};  // -0 is 0
        return std::tuple(p.x, p.y, p.z);
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    for (std::size_t i = 0; i < order.size(); ++i)
        merged[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? merged[order[i - 1]] : order[i];

    struct Edge {
        std::uint32_t low, high;
        int direction;
    };
    std::vector<Edge> edges;
    edges.reserve(mesh.indices.size());
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = merged[mesh.indices[3 * t + k]], to = merged[mesh.indices[3 * t + (k + 1) % 3]];
            if (from != to) edges.push_back({std::min(from, to), std::max(from, to), from < to ? 1 : -1});
        }
    }
    std::sort(edges.begin(), edges.end(),
              [](const Edge& a, const Edge& b) { return std::tie(a.low, a.high) < std::tie(b.low, b.high); });
    std::vector<BoundaryEdge> boundary;
    for (std::size_t i = 0; i < edges.size();) {
        int sum = 0;
        std::size_t end = i;
        for (; end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high; ++end)
            sum += edges[end].direction;
        const Vec3d low = to_double(mesh.positions[edges[i].low]), high = to_double(mesh.positions[edges[i].high]);
        if (sum > 0) boundary.push_back({low, high, sum});
        if (sum < 0) boundary.push_back({high, low, -sum});
        i = end;
    }
    return boundary;
}

}  // namespace fase::level
