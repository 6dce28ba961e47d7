/// Contacts of a convex shape with a triangle mesh: triangle by triangle, without ghosts at inner edges, then merged.
#include "fase/narrow/collide_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "fase/geometry/bounds.hpp"
#include "fase/narrow/detail/clip.hpp"
#include "fase/narrow/detail/core_distance.hpp"
#include "fase/narrow/detail/general.hpp"
#include "fase/narrow/detail/gjk.hpp"
#include "fase/narrow/detail/polygon.hpp"
#include "fase/narrow/detail/triangle_core.hpp"

namespace fase::narrow {
namespace {

/// A normal this near to that of the triangle is that of the triangle (cosine of 0.8 degrees).
constexpr double same_normal = 0.9999;

/// A triangle near the shape, relative to the shape's position.
struct NearTriangle {
    TriangleCore triangle;
    Vec3d nearest;             ///< its point nearest to the middle of the shape
    std::uint32_t number = 0;  ///< results do not depend on the order of the tree
    std::uint32_t place = 0;
};

/// A point of contact with a triangle.
struct FoundPoint {
    Vec3 position;
    float separation = 0;
    std::uint32_t feature = 0;
};

/// The contact with one triangle: its points lie in a list of points.
struct FoundContact {
    Vec3 normal;
    float nearest = 0;  ///< the smallest separation
    std::uint32_t number = 0, place = 0;
    std::uint32_t first = 0, count = 0;
    std::uint32_t group = 0;
};

std::uint32_t feature_of(std::uint32_t number, std::uint32_t feature) { return feature ^ (number * 0x9e3779b1u); }

CoreView view_of(const Shape& shape) {
    return std::visit(
        [](const auto& s) -> CoreView {
            if constexpr (ConvexShape<std::remove_cvref_t<decltype(s)>>) {
                return core_view(s);
            } else {
                return {};
            }
        },
        shape);
}

}  // namespace

Vec3d middle_of(const Shape& shape) {
    const auto* hull = std::get_if<ConvexHull>(&shape);
    if (hull == nullptr) return {};
    Vec3d sum;
    for (const Vec3 v : hull->vertices) sum += to_double(v);
    return sum * (1 / double(hull->vertices.size()));
}

struct MeshContacts::Memory {
    std::vector<NearTriangle> near;
    std::vector<FoundContact> contacts;
    std::vector<FoundPoint> points;
};

MeshContacts::MeshContacts() : memory_(std::make_unique<Memory>()) {}
MeshContacts::MeshContacts(MeshContacts&&) noexcept = default;
MeshContacts& MeshContacts::operator=(MeshContacts&&) noexcept = default;
MeshContacts::~MeshContacts() = default;

class MeshContacts::Search {
public:
    Search(MeshContacts& out, const Mesh& mesh, const Shape& shape, const TransformD& pose, float margin, float reach)
        : out_(out),
          memory_(*out.memory_),
          mesh_(mesh),
          view_(view_of(shape)),
          at_{pose.rotation, {}},
          origin_(pose.position),
          middle_(pose.rotation * middle_of(shape)),
          margin_(margin),
          reach_(reach),
          is_ball_(std::holds_alternative<Sphere>(shape)) {
        const Quat rotation = to_float(to_quat(pose.rotation));
        box_ = enlarged(bounds(shape, {{}, rotation}), margin * 1.001f);
        const float size = std::min(inner_radius(shape), 0.1f);
        around_ = 1.001 * (double(outer_radius(shape)) + length(middle_) + margin);
        touch_ = std::max(0.01f * size, 1e-5f);
        shallow_ = 2 * touch_;
    }

