/// The contact of any two shapes, by GJK, SAT or EPA and clipping.
#include "fase/narrow/detail/general.hpp"

#include <array>
#include <limits>

#include "fase/narrow/detail/clip.hpp"
#include "fase/narrow/detail/penetration.hpp"
#include "fase/narrow/detail/polygon.hpp"

namespace fase::narrow {
namespace {

constexpr std::uint32_t reference_is_b = 1u << 31, few_points = 1u << 30;
/// A face can be the reference when its normal is within 5.7 degrees of the contact normal; within 0.8 degrees when one
/// of the shapes is rounded, because then a point's projection along a slanted normal is far off.
constexpr double aligned_sharp = 0.995, aligned_rounded = 0.9999;

/// Returns the feature of a shape in direction `outward`; `pose` maps the shape's frame to that of the result.
Feature feature_in(const CoreView& view, const TransformD& pose, Vec3d outward) {
    Feature feature;
    view.table->feature(view.shape, transpose_times(pose.rotation, outward), feature);
    for (std::size_t i = 0; i < static_cast<std::size_t>(feature.count); ++i) {
        feature.corners[i].position = transform(pose, feature.corners[i].position);
    }
    feature.normal = pose.rotation * feature.normal;
    return feature;
}

/// Candidates for contact points; finish() reduces them to 4.
struct Candidates {
    struct Point {
        Vec3d position;
        double separation = 0;
        std::uint32_t name = 0;
    };
    Buffer<Point, ClipPolygon::capacity + 2> points;
    int count = 0;

    void add(Vec3d position, double separation, std::uint32_t name) {
        points[static_cast<std::size_t>(count++)] = {position, separation, name};
    }
    [[nodiscard]] double min_separation() const {
        double smallest = std::numeric_limits<double>::infinity();
        for (int i = 0; i < count; ++i) {
            const double s = points[static_cast<std::size_t>(i)].separation;
            if (s < smallest) smallest = s;
        }
        return smallest;
    }
    void remove_above(double margin) {
        int kept = 0;
        for (int i = 0; i < count; ++i) {
            const Point p = points[static_cast<std::size_t>(i)];
            if (p.separation <= margin) points[static_cast<std::size_t>(kept++)] = p;
        }
        count = kept;
    }
    void remove_duplicates(double min_distance) {
        int kept = 0;
        for (int i = 0; i < count; ++i) {
            const Point p = points[static_cast<std::size_t>(i)];
            bool duplicate = false;
            for (int k = 0; k < kept && !duplicate; ++k) {
                const Vec3d between = points[static_cast<std::size_t>(k)].position - p.position;
                duplicate = length_squared(between) < min_distance * min_distance;
            }
            if (!duplicate) points[static_cast<std::size_t>(kept++)] = p;
        }
        count = kept;
    }
    [[nodiscard]] Manifold finish(Vec3d normal, double size) {
        remove_duplicates(1e-6 * size);
        Manifold manifold;
        manifold.normal = to_float(normal);
        std::array<int, 4> chosen{0, 1, 2, 3};
        int kept = count;
        if (count > 4) {
            const Vec3d u = any_perpendicular(normal), v = cross(normal, u), origin = points[0].position;
            const auto offset = [&](int i) { return points[static_cast<std::size_t>(i)].position - origin; };
            kept = choose_four(
                count, [&](int i) { return static_cast<float>(dot(u, offset(i))); },
                [&](int i) { return static_cast<float>(dot(v, offset(i))); },
                [&](int i) { return static_cast<float>(points[static_cast<std::size_t>(i)].separation); },
                static_cast<float>(1e-4 * size), chosen);
        }
        manifold.count = kept;
        for (std::size_t i = 0; i < static_cast<std::size_t>(kept); ++i) {
            const Point& p = points[static_cast<std::size_t>(chosen[i])];
            manifold.points[i] = {to_float(p.position), static_cast<float>(p.separation), p.name};
        }
        return manifold;
    }
};

/// One edge of a feature.
struct Segment {
    Corner from, to;
    [[nodiscard]] std::uint32_t name() const {
        const std::uint32_t lo = from.id < to.id ? from.id : to.id, hi = from.id < to.id ? to.id : from.id;
        return (lo * 127 + hi) & 0x3FFF;
    }
};

/// Returns the farthest edge of the feature in direction `outward`; a point is an edge of length 0.
Segment edge_of(const Feature& feature, Vec3d outward) {
    const auto count = static_cast<std::size_t>(feature.count);
    if (count == 1) return {feature.corners[0], feature.corners[0]};
    if (count == 2) return {feature.corners[0], feature.corners[1]};
    std::size_t best = 0;
    double farthest = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t next = i + 1 == count ? 0 : i + 1;
        const double along = dot(feature.corners[i].position + feature.corners[next].position, outward);
        if (along > farthest) {
            farthest = along;
            best = i;
        }
    }
    return {feature.corners[best], feature.corners[best + 1 == count ? 0 : best + 1]};
}

/// Computes the manifold of two convex cores, in a's frame.
class CoreContact {
public:
    CoreContact(const CoreView& a, const CoreView& b, const TransformD& b_in_a, double margin)
        : a_(a), b_(b), b_in_a_(b_in_a), margin_(margin) {}

