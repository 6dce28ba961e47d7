/// Clipping of a face or an edge against the sides of a reference face, in the plane of that face.
#include "fase/narrow/detail/clip.hpp"

namespace fase::narrow {
namespace {

constexpr std::uint32_t id_mask = 0x3FFF, side_flag = 0x4000, no_second = 0x7FFF;

std::uint32_t name_of_corner(std::uint32_t id) { return (id & id_mask) << 15 | no_second; }
std::uint32_t name_of_cut(std::uint32_t edge, std::uint32_t side) { return edge << 15 | side; }

/// Interpolates from p (fraction 0) to q (1).
ClipPoint interpolate(const ClipPoint& p, const ClipPoint& q, double fraction) {
    ClipPoint cut;
    cut.u = p.u + (q.u - p.u) * fraction;
    cut.v = p.v + (q.v - p.v) * fraction;
    cut.height = p.height + (q.height - p.height) * fraction;
    return cut;
}

}  // namespace

ClipFrame::ClipFrame(const Feature& reference)
    : origin_(reference.corners[0].position), u_(any_perpendicular(reference.normal)), normal_(reference.normal) {
    v_ = cross(normal_, u_);
    double size = 0;
    const auto count = static_cast<std::size_t>(reference.count);
    ClipPoint from = flatten(reference.corners[count - 1]);
    for (std::size_t i = 0; i < count; ++i) {
        const ClipPoint to = flatten(reference.corners[i]);
        const double du = to.u - from.u, dv = to.v - from.v;
        const double l = std::sqrt(du * du + dv * dv);
        if (l > 0) {
            const std::uint32_t id = reference.corners[i == 0 ? count - 1 : i - 1].id;
            const double u = dv / l, v = -du / l;
            sides_[static_cast<std::size_t>(side_count_++)] = {u, v, u * from.u + v * from.v,
                                                               (id & id_mask) | side_flag};
            if (l > size) size = l;
        }
        from = to;
    }
    slack_ = 1e-6 * size;
}

ClipPoint ClipFrame::flatten(const Corner& corner) const {
    const Vec3d p = corner.position - origin_;
    ClipPoint point;
    point.u = dot(u_, p);
    point.v = dot(v_, p);
    point.height = dot(normal_, p);
    point.name = name_of_corner(corner.id);
    point.edge = corner.id & id_mask;
    return point;
}

bool ClipFrame::contains(const ClipPoint& point) const {
    for (int i = 0; i < side_count_; ++i) {
        if (sides_[static_cast<std::size_t>(i)].beyond(point) > slack_) return false;
    }
    return true;
}

ClipPolygon ClipFrame::clip(const Feature& incident) const {
    ClipPolygon polygon;
    polygon.count = incident.count;
    for (std::size_t i = 0; i < static_cast<std::size_t>(incident.count); ++i) {
        polygon.points[i] = flatten(incident.corners[i]);
    }
    if (incident.count >= 3) {
        clip_polygon(polygon);
    } else if (incident.count == 2) {
        clip_segment(polygon);
    } else if (!contains(polygon.points[0])) {
        polygon.count = 0;
    }
    return polygon;
}

void ClipFrame::clip_polygon(ClipPolygon& polygon) const {
    ClipPolygon other;
    ClipPolygon *input = &polygon, *clipped = &other;
    for (int s = 0; s < side_count_ && input->count > 0; ++s) {
        const Side& side = sides_[static_cast<std::size_t>(s)];
        clipped->count = 0;
        const auto put = [&](const ClipPoint& p) {
            if (clipped->count < ClipPolygon::capacity) clipped->points[static_cast<std::size_t>(clipped->count++)] = p;
        };
        bool all_in = true;
        for (int i = 0; i < input->count && all_in; ++i) {
            all_in = side.beyond(input->points[static_cast<std::size_t>(i)]) <= slack_;
        }
        if (all_in) continue;
        ClipPoint from = input->points[static_cast<std::size_t>(input->count - 1)];
        double from_beyond = side.beyond(from);
        for (int i = 0; i < input->count; ++i) {
            const ClipPoint to = input->points[static_cast<std::size_t>(i)];
            const double to_beyond = side.beyond(to);
            const bool from_out = from_beyond > slack_, to_out = to_beyond > slack_;
            if (from_out != to_out) {
                // A corner within the slack replaces its cut.
                const bool grazes = from_out ? to_beyond >= 0 : from_beyond >= 0;
                if (!grazes) {
                    ClipPoint cut = interpolate(from, to, from_beyond / (from_beyond - to_beyond));
                    cut.name = name_of_cut(from.edge, side.id);
                    cut.edge = from_out ? from.edge : side.id;
                    put(cut);
                }
            }
            if (!to_out) put(to);
            from = to;
            from_beyond = to_beyond;
        }
        ClipPolygon* const done = clipped;
        clipped = input;
        input = done;
    }
    if (input == &polygon) return;
    polygon.count = input->count;
    for (std::size_t i = 0; i < static_cast<std::size_t>(input->count); ++i) polygon.points[i] = input->points[i];
}

void ClipFrame::clip_segment(ClipPolygon& segment) const {
    const std::uint32_t edge = segment.points[0].edge;
    for (int s = 0; s < side_count_; ++s) {
        const Side& side = sides_[static_cast<std::size_t>(s)];
        ClipPoint& p = segment.points[0];
        ClipPoint& q = segment.points[1];
        const double p_beyond = side.beyond(p), q_beyond = side.beyond(q);
        const bool p_out = p_beyond > slack_, q_out = q_beyond > slack_;
        if (p_out && q_out) {
            segment.count = 0;
            return;
        }
        if (!p_out && !q_out) continue;
        ClipPoint cut = interpolate(p, q, p_beyond / (p_beyond - q_beyond));
        if (p_out ? q_beyond >= 0 : p_beyond >= 0) cut = p_out ? q : p;
        cut.name = name_of_cut(edge, side.id);
        (p_out ? p : q) = cut;
    }
}

}  // namespace fase::narrow