    void run() {
        gather();
        memory_.contacts.clear();
        memory_.points.clear();
        for (const NearTriangle& near : memory_.near) collide(near);
        merge();
    }

private:
    /// Lists the triangles that the box of the shape touches, in the order of their numbers.
    void gather() {
        memory_.near.clear();
        const Aabb in_mesh = rounded_outward(to_double(box_.lo) + origin_, to_double(box_.hi) + origin_);
        mesh_.data->tree().visit(detail::unscaled(mesh_, in_mesh), [&](std::uint32_t place) {
            const TriangleCore triangle(mesh_, place, origin_);
            if (!(length_squared(triangle.normal) > 0)) return;  // scaling took its area
            Vec3d lo = triangle.corners[0], hi = lo;
            for (const Vec3d corner : triangle.corners) {
                lo = min(lo, corner);
                hi = max(hi, corner);
            }
            if (!overlaps(rounded_outward(lo, hi), box_)) return;
            const Vec3d nearest = nearest_point(triangle, middle_);
            if (length_squared(nearest - middle_) > around_ * around_) return;
            memory_.near.push_back({triangle, nearest, mesh_.data->number(place), place});
        });
        std::ranges::sort(memory_.near, {}, &NearTriangle::number);
        for (NearTriangle& near : memory_.near) {
            if (!mesh_.data->two_sided() || near.triangle.height(middle_) >= 0) continue;
            std::swap(near.triangle.corners[1], near.triangle.corners[2]);
            near.triangle.normal = -near.triangle.normal;
        }
    }

    void collide(const NearTriangle& near) {
        const TriangleCore& triangle = near.triangle;
        if (!(triangle.height(middle_) >= 0)) return;  // behind it
        const double lowest = triangle.height(lowest_along(triangle.normal)) - view_.radius;
        if (!(lowest <= margin_)) return;
        Manifold face = over_face(triangle);
        // The shape's lowest point is over the triangle: nothing is nearer, and little depth has no other way out.
        const bool over = face.count > 0 && double(face.points[deepest(face)].separation) <= lowest + 1e-5;
        if (over && lowest >= -shallow_) {
            add(near, face);
            return;
        }
        if (is_far(near.nearest)) return;
        Distance nearest = distance_to(near);
        if (!(nearest.distance <= margin_)) return;
        if (nearest.distance == overlaps_here) {
            // A part of the shape is a little below the triangle's face: that is the contact, whatever else is nearer.
            if (face.count > 0 && double(face.points[deepest(face)].separation) >= -4 * shallow_) {
                add(near, face);
                return;
            }
            nearest = distance_of_cores(core_view(triangle), view_, at_);
        }
        // What is apart from the triangle and below it passes under it, around an edge.
        if (nearest.distance > 0) remove_below(face, -shallow_);
        if (dot(nearest.normal, triangle.normal) >= same_normal && face.count > 0) {
            add(near, face);
            return;
        }
        switch (contact_at_edge(near, nearest.normal, nearest.on_a)) {
            case Edge::Free: add(near, collide_cores(core_view(triangle), view_, as_local(), margin_)); break;
            case Edge::Flat:
                if (face.count > 0) add(near, face);
                break;
            case Edge::Hollow:
                if (face.count > 0) {
                    add(near, face);
                } else {
                    add_ahead(near, lowest);
                }
                break;
            case Edge::Ridge: break;  // the other triangle at the edge has the contact
        }
    }

    /// Whether the plane at a triangle's point nearest to the middle proves that the shape is beyond the margin.
    [[nodiscard]] bool is_far(Vec3d nearest) const {
        const Vec3d to = middle_ - nearest;
        const double size = length(to);
        if (!(size > 0)) return false;
        const Vec3d normal = to * (1 / size);
        return dot(normal, lowest_along(normal) - nearest) - view_.radius > margin_;
    }

    /// As a distance: the shapes overlap or nearly touch.
    static constexpr double overlaps_here = -Aabb::infinity;

    /// The distance of the shape from a triangle; beyond the margin only that it is, and when they overlap, too.
    [[nodiscard]] Distance distance_to(const NearTriangle& near) const {
        if (is_ball_) {
            const Vec3d to = middle_ - near.nearest;
            const double size = length(to);
            if (!(size > 1e-4 * view_.radius)) return {overlaps_here, {}, {}, {}};
            return {size - view_.radius, near.nearest, middle_, to * (1 / size)};
        }
        const CoreView core = core_view(near.triangle);
        GjkOptions options;
        options.farther_than = margin_ + view_.radius;
        options.tolerance = 1e-12;
        const GjkResult apart = gjk(core, view_, at_, options);
        if (apart.state == GjkResult::State::Farther) return {Aabb::infinity, {}, {}, {}};
        if (apart.state == GjkResult::State::Overlap) return {overlaps_here, {}, {}, {}};
        if (!(apart.distance > 1e-4 * apart.scale)) return distance_of_cores(core, view_, at_);
        return {apart.distance - view_.radius, apart.on_a, apart.on_b, apart.normal};
    }