    [[nodiscard]] Manifold find() {
        if (!find_normal()) return {};
        const Feature on_a = feature_in(a_, {}, normal_), on_b = feature_in(b_, b_in_a_, -normal_);
        Candidates found;
        if (on_a.count > 1 && on_b.count > 1) {
            const double aligned = a_.radius + b_.radius > 0 ? aligned_rounded : aligned_sharp;
            const double face_a = on_a.count > 2 ? dot(on_a.normal, normal_) : -1;
            const double face_b = on_b.count > 2 ? -dot(on_b.normal, normal_) : -1;
            if (face_a >= aligned && face_a >= face_b - 1e-4) {
                clip(on_a, on_b, false, found);
            } else if (face_b >= aligned) {
                clip(on_b, on_a, true, found);
            } else {
                parallel_edges(edge_of(on_a, normal_), edge_of(on_b, -normal_), found);
            }
            found.remove_above(margin_);
        }
        // When the features miss the deepest point (rounded shapes, slanted faces), adds the closest points.
        const bool missed =
            found.count == 0 || found.min_separation() > separation_ + 1e-3 * gjk_.scale + 0.1 * margin_;
        if (missed) {
            add_closest(few_points | edge_of(on_a, normal_).name() << 15 | edge_of(on_b, -normal_).name(), found);
        }
        return found.finish(normal_, gjk_.scale);
    }

private:
    /// Finds the contact normal; returns false when the shapes are farther apart than the margin.
    bool find_normal() {
        const double radii = a_.radius + b_.radius;
        GjkOptions options;
        options.farther_than = margin_ + radii;
        options.tolerance = 1e-10;
        gjk_ = gjk(a_, b_, b_in_a_, options);
        if (gjk_.state == GjkResult::State::Farther) return false;
        // Too close for an accurate normal from the closest points.
        deep_ = gjk_.state == GjkResult::State::Overlap || gjk_.distance < 1e-7 * gjk_.scale;
        if (deep_) {
            PenetrationOptions limits;
            limits.tolerance = 1e-6 * gjk_.scale;
            limits.face_bias = 1e-4 * gjk_.scale;
            const Penetration overlap = penetration(a_, b_, b_in_a_, gjk_.simplex, limits);
            normal_ = overlap.normal;
            core_gap_ = -overlap.depth;
        } else {
            normal_ = gjk_.normal;
            core_gap_ = gjk_.distance;
        }
        separation_ = core_gap_ - radii;
        return separation_ <= margin_;
    }

    /// Adds a contact; `point` is on the core of a (or of b), and the other core is `gap` away along the normal.
    void add(Vec3d point, double gap, bool on_b, std::uint32_t name, Candidates& found) const {
        const double separation = gap - a_.radius - b_.radius;
        const double to_middle = on_b ? -(b_.radius + separation / 2) : a_.radius + separation / 2;
        found.add(point + normal_ * to_middle, separation, name);
    }

    void clip(const Feature& reference, const Feature& incident, bool flipped, Candidates& found) const {
        const Vec3d outward = flipped ? -normal_ : normal_;
        const ClipFrame frame(reference);
        const ClipPolygon polygon = frame.clip(incident);
        const double slant = dot(frame.normal(), outward);
        const std::uint32_t flag = flipped ? reference_is_b : 0;
        for (std::size_t i = 0; i < static_cast<std::size_t>(polygon.count); ++i) {
            const ClipPoint& p = polygon.points[i];
            add(frame.lift(p), p.height / slant, !flipped, flag | p.name, found);
        }
        if (!incident.rounded || incident.count < 3) return;
        // A slanted round cap: its lowest point is between the samples.
        const CoreView& view = flipped ? a_ : b_;
        const TransformD pose = flipped ? TransformD{} : b_in_a_;
        const Vec3d lowest = transform(pose, view.support(transpose_times(pose.rotation, -outward)));
        const ClipPoint p = frame.flatten({lowest, 0x3FFF});
        const double separation = p.height / slant - a_.radius - b_.radius;
        const double size = length(incident.corners[0].position - incident.corners[1].position);
        if (separation < found.min_separation() - 1e-3 * size && frame.contains(p)) {
            add(lowest, p.height / slant, !flipped, flag | p.name, found);
        }
    }

