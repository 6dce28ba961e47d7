/// Quickhull on grid points.
#include "fase/geometry/detail/grid_hull.hpp"

#include <queue>
#include <utility>

#include "fase/core/no_index.hpp"

namespace fase::hull {
namespace {

/// A distance of larger size has the right sign: eight times the error bound of distance().
constexpr double max_distance_error = 0x1p-14;

/// A triangle of the hull under construction and its outside points, a linked list through Builder::next_.
struct WorkFace {
    Triangle triangle;
    std::uint32_t first_outside = no_index;
    std::uint32_t farthest = no_index;
    double farthest_distance = 0;
    std::uint32_t visited = 0;  ///< number of the last search that visited this face
    bool alive = true;
};

/// The farthest point of a face; the queue pops the farthest of all, the older face among equals.
struct Candidate {
    double distance;
    std::uint32_t face;
    friend bool operator<(const Candidate& a, const Candidate& b) {
        return a.distance != b.distance ? a.distance < b.distance : a.face > b.face;
    }
};

/// An edge of the horizon: between a visible and a hidden triangle, in the direction of the visible one.
struct HorizonEdge {
    std::uint32_t from, to;
    std::uint32_t hidden;  ///< the hidden triangle
};

class Builder {
public:
    Builder(std::span<const GridPoint> points, const GridHullOptions& options) : points_(points), options_(options) {}

    GridHull run() {
        GridHull hull;
        std::array<std::uint32_t, 4> start{};
        hull.dimension = find_start(start);
        if (hull.dimension < 3) return hull;
        make_tetrahedron(start);
        while (vertices_ < options_.max_vertices && !queue_.empty()) {
            const Candidate next = queue_.top();
            queue_.pop();
            const WorkFace& face = faces_[next.face];
            if (face.alive && face.farthest != no_index && face.farthest_distance == next.distance) {
                add_farthest_point(next.face);
            }
        }
        hull.triangles = remaining_triangles();
        return hull;
    }

private:
    /// Finds four points of a large tetrahedron: the two ends of the longest axis, the farthest from their line, the
    /// farthest from the plane. Returns the dimension.
    int find_start(std::array<std::uint32_t, 4>& start) const {
        if (points_.empty()) return 0;
        std::array<std::uint32_t, 3> lo{}, hi{};
        for (std::uint32_t i = 0; i < points_.size(); ++i) {
            const GridPoint p = points_[i];
            if (p.x < points_[lo[0]].x) lo[0] = i;
            if (p.x > points_[hi[0]].x) hi[0] = i;
            if (p.y < points_[lo[1]].y) lo[1] = i;
            if (p.y > points_[hi[1]].y) hi[1] = i;
            if (p.z < points_[lo[2]].z) lo[2] = i;
            if (p.z > points_[hi[2]].z) hi[2] = i;
        }
        double longest = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double square = length_squared(difference(hi[axis], lo[axis]));
            if (square <= longest) continue;
            longest = square;
            start[0] = lo[axis];
            start[1] = hi[axis];
        }
        if (!(std::sqrt(longest) >= options_.min_thickness)) return 0;

        const Vec3d along = difference(start[1], start[0]) * (1 / std::sqrt(longest));
        double widest = 0;
        for (std::uint32_t i = 0; i < points_.size(); ++i) {
            const double square = length_squared(cross(along, difference(i, start[0])));
            if (square <= widest) continue;
            widest = square;
            start[2] = i;
        }
        if (!(std::sqrt(widest) >= options_.min_thickness)) return 1;

        const GridPlane plane(points_[start[0]], points_[start[1]], points_[start[2]]);
        double lowest = 0, highest = 0;
        std::uint32_t bottom = start[0], top = start[0];
        for (std::uint32_t i = 0; i < points_.size(); ++i) {
            const double d = plane.distance(points_[i]);
            if (d < lowest) {
                lowest = d;
                bottom = i;
            } else if (d > highest) {
                highest = d;
                top = i;
            }
        }
        if (!(highest - lowest >= options_.min_thickness)) return 2;
        start[3] = highest >= -lowest ? top : bottom;
        if (highest >= -lowest) std::swap(start[1], start[2]);  // now the fourth point is below the first three
        return 3;
    }

