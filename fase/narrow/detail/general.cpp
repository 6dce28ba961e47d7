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
/// A face takes part as reference when its normal is within 5.7 degrees of the contact's; of 0.8 degrees, when one of
/// the shapes is rounded, for then a slanted normal ends far from the foot of a point.
constexpr double aligned_sharp = 0.995, aligned_rounded = 0.9999;

/// The feature of a shape in direction `outward`, all in the frame that `pose` leads to.
Feature feature_in(const CoreView& view, const TransformD& pose, Vec3d outward) {
    Feature feature;
    view.table->feature(view.shape, transpose_times(pose.rotation, outward), feature);
    for (std::size_t i = 0; i < static_cast<std::size_t>(feature.count); ++i) {
        feature.corners[i].at = transform(pose, feature.corners[i].at);
    }
    feature.normal = pose.rotation * feature.normal;
    return feature;
}

/// Candidates for contact points; more than 4 are thinned out.
struct Candidates {
    struct Point {
        Vec3d at;
        double separation = 0;
        std::uint32_t name = 0;
    };
    Buffer<Point, ClipPolygon::capacity + 2> points;
    int count = 0;

    void add(Vec3d at, double separation, std::uint32_t name) {
        points[static_cast<std::size_t>(count++)] = {at, separation, name};
    }
    [[nodiscard]] double least() const {
        double least = std::numeric_limits<double>::infinity();
        for (int i = 0; i < count; ++i) {
            const double s = points[static_cast<std::size_t>(i)].separation;
            if (s < least) least = s;
        }
        return least;
    }
    void drop_above(double margin) {
        int kept = 0;
        for (int i = 0; i < count; ++i) {
            const Point p = points[static_cast<std::size_t>(i)];
            if (p.separation <= margin) points[static_cast<std::size_t>(kept++)] = p;
        }
        count = kept;
    }
    void drop_twins(double closer_than) {
        int kept = 0;
        for (int i = 0; i < count; ++i) {
            const Point p = points[static_cast<std::size_t>(i)];
            bool twin = false;
            for (int k = 0; k < kept && !twin; ++k) {
                twin = length_squared(points[static_cast<std::size_t>(k)].at - p.at) < closer_than * closer_than;
            }
            if (!twin) points[static_cast<std::size_t>(kept++)] = p;
        }
        count = kept;
    }
    [[nodiscard]] Manifold finish(Vec3d normal, double size) {
        drop_twins(1e-6 * size);
        Manifold manifold;
        manifold.normal = to_float(normal);
        std::array<int, 4> chosen{0, 1, 2, 3};
        int kept = count;
        if (count > 4) {
            const Vec3d u = any_perpendicular(normal), v = cross(normal, u), origin = points[0].at;
            const auto at = [&](int i) { return points[static_cast<std::size_t>(i)].at - origin; };
            kept = choose_four(
                count, [&](int i) { return static_cast<float>(dot(u, at(i))); },
                [&](int i) { return static_cast<float>(dot(v, at(i))); },
                [&](int i) { return static_cast<float>(points[static_cast<std::size_t>(i)].separation); },
                static_cast<float>(1e-4 * size), chosen);
        }
        manifold.count = kept;
        for (std::size_t i = 0; i < static_cast<std::size_t>(kept); ++i) {
            const Point& p = points[static_cast<std::size_t>(chosen[i])];
            manifold.points[i] = {to_float(p.at), static_cast<float>(p.separation), p.name};
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

/// The edge of the feature that lies farthest in direction `outward`; a point is an edge of length 0.
Segment edge_of(const Feature& feature, Vec3d outward) {
    const auto count = static_cast<std::size_t>(feature.count);
    if (count == 1) return {feature.corners[0], feature.corners[0]};
    if (count == 2) return {feature.corners[0], feature.corners[1]};
    std::size_t best = 0;
    double farthest = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t next = i + 1 == count ? 0 : i + 1;
        const double along = dot(feature.corners[i].at + feature.corners[next].at, outward);
        if (along > farthest) {
            farthest = along;
            best = i;
        }
    }
    return {feature.corners[best], feature.corners[best + 1 == count ? 0 : best + 1]};
}

/// Two convex cores on their way to a manifold; everything in a's frame.
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
            found.drop_above(margin_);
        }
        // Where the features miss the deepest place (rounded shapes, slanted faces), the closest points themselves
        // count.
        const bool missed = found.count == 0 || found.least() > separation_ + 1e-3 * gjk_.scale + 0.1 * margin_;
        if (missed) {
            add_closest(few_points | edge_of(on_a, normal_).name() << 15 | edge_of(on_b, -normal_).name(), found);
        }
        return found.finish(normal_, gjk_.scale);
    }