    /// The lowest point of the shape's core along a normal.
    [[nodiscard]] Vec3d lowest_along(Vec3d normal) const {
        return at_.rotation * view_.support(transpose_times(at_.rotation, -normal));
    }
    [[nodiscard]] LocalPose as_local() const { return {{}, to_float(to_quat(at_.rotation))}; }

    enum class Edge { Free, Flat, Hollow, Ridge };

    /// Tells whether other triangles bar the normal of a contact at an edge or a corner. At a corner those bar it that
    /// touch the point and rise above the plane of the contact. An edge has contacts only where the surface bends down.
    [[nodiscard]] Edge contact_at_edge(const NearTriangle& near, Vec3d normal, Vec3d point) const {
        const bool beside_face = dot(normal, near.triangle.normal) >= same_normal;
        const bool at_corner = !beside_face && std::ranges::any_of(near.triangle.corners, [&](Vec3d corner) {
            return length_squared(corner - point) <= touch_ * touch_;
        });
        constexpr double min_slope = 2e-3;
        Edge edge = Edge::Free;
        for (const NearTriangle& other : memory_.near) {
            if (other.place == near.place) continue;
            const TriangleCore& t = other.triangle;
            if (!(std::abs(t.height(point)) <= touch_)) continue;
            if (!(length_squared(nearest_point(t, point) - point) <= touch_ * touch_)) continue;
            if (dot(t.normal, near.triangle.normal) < -0.999) continue;  // the other side of a wall
            double slope = -1, bend = 0;  // sines of the steepest ways from the point over the triangle
            for (const Vec3d corner : t.corners) {
                const Vec3d to = corner - point;
                const double far = length(to);
                if (!(far > touch_)) continue;
                slope = std::max(slope, dot(normal, to) / far);
                const double height = near.triangle.height(corner) / far;
                bend = std::abs(height) > std::abs(bend) ? height : bend;
            }
            const bool bends_down = bend < -min_slope;
            if (slope <= min_slope && (at_corner || bends_down)) continue;
            if (bend > min_slope) return Edge::Hollow;
            edge = bends_down && edge != Edge::Flat ? Edge::Ridge : Edge::Flat;
        }
        return edge;
    }

    static void remove_below(Manifold& manifold, double separation) {
        int kept = 0;
        for (int i = 0; i < manifold.count; ++i) {
            const ManifoldPoint p = manifold.points[static_cast<std::size_t>(i)];
            if (double(p.separation) >= separation) manifold.points[static_cast<std::size_t>(kept++)] = p;
        }
        manifold.count = kept;
    }

    [[nodiscard]] static std::size_t deepest(const Manifold& manifold) {
        std::size_t best = 0;
        for (int i = 1; i < manifold.count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            if (manifold.points[k].separation < manifold.points[best].separation) best = k;
        }
        return best;
    }
    void add(const NearTriangle& near, const Manifold& manifold) {
        if (manifold.count == 0) return;
        FoundContact contact{manifold.normal, manifold.points[deepest(manifold)].separation, near.number, near.place};
        contact.first = static_cast<std::uint32_t>(memory_.points.size());
        contact.count = static_cast<std::uint32_t>(manifold.count);
        for (int i = 0; i < manifold.count; ++i) {
            const ManifoldPoint& p = manifold.points[static_cast<std::size_t>(i)];
            memory_.points.push_back({p.position, p.separation, feature_of(near.number, p.feature)});
        }
        memory_.contacts.push_back(contact);
    }

    /// The part of the shape's lowest feature that lies over a triangle.
    [[nodiscard]] Manifold over_face(const TriangleCore& triangle) const {
        Feature feature;
        view_.table->feature(view_.shape, transpose_times(at_.rotation, -triangle.normal), feature);
        for (std::size_t i = 0; i < static_cast<std::size_t>(feature.count); ++i)
            feature.corners[i].position = at_.rotation * feature.corners[i].position;
        feature.normal = at_.rotation * feature.normal;
        Feature face;
        CoreFeatures<TriangleCore>::feature(triangle, triangle.normal, face);
        const ClipFrame frame(face);
        Candidates candidates;
        const auto put = [&](const ClipPoint& p) { candidates.put(frame, p, view_.radius, margin_, triangle.normal); };
        if (feature.count == 1) {
            const ClipPoint p = frame.flatten(feature.corners[0]);
            if (frame.contains(p)) put(p);
        } else {
            const ClipPolygon polygon = frame.clip(feature);
            for (std::size_t i = 0; i < static_cast<std::size_t>(polygon.count); ++i) put(polygon.points[i]);
            // The lowest point of a tilted rim is between its samples; that of a hull may be outside its lowest face.
            const ClipPoint p = frame.flatten({lowest_along(triangle.normal), 0x3fff});
            if (p.height - view_.radius < candidates.lowest() - 1e-5 && frame.contains(p)) put(p);
        }
        return candidates.reduced(to_float(triangle.normal));
    }