    [[nodiscard]] Vec3d difference(std::uint32_t a, std::uint32_t b) const {
        const auto d = points_[a] - points_[b];
        return {double(d.x), double(d.y), double(d.z)};
    }

    std::uint32_t add_face(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        WorkFace face;
        face.triangle.corner = {a, b, c};
        face.triangle.plane = GridPlane(points_[a], points_[b], points_[c]);
        faces_.push_back(face);
        return static_cast<std::uint32_t>(faces_.size() - 1);
    }

    void make_tetrahedron(const std::array<std::uint32_t, 4>& s) {
        add_face(s[0], s[1], s[2]);
        add_face(s[0], s[3], s[1]);
        add_face(s[1], s[3], s[2]);
        add_face(s[2], s[3], s[0]);
        faces_[0].triangle.neighbour = {1, 2, 3};
        faces_[1].triangle.neighbour = {3, 2, 0};
        faces_[2].triangle.neighbour = {1, 3, 0};
        faces_[3].triangle.neighbour = {2, 1, 0};
        vertices_ = 4;
        next_.assign(points_.size(), no_index);
        uses_.assign(points_.size(), 0);
        face_from_.assign(points_.size(), no_index);
        for (const std::uint32_t i : s) uses_[i] = 3;
        for (std::uint32_t i = 0; i < points_.size(); ++i) {
            if (uses_[i] == 0) assign_to_face(i, 0, 4);
        }
        for (std::uint32_t f = 0; f < 4; ++f) enqueue(f);
    }

    /// Adds the farthest point of `seed`: replaces the triangles that it sees by a fan from it to the horizon.
    void add_farthest_point(std::uint32_t seed) {
        const std::uint32_t apex = faces_[seed].farthest;
        find_visible(seed, points_[apex]);
        orphans_.clear();
        for (const std::uint32_t f : visible_) {
            WorkFace& face = faces_[f];
            face.alive = false;
            for (const std::uint32_t corner : face.triangle.corner) {
                if (--uses_[corner] == 0) --vertices_;
            }
            for (std::uint32_t p = face.first_outside; p != no_index; p = next_[p]) {
                if (p != apex) orphans_.push_back(p);
            }
        }
        const auto first_new = static_cast<std::uint32_t>(faces_.size());
        for (const HorizonEdge& edge : horizon_) {
            const std::uint32_t f = add_face(edge.from, edge.to, apex);
            faces_[f].triangle.neighbour[0] = edge.hidden;
            Triangle& hidden = faces_[edge.hidden].triangle;
            for (std::size_t k = 0; k < 3; ++k) {
                if (hidden.corner[k] == edge.to) hidden.neighbour[k] = f;
            }
            face_from_[edge.from] = f;
            if (uses_[edge.from] == 0) ++vertices_;  // all of its triangles were visible, but it is on the horizon
            uses_[edge.from] += 2;
        }
        uses_[apex] = static_cast<std::uint32_t>(horizon_.size());
        ++vertices_;
        for (std::uint32_t f = first_new; f < faces_.size(); ++f) {
            const std::uint32_t following = face_from_[faces_[f].triangle.corner[1]];
            faces_[f].triangle.neighbour[1] = following;
            faces_[following].triangle.neighbour[2] = f;
        }
        const auto end = static_cast<std::uint32_t>(faces_.size());
        for (const std::uint32_t p : orphans_) assign_to_face(p, first_new, end);
        for (std::uint32_t f = first_new; f < end; ++f) enqueue(f);
    }

    [[nodiscard]] static bool is_above(double distance, GridPoint p, const GridPlane& plane) {
        return distance > max_distance_error || (distance >= -max_distance_error && plane.side(p) > 0);
    }
    [[nodiscard]] static bool sees(GridPoint p, const GridPlane& plane) {
        return is_above(plane.distance(p), p, plane);
    }