    void parallel_edges(const Segment& on_a, const Segment& on_b, Candidates& found) const {
        const Vec3d start = on_a.from.position;
        const Vec3d u = on_a.to.position - start, v = on_b.to.position - on_b.from.position;
        const double uu = length_squared(u), vv = length_squared(v);
        constexpr double max_angle = 0.0025, max_slope = 0.01;  // squared sines: 3 degrees, 6 degrees
        if (!(uu > 0 && vv > 0) || length_squared(cross(u, v)) > max_angle * uu * vv) return;
        const double un = dot(u, normal_), vn = dot(v, normal_);
        if (un * un > max_slope * uu || vn * vn > max_slope * vv) return;
        // Fractions along a's edge.
        const double t_from = dot(on_b.from.position - start, u) / uu, t_to = dot(on_b.to.position - start, u) / uu;
        const bool same_direction = t_from <= t_to;
        const Corner &low = same_direction ? on_b.from : on_b.to, &high = same_direction ? on_b.to : on_b.from;
        const double t_low = same_direction ? t_from : t_to, t_high = same_direction ? t_to : t_from;
        const double begin = t_low > 0 ? t_low : 0, end = t_high < 1 ? t_high : 1;
        constexpr double min_overlap = 1e-3;
        if (!(end - begin > min_overlap)) return;
        const auto put = [&](double t, std::uint32_t name) {
            const Vec3d p = start + u * t;
            const Vec3d q = low.position + (high.position - low.position) * ((t - t_low) / (t_high - t_low));
            add(p, dot(q - p, normal_), false, few_points | name, found);
        };
        constexpr std::uint32_t of_b = 1u << 29;
        put(begin, t_low > 0 ? of_b | low.id : on_a.from.id);
        put(end, t_high < 1 ? of_b | high.id : on_a.to.id);
    }

    void add_closest(std::uint32_t name, Candidates& found) const {
        Vec3d point = gjk_.on_a;
        if (deep_) {
            Penetration overlap;
            overlap.normal = normal_;
            overlap.depth = -core_gap_;
            point = gjk_after_separation(a_, b_, b_in_a_, overlap, gjk_.scale, 1e-10).on_a;
        }
        add(point, core_gap_, false, name, found);
    }

    const CoreView& a_;
    const CoreView& b_;
    const TransformD& b_in_a_;
    double margin_;
    GjkResult gjk_;
    bool deep_ = false;
    Vec3d normal_;
    double core_gap_ = 0;    ///< gap of the cores along the normal, below 0 when they overlap
    double separation_ = 0;  ///< of the shapes
};

}  // namespace

Manifold collide_cores(const CoreView& a, const CoreView& b, const LocalPose& b_in_a, float margin) {
    const TransformD pose = to_double(b_in_a);
    return CoreContact(a, b, pose, margin).find();
}

Manifold collide_with_half_space(const CoreView& b, const LocalPose& b_in_a, float margin) {
    const TransformD pose = to_double(b_in_a);
    const Vec3d up{0, 1, 0};
    const Feature feature = feature_in(b, pose, -up);
    Candidates found;
    const auto add = [&](Vec3d core_point, std::uint32_t name) {
        const double separation = core_point.y - b.radius;
        found.add({core_point.x, separation / 2, core_point.z}, separation, name);
    };
    double size = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(feature.count); ++i) {
        add(feature.corners[i].position, feature.corners[i].id);
        const double reach = length(feature.corners[i].position - feature.corners[0].position);
        if (reach > size) size = reach;
    }
    const Vec3d lowest = transform(pose, b.support(transpose_times(pose.rotation, -up)));
    if (lowest.y - b.radius < found.min_separation() - 1e-3 * size) add(lowest, few_points);
    found.remove_above(margin);
    return found.finish(up, size);
}

}  // namespace fase::narrow