    /// Adds the plane of a triangle that rises ahead of the shape, at the shape's lowest point.
    void add_ahead(const NearTriangle& near, double lowest) {
        if (!(reach_ > 0 && lowest > -shallow_)) return;
        const Vec3d normal = near.triangle.normal;
        Manifold manifold;
        manifold.normal = to_float(normal);
        manifold.count = 1;
        const Vec3d point = lowest_along(normal) - normal * (view_.radius + 0.5 * lowest);
        manifold.points[0] = {to_float(point), static_cast<float>(lowest), 0x7fffffffu};
        add(near, manifold);
    }

    /// Points over a face, reduced to four.
    struct Candidates {
        PlanarPoints points;
        std::array<Vec3, PlanarPoints::capacity> position;

        void put(const ClipFrame& frame, const ClipPoint& p, double radius, double margin, Vec3d normal) {
            const double separation = p.height - radius;
            if (!(separation <= margin) || points.count == PlanarPoints::capacity) return;
            position[static_cast<std::size_t>(points.count)] =
                to_float(frame.lift(p) - normal * (radius + 0.5 * separation));
            points.put(static_cast<float>(p.u), static_cast<float>(p.v), static_cast<float>(separation), p.name);
        }
        [[nodiscard]] double lowest() const {
            float lowest = Aabb::infinity;
            for (int i = 0; i < points.count; ++i) lowest = std::min(lowest, points.w[i]);
            return lowest;
        }
        [[nodiscard]] Manifold reduced(Vec3 normal) const {
            Manifold manifold;
            manifold.normal = normal;
            std::array<int, 4> chosen{0, 1, 2, 3};
            const int kept = points.count <= 4 ? points.count
                                               : choose_four(
                                                     points.count, [&](int i) { return points.u[i]; },
                                                     [&](int i) { return points.v[i]; },
                                                     [&](int i) { return points.w[i]; }, 1e-5f, chosen);
            manifold.count = kept;
            for (std::size_t i = 0; i < static_cast<std::size_t>(kept); ++i) {
                const auto k = static_cast<std::size_t>(chosen[i]);
                manifold.points[i] = {position[k], points.w[k], points.feature[k]};
            }
            return manifold;
        }
    };

    /// Unites contacts of similar normals, then reduces each group to four points.
    void merge() {
        std::vector<FoundContact>& contacts = memory_.contacts;
        std::uint32_t groups = 0;
        for (const float cosine : {0.99995f, 0.999f, 0.99f, 0.95f, 0.8f, -1.0f}) {
            groups = group(contacts, cosine);
            if (groups <= max_manifolds) break;
        }
        out_.found_.resize(groups);
        for (std::uint32_t g = 0; g < groups; ++g) out_.found_[g] = united(g);
        std::erase_if(out_.found_, [](const MeshManifold& m) { return m.manifold.count == 0; });
        std::ranges::sort(out_.found_, {}, [&](const MeshManifold& m) { return mesh_.data->number(m.triangle); });
    }

    /// Gives each contact the group of the deepest contact with about the same normal; returns the number of groups.
    static std::uint32_t group(std::vector<FoundContact>& contacts, float cosine) {
        constexpr std::uint32_t none = 0xffffffffu;
        std::uint32_t groups = 0;
        for (FoundContact& c : contacts) c.group = none;
        for (;;) {
            FoundContact* leader = nullptr;
            for (FoundContact& c : contacts)
                if (c.group == none && (leader == nullptr || c.nearest < leader->nearest)) leader = &c;
            if (leader == nullptr) return groups;
            const Vec3 normal = leader->normal;
            leader->group = groups;
            for (FoundContact& c : contacts)
                if (c.group == none && dot(c.normal, normal) >= cosine) c.group = groups;
            ++groups;
        }
    }

