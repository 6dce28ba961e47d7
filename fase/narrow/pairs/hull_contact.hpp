#pragma once
/// The contact of two polyhedra: best axis, then face against face or edge against edge.
#include "fase/narrow/pairs/face_over_face.hpp"
#include "fase/narrow/pairs/hull_axes.hpp"

namespace fase::narrow {

/// The contact of two polyhedra. Not `complete`: the axis is right, but the deepest points along it are not over the
/// face, or on the edges, of this contact.
struct HullContact {
    Manifold manifold;
    bool complete = true;
    float deepest = 1e30f;  ///< minimum separation of its points
};

/// The contact over the best face of a (`from_a`) or of b.
inline HullContact touch_hull_faces(const HullPair& pair, const BestFace& best, bool from_a, float margin) {
    FaceOverFace faces;
    faces.reference = from_a ? pair.a : pair.b;
    faces.incident = from_a ? pair.b : pair.a;
    faces.reference_face = best.face;
    faces.rotation = from_a ? pair.rotation : transpose(pair.rotation);
    faces.position = from_a ? pair.position : -transpose_times(pair.rotation, pair.position);
    const PlanarFrame frame = frame_of(faces.reference, best.face);
    faces.incident_face = faces.incident.face_towards(transpose_times(faces.rotation, -frame.normal));
    PlanarPoints points;
    FaceClipper clipper(faces, frame, margin, points);
    clipper.put_edges();
    clipper.put_corners();
    const float tolerance = 5e-5f * clipper.extent();
    float deepest = 1e30f;
    for (int i = 0; i < points.count; ++i) deepest = points.w[i] < deepest ? points.w[i] : deepest;
    // The most opposite face need not contain the deepest vertex.
    bool complete = deepest <= best.separation + tolerance;
    if (!complete) complete = clipper.put_vertex(best.witness);
    reduce_to_four(points, tolerance);

    HullContact contact = {{}, complete, complete && best.separation < deepest ? best.separation : deepest};
    Manifold& manifold = contact.manifold;
    manifold.count = points.count;
    manifold.normal = from_a ? frame.normal : pair.rotation * -frame.normal;
    const std::uint32_t owner = (from_a ? 0u : 1u << 31) | (best.face & 0xffu) << 23;
    for (int i = 0; i < points.count; ++i) {
        const Vec3 position = frame.origin + frame.u_axis * points.u[i] + frame.v_axis * points.v[i] +
                              frame.normal * (points.w[i] * 0.5f);
        manifold.points[i] = {from_a ? position : pair.position + pair.rotation * position, points.w[i],
                              points.feature[i] | owner};
    }
    return contact;
}

/// The contact of two edges: one point between their closest points.
inline HullContact touch_hull_edges(const HullPair& pair, const BestEdges& best, float margin) {
    const ConvexHull::Edge& edge_a = pair.a.edges[best.edge_a];
    const ConvexHull::Edge& edge_b = pair.b.edges[best.edge_b];
    const Vec3 from_a = pair.a.vertices[edge_a.from], along_a = pair.a.vertices[edge_a.to] - from_a;
    const Vec3 from_b = pair.position + pair.rotation * pair.b.vertices[edge_b.from];
    const Vec3 along_b = pair.rotation * (pair.b.vertices[edge_b.to] - pair.b.vertices[edge_b.from]);
    const auto clamp01 = [](float x) { return x < 0 ? 0.f : x > 1 ? 1.f : x; };
    const Vec3 between = from_b - from_a;
    const float aa = length_squared(along_a), bb = length_squared(along_b), ab = dot(along_a, along_b);
    const float squared = length_squared(cross(along_a, along_b));
    const float a_between = dot(along_a, between), b_between = dot(along_b, between);
    const float t = (ab * a_between - aa * b_between) / squared;
    const float s = (a_between + ab * clamp01(t)) / aa;
    const Vec3 on_a = from_a + along_a * clamp01(s);
    const Vec3 on_b = from_b + along_b * clamp01((ab * clamp01(s) - b_between) / bb);
    HullContact contact;
    contact.complete = t >= 0 && t <= 1 && s >= 0 && s <= 1;
    contact.manifold.normal = best.normal;
    const float separation = dot(best.normal, on_b - on_a);
    if (!(separation <= margin)) return contact;
    contact.manifold.count = 1;
    contact.manifold.points[0] = {(on_a + on_b) * 0.5f, separation,
                                  3u | (best.edge_a & 0x7fffu) << 2 | best.edge_b << 17};
    return contact;
}

/// Normal: the axis with the largest separation of all face normals and edge pairs; faces of a are preferred to faces
/// of b, and both to edges, unless the other is better by 1 % and by 2e-4 of the hulls' thickness. Features: see
/// FaceClipper; bits 0–1 = 3: two edges. An edge axis within 10° of the best face's normal gives way to the face when
/// the face contact is as deep to 3 %, because four points support better than one. Not complete: the hulls are apart,
/// corner near corner or corner near edge.
inline HullContact touch_hulls(const HullView& a, const HullView& b, const LocalPose& b_in_a, float margin) {
    const HullPair pair = {a, b, to_matrix(b_in_a.rotation), b_in_a.position};
    const Vec3 reach = abs(b_in_a.position) + abs(a.vertices[0]) + abs(b.vertices[0]);
    const float noise = 4e-7f * (reach.x + reach.y + reach.z);
    const BestFace of_a = find_best_face(a, b, pair.rotation, pair.position, margin, noise);
    if (!(of_a.separation <= margin)) return {};
    const BestFace of_b =
        find_best_face(b, a, transpose(pair.rotation), -transpose_times(pair.rotation, pair.position), margin, noise);
    if (!(of_b.separation <= margin)) return {};
    const float min_gain = noise + 2e-4f * (of_a.inner < of_b.inner ? of_a.inner : of_b.inner);
    const auto preferred = [&](float separation) { return separation + min_gain + 0.01f * std::fabs(separation); };
    const bool from_a = !(of_b.separation > preferred(of_a.separation));
    const BestFace& best = from_a ? of_a : of_b;
    const float by_face = best.separation;
    BestEdges edges = find_best_edges(pair, of_a, of_b, preferred(by_face), min_gain, noise);
    if (edges.found && !(edges.separation <= margin)) return {};
    const auto over_edges = [&] {
        HullContact contact = touch_hull_edges(pair, edges, margin);
        contact.complete = contact.complete || edges.separation <= 0;
        return contact;
    };
    constexpr float cos_10 = 0.985f;
    const Vec3 face_normal =
        from_a ? a.faces[best.face].plane.normal : pair.rotation * -b.faces[best.face].plane.normal;
    if (edges.found && dot(edges.normal, face_normal) < cos_10) return over_edges();
    const HullContact contact = touch_hull_faces(pair, best, from_a, margin);
    const auto faces_or_edges = [&] {
        const float limit = edges.separation + min_gain + 0.03f * std::fabs(edges.separation);
        const bool by_faces = contact.deepest <= limit && dot(edges.normal, face_normal) >= cos_10;
        return by_faces ? HullContact{contact.manifold} : over_edges();
    };
    if (edges.found) return faces_or_edges();
    if (contact.complete) return contact;
    // The face won only by preference, and its contact misses the deepest points.
    if (by_face < 0) edges = find_best_edges(pair, of_a, of_b, by_face, 0, noise);
    if (edges.found) return faces_or_edges();
    // Hulls that are apart may be closest beside the face.
    const bool has_closest = contact.manifold.count > 0 && contact.deepest <= by_face + 0.1f * margin;
    return {contact.manifold, by_face < 0 || has_closest};
}

}  // namespace fase::narrow
