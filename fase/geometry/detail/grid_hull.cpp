/// Quickhull on grid points.
#include "fase/geometry/detail/grid_hull.hpp"

#include <queue>
#include <utility>

namespace fase::hull {
namespace {

constexpr std::uint32_t none = 0xffffffff;
/// Distances beyond this have the right sign: eight times the error that distance() may have.
constexpr double sure = 0x1p-14;

/// A triangle of the growing hull with the points outside it, a list through Builder::next_.
struct WorkFace {
    Triangle triangle;
    std::uint32_t first_outside = none;
    std::uint32_t farthest = none;
    double farthest_distance = 0;
    std::uint32_t visited = 0;  ///< the last search that came by
    bool alive = true;
};

/// The farthest point of a face; the queue gives the farthest of all, the older face among equals.
struct Candidate {
    double distance;
    std::uint32_t face;
    friend bool operator<(const Candidate& a, const Candidate& b) {
        return a.distance != b.distance ? a.distance < b.distance : a.face > b.face;
    }
};

/// An edge of the border between what a point sees and what it does not: from, to as the seen triangle has them.
struct BorderEdge {
    std::uint32_t from, to;
    std::uint32_t beyond;  ///< the unseen triangle
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
            if (face.alive && face.farthest != none && face.farthest_distance == next.distance) grow(next.face);
        }
        hull.triangles = living_triangles();
        return hull;
    }

private:
    /// Four points that span much: the two ends of the longest axis, the farthest from their line, the farthest from
    /// the plane. Returns the dimension.
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
        if (!(std::sqrt(longest) >= options_.thinnest)) return 0;

        const Vec3d along = difference(start[1], start[0]) * (1 / std::sqrt(longest));
        double widest = 0;
        for (std::uint32_t i = 0; i < points_.size(); ++i) {
            const double square = length_squared(cross(along, difference(i, start[0])));
            if (square <= widest) continue;
            widest = square;
            start[2] = i;
        }
        if (!(std::sqrt(widest) >= options_.thinnest)) return 1;

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
        if (!(highest - lowest >= options_.thinnest)) return 2;
        start[3] = highest >= -lowest ? top : bottom;
        if (highest >= -lowest) std::swap(start[1], start[2]);  // the fourth point lies below the first three
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
        next_.assign(points_.size(), none);
        uses_.assign(points_.size(), 0);
        face_from_.assign(points_.size(), none);
        for (const std::uint32_t i : s) uses_[i] = 3;
        for (std::uint32_t i = 0; i < points_.size(); ++i) {
            if (uses_[i] == 0) place(i, 0, 4);
        }
        for (std::uint32_t f = 0; f < 4; ++f) enqueue(f);
    }

    /// Adds the farthest point of `seed`: what it sees goes, a fan from it to the border comes.
    void grow(std::uint32_t seed) {
        const std::uint32_t apex = faces_[seed].farthest;
        find_seen(seed, points_[apex]);
        orphans_.clear();
        for (const std::uint32_t f : seen_) {
            WorkFace& face = faces_[f];
            face.alive = false;
            for (const std::uint32_t corner : face.triangle.corner) {
                if (--uses_[corner] == 0) --vertices_;
            }
            for (std::uint32_t p = face.first_outside; p != none; p = next_[p]) {
                if (p != apex) orphans_.push_back(p);
            }
        }
        const auto first_new = static_cast<std::uint32_t>(faces_.size());
        for (const BorderEdge& edge : border_) {
            const std::uint32_t f = add_face(edge.from, edge.to, apex);
            faces_[f].triangle.neighbour[0] = edge.beyond;
            Triangle& beyond = faces_[edge.beyond].triangle;
            for (std::size_t k = 0; k < 3; ++k) {
                if (beyond.corner[k] == edge.to) beyond.neighbour[k] = f;
            }
            face_from_[edge.from] = f;
            if (uses_[edge.from] == 0) ++vertices_;  // all of its triangles were seen but it stands on the border
            uses_[edge.from] += 2;
        }
        uses_[apex] = static_cast<std::uint32_t>(border_.size());
        ++vertices_;
        for (std::uint32_t f = first_new; f < faces_.size(); ++f) {
            const std::uint32_t following = face_from_[faces_[f].triangle.corner[1]];
            faces_[f].triangle.neighbour[1] = following;
            faces_[following].triangle.neighbour[2] = f;
        }
        const auto end = static_cast<std::uint32_t>(faces_.size());
        for (const std::uint32_t p : orphans_) place(p, first_new, end);
        for (std::uint32_t f = first_new; f < end; ++f) enqueue(f);
    }

    [[nodiscard]] static bool is_above(double distance, GridPoint p, const GridPlane& plane) {
        return distance > sure || (distance >= -sure && plane.side(p) > 0);
    }
    [[nodiscard]] static bool sees(GridPoint p, const GridPlane& plane) {
        return is_above(plane.distance(p), p, plane);
    }

    /// Fills seen_ with the triangles that `p` sees, from `seed` on, and border_ with the edges around them. The seen
    /// triangles are connected and their border is one simple loop, because every decision is exact.
    void find_seen(std::uint32_t seed, GridPoint p) {
        ++search_;
        seen_.assign(1, seed);
        border_.clear();
        faces_[seed].visited = search_;
        for (std::size_t i = 0; i < seen_.size(); ++i) {
            const Triangle& triangle = faces_[seen_[i]].triangle;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t across = triangle.neighbour[k];
                if (faces_[across].visited == search_) continue;
                if (sees(p, faces_[across].triangle.plane)) {
                    faces_[across].visited = search_;
                    seen_.push_back(across);
                } else {
                    border_.push_back({triangle.corner[k], triangle.corner[(k + 1) % 3], across});
                }
            }
        }
    }

    /// Gives a point to the face of [begin, end) that it is farthest above; a point above none is inside and dropped.
    /// That the faces made last are enough: a point that sees a triangle on either side of a border edge sees the new
    /// one there.
    void place(std::uint32_t point, std::uint32_t begin, std::uint32_t end) {
        const GridPoint p = points_[point];
        std::uint32_t best = none;
        double distance = -1;
        for (std::uint32_t f = begin; f < end; ++f) {
            const double d = faces_[f].triangle.plane.distance(p);
            if (d <= distance || !is_above(d, p, faces_[f].triangle.plane)) continue;
            distance = d;
            best = f;
        }
        if (best == none) return;
        WorkFace& face = faces_[best];
        next_[point] = face.first_outside;
        face.first_outside = point;
        if (face.farthest == none || distance > face.farthest_distance) {
            face.farthest_distance = distance;
            face.farthest = point;
        }
    }

    void enqueue(std::uint32_t f) {
        if (faces_[f].farthest != none) queue_.push({faces_[f].farthest_distance, f});
    }

    /// The faces that are left, renumbered in the order they were made.
    [[nodiscard]] std::vector<Triangle> living_triangles() const {
        std::vector<std::uint32_t> number(faces_.size(), none);
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
    std::vector<std::uint32_t> next_;       ///< per point: the next outside the same face
    std::vector<std::uint32_t> uses_;       ///< per point: living triangles that have it as corner
    std::vector<std::uint32_t> face_from_;  ///< per point: the newest fan triangle whose border edge starts there
    std::vector<std::uint32_t> seen_, orphans_;
    std::vector<BorderEdge> border_;
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