private:
    /// False: farther apart than the margin.
    bool find_normal() {
        const double radii = a_.radius + b_.radius;
        GjkOptions options;
        options.farther_than = margin_ + radii;
        options.tolerance = 1e-10;
        gjk_ = gjk(a_, b_, b_in_a_, options);
        if (gjk_.state == GjkResult::State::Farther) return false;
        // Too close for the closest points to show the way.
        deep_ = gjk_.state == GjkResult::State::Overlap || gjk_.distance < 1e-7 * gjk_.scale;
        if (deep_) {
            PenetrationOptions limits;
            limits.tolerance = 1e-6 * gjk_.scale;
            limits.face_bias = 1e-4 * gjk_.scale;
            const Penetration way = penetration(a_, b_, b_in_a_, gjk_.simplex, limits);
            normal_ = way.normal;
            core_gap_ = -way.depth;
        } else {
            normal_ = gjk_.normal;
            core_gap_ = gjk_.distance;
        }
        separation_ = core_gap_ - radii;
        return separation_ <= margin_;
    }

    /// `point` lies on the core of a (or of b), and the other core's surface is `gap` away along the normal.
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
        // A slanted round cap: its lowest point lies between the samples.
        const CoreView& view = flipped ? a_ : b_;
        const TransformD pose = flipped ? TransformD{} : b_in_a_;
        const Vec3d lowest = transform(pose, view.support(transpose_times(pose.rotation, -outward)));
        const ClipPoint p = frame.flatten({lowest, 0x3FFF});
        const double separation = p.height / slant - a_.radius - b_.radius;
        const double size = length(incident.corners[0].at - incident.corners[1].at);
        if (separation < found.least() - 1e-3 * size && frame.contains(p)) {
            add(lowest, p.height / slant, !flipped, flag | p.name, found);
        }
    }

    void parallel_edges(const Segment& on_a, const Segment& on_b, Candidates& found) const {
        const Vec3d u = on_a.to.at - on_a.from.at, v = on_b.to.at - on_b.from.at;
        const double uu = length_squared(u), vv = length_squared(v);
        constexpr double nearly = 0.0025, across = 0.01;  // squared sines: 3 degrees, 6 degrees
        if (!(uu > 0 && vv > 0) || length_squared(cross(u, v)) > nearly * uu * vv) return;
        const double un = dot(u, normal_), vn = dot(v, normal_);
        if (un * un > across * uu || vn * vn > across * vv) return;
        const double at_from = dot(on_b.from.at - on_a.from.at, u) / uu, at_to = dot(on_b.to.at - on_a.from.at, u) / uu;
        const bool same_way = at_from <= at_to;
        const Corner &low = same_way ? on_b.from : on_b.to, &high = same_way ? on_b.to : on_b.from;
        const double at_low = same_way ? at_from : at_to, at_high = same_way ? at_to : at_from;
        const double begin = at_low > 0 ? at_low : 0, end = at_high < 1 ? at_high : 1;
        constexpr double too_short = 1e-3;
        if (!(end - begin > too_short)) return;
        const auto put = [&](double at, std::uint32_t name) {
            const Vec3d p = on_a.from.at + u * at;
            const Vec3d q = low.at + (high.at - low.at) * ((at - at_low) / (at_high - at_low));
            add(p, dot(q - p, normal_), false, few_points | name, found);
        };
        constexpr std::uint32_t of_b = 1u << 29;
        put(begin, at_low > 0 ? of_b | low.id : on_a.from.id);
        put(end, at_high < 1 ? of_b | high.id : on_a.to.id);
    }

    void add_closest(std::uint32_t name, Candidates& found) const {
        Vec3d point = gjk_.on_a;
        if (deep_) {
            Penetration way;
            way.normal = normal_;
            way.depth = -core_gap_;
            point = moved_apart(a_, b_, b_in_a_, way, gjk_.scale, 1e-10).on_a;
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
    double core_gap_ = 0;    ///< of the cores along the normal, below 0 when they overlap
    double separation_ = 0;  ///< of the shapes
};

}  // namespace

Manifold collide_cores(const CoreView& a, const CoreView& b, const LocalPose& b_in_a, float margin) {
    const TransformD pose = to_double(b_in_a);
    return CoreContact(a, b, pose, margin).find();
}

Manifold collide_ground(const CoreView& b, const LocalPose& b_in_a, float margin) {
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
        add(feature.corners[i].at, feature.corners[i].id);
        const double reach = length(feature.corners[i].at - feature.corners[0].at);
        if (reach > size) size = reach;
    }
    const Vec3d lowest = transform(pose, b.support(transpose_times(pose.rotation, -up)));
    if (lowest.y - b.radius < found.least() - 1e-3 * size) add(lowest, few_points);
    found.drop_above(margin);
    return found.finish(up, size);
}

}  // namespace fase::narrow