    /// Fills visible_ with the triangles that are visible from `p`, starting at `seed`, and horizon_ with the edges
    /// around them. The visible triangles are connected and the horizon is one simple loop, because every decision is
    /// exact.
    void find_visible(std::uint32_t seed, GridPoint p) {
        ++search_;
        visible_.assign(1, seed);
        horizon_.clear();
        faces_[seed].visited = search_;
        for (std::size_t i = 0; i < visible_.size(); ++i) {
            const Triangle& triangle = faces_[visible_[i]].triangle;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t across = triangle.neighbour[k];
                if (faces_[across].visited == search_) continue;
                if (sees(p, faces_[across].triangle.plane)) {
                    faces_[across].visited = search_;
                    visible_.push_back(across);
                } else {
                    horizon_.push_back({triangle.corner[k], triangle.corner[(k + 1) % 3], across});
                }
            }
        }
    }

    /// Assigns a point to the face of [begin, end) that it is farthest above; drops a point above none of them: it is
    /// inside. The newest faces are sufficient: a point that sees a triangle on either side of a horizon edge sees the
    /// new triangle there.
    void assign_to_face(std::uint32_t point, std::uint32_t begin, std::uint32_t end) {
        const GridPoint p = points_[point];
        std::uint32_t best = no_index;
        double distance = -1;
        for (std::uint32_t f = begin; f < end; ++f) {
            const double d = faces_[f].triangle.plane.distance(p);
            if (d <= distance || !is_above(d, p, faces_[f].triangle.plane)) continue;
            distance = d;
            best = f;
        }
        if (best == no_index) return;
        WorkFace& face = faces_[best];
        next_[point] = face.first_outside;
        face.first_outside = point;
        if (face.farthest == no_index || distance > face.farthest_distance) {
            face.farthest_distance = distance;
            face.farthest = point;
        }
    }

    void enqueue(std::uint32_t f) {
        if (faces_[f].farthest != no_index) queue_.push({faces_[f].farthest_distance, f});
    }

    /// Returns the remaining faces, renumbered in creation order.
    [[nodiscard]] std::vector<Triangle> remaining_triangles() const {
        std::vector<std::uint32_t> number(faces_.size(), no_index);
        std::uint32_t count = 0;
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            if (faces_[f].alive) number[f] = count++;
        }
        std::vector<Triangle> out;
        out.reserve(count);
        for (const WorkFace& face : faces_) {
            if (!face.alive) continue;
            out.push_back(face.triangle);
            for (std::uint32_t& n : out.back().neighbour) n = number[n];
        }
        return out;
    }

    std::span<const GridPoint> points_;
    GridHullOptions options_;
    std::vector<WorkFace> faces_;
    std::priority_queue<Candidate> queue_;
    std::vector<std::uint32_t> next_;       ///< per point: the next point outside the same face
    std::vector<std::uint32_t> uses_;       ///< per point: number of current triangles with this corner
    std::vector<std::uint32_t> face_from_;  ///< per point: the newest fan triangle whose horizon edge starts there
    std::vector<std::uint32_t> visible_, orphans_;
    std::vector<HorizonEdge> horizon_;
    std::uint32_t vertices_ = 0;
    std::uint32_t search_ = 0;
};

}  // namespace

GridPlane::GridPlane(GridPoint a, GridPoint b, GridPoint c) : cross_(cross(b - a, c - a)), origin_(a) {
    const Vec3d n{double(cross_.x), double(cross_.y), double(cross_.z)};
    twice_area_ = length(n);
    normal_ = n * (1 / twice_area_);
}

int GridPlane::side(GridPoint p) const {
    const auto d = p - origin_;
    __extension__ using Wide = __int128;
    const Wide along = Wide{cross_.x} * d.x + Wide{cross_.y} * d.y + Wide{cross_.z} * d.z;
    return along > 0 ? 1 : along < 0 ? -1 : 0;
}

GridHull quickhull(std::span<const GridPoint> points, const GridHullOptions& options) {
    return Builder(points, options).run();
}

}  // namespace fase::hull