    [[nodiscard]] MeshManifold united(std::uint32_t group) const {
        MeshManifold result;
        const FoundContact* leader = nullptr;
        std::uint32_t smallest = 0xffffffffu;
        for (const FoundContact& c : memory_.contacts) {
            if (c.group != group) continue;
            if (leader == nullptr || c.nearest < leader->nearest) leader = &c;
            if (c.number >= smallest) continue;
            smallest = c.number;
            result.triangle = c.place;
        }
        const Vec3 normal = leader->normal, u = any_perpendicular(normal), v = cross(normal, u);
        result.manifold.normal = normal;
        PlanarPoints points;
        std::array<std::uint32_t, PlanarPoints::capacity> from;
        const auto reduce = [&] {
            std::array<int, 4> chosen{};
            const int outer = farthest_from_centre(points);
            // The first point is an outer one, unless another is clearly deeper.
            const auto height = [&](int i) { return i == outer ? points.w[i] - touch_f() : points.w[i]; };
            const int kept = choose_four(
                points.count, [&](int i) { return points.u[i]; }, [&](int i) { return points.v[i]; }, height, 0.0f,
                chosen, 1.0001f);
            for (int i = 0; i < kept; ++i) {
                points.copy(chosen[i], i);
                from[i] = from[chosen[i]];
            }
            points.count = kept;
        };
        for (const FoundContact& c : memory_.contacts) {
            if (c.group != group) continue;
            for (std::uint32_t i = c.first; i < c.first + c.count; ++i) {
                const FoundPoint& p = memory_.points[i];
                const float pu = dot(p.position, u), pv = dot(p.position, v);
                bool known = false;
                for (int k = 0; k < points.count && !known; ++k) {
                    const float du = points.u[k] - pu, dv = points.v[k] - pv;
                    known = du * du + dv * dv < 0.01f * touch_f() * touch_f();
                    if (known && p.separation < points.w[k]) {
                        points.w[k] = p.separation;
                        points.feature[k] = p.feature;
                        from[k] = i;
                    }
                }
                if (known) continue;
                if (points.count == PlanarPoints::capacity) reduce();
                from[points.count] = i;
                points.put(pu, pv, p.separation, p.feature);
            }
        }
        if (points.count > 2) reduce();  // leaves out points between others
        result.manifold.count = points.count;
        for (int i = 0; i < points.count; ++i) {
            const FoundPoint& p = memory_.points[from[i]];
            result.manifold.points[static_cast<std::size_t>(i)] = {p.position, p.separation, p.feature};
        }
        return result;
    }
    [[nodiscard]] static int farthest_from_centre(const PlanarPoints& points) {
        float u = 0, v = 0;
        for (int i = 0; i < points.count; ++i) {
            u += points.u[i];
            v += points.v[i];
        }
        const float share = 1.0f / static_cast<float>(points.count);
        int best = 0;
        float farthest = -1;
        for (int i = 0; i < points.count; ++i) {
            const float du = points.u[i] - u * share, dv = points.v[i] - v * share;
            if (!(du * du + dv * dv > farthest * 1.001f)) continue;
            farthest = du * du + dv * dv;
            best = i;
        }
        return best;
    }
    [[nodiscard]] float touch_f() const { return static_cast<float>(touch_); }

    MeshContacts& out_;
    Memory& memory_;
    const Mesh& mesh_;
    CoreView view_;
    TransformD at_;  ///< of the shape, about its position
    Vec3d origin_;   ///< position of the shape in the mesh
    Vec3d middle_;
    double margin_, reach_;
    bool is_ball_;
    double around_ = 0;   ///< radius of a sphere around the middle that holds the shape and the margin
    double touch_ = 0;    ///< metres within which triangles touch each other
    double shallow_ = 0;  ///< metres of penetration that are never due to a side of the shape
    Aabb box_;            ///< of the shape, relative to its position, with the margin
};

std::span<const MeshManifold> MeshContacts::find(const Mesh& mesh, const Shape& shape, const TransformD& pose,
                                                 float margin, float reach) {
    found_.clear();
    if (std::holds_alternative<HalfSpace>(shape) || std::holds_alternative<Mesh>(shape)) return {};
    Search(*this, mesh, shape, pose, margin, reach).run();
    return found_;
}

}  // namespace fase::narrow
