#pragma once
/// The contact of two polyhedra: best axis, then face over face or edge against edge.
#include "fase/narrow/pairs/face_over_face.hpp"
#include "fase/narrow/pairs/hull_axes.hpp"

namespace fase::narrow {

/// The contact of two polyhedra, and whether it tells all. Not `whole`: the axis is right, but what is nearest along it
/// does not lie over the face, or at the edges, that the contact was taken from.
struct HullContact {
    Manifold manifold;
    bool whole = true;
    float deepest = 1e30f;  ///< least separation of its points
};

/// The contact over the best face of a (`from_a`) or of b.
inline HullContact touch_hull_faces(const HullPair& pair, const BestFace& best, bool from_a, float margin) {
    FaceOverFace faces;
    faces.reference = from_a ? pair.a : pair.b;
    faces.incident = from_a ? pair.b : pair.a;
    faces.reference_face = best.face;
    faces.turn = from_a ? pair.turn : transpose(pair.turn);
    faces.place = from_a ? pair.place : -transpose_times(pair.turn, pair.place);
    const PlanarFrame frame = frame_of(faces.reference, best.face);
    faces.incident_face = faces.incident.face_towards(transpose_times(faces.turn, -frame.normal));
    PlanarPoints points;
    FaceClipper clipper(faces, frame, margin, points);
    clipper.put_edges();
    clipper.put_corners();
    const float tolerance = 5e-5f * clipper.extent();
    float deepest = 1e30f;
    for (int i = 0; i < points.count; ++i) deepest = points.w[i] < deepest ? points.w[i] : deepest;
    // The face that looks this way most need not hold the deepest vertex.
    bool whole = deepest <= best.separation + tolerance;
    if (!whole) whole = clipper.put_vertex(best.witness);
    reduce_to_four(points, tolerance);

    HullContact contact = {{}, whole, whole && best.separation < deepest ? best.separation : deepest};
    Manifold& manifold = contact.manifold;
    manifold.count = points.count;
    manifold.normal = from_a ? frame.normal : pair.turn * -frame.normal;
    const std::uint32_t owner = (from_a ? 0u : 1u << 31) | (best.face & 0xffu) << 23;
    for (int i = 0; i < points.count; ++i) {
        const Vec3 at = frame.origin + frame.u_axis * points.u[i] + frame.v_axis * points.v[i] +
                        frame.normal * (points.w[i] * 0.5f);
        manifold.points[i] = {from_a ? at : pair.place + pair.turn * at, points.w[i], points.feature[i] | owner};
    }
    return contact;
}

/// The contact of two edges: one point between their closest points.
inline HullContact touch_hull_edges(const HullPair& pair, const BestEdges& best, float margin) {
    const ConvexHull::Edge& edge_a = pair.a.edges[best.edge_a];
    const ConvexHull::Edge& edge_b = pair.b.edges[best.edge_b];
    const Vec3 from_a = pair.a.vertices[edge_a.from], along_a = pair.a.vertices[edge_a.to] - from_a;
    const Vec3 from_b = pair.place + pair.turn * pair.b.vertices[edge_b.from];
    const Vec3 along_b = pair.turn * (pair.b.vertices[edge_b.to] - pair.b.vertices[edge_b.from]);
    const auto share = [](float x) { return x < 0 ? 0.f : x > 1 ? 1.f : x; };
    const Vec3 between = from_b - from_a;
    const float aa = length_squared(along_a), bb = length_squared(along_b), ab = dot(along_a, along_b);
    const float squared = length_squared(cross(along_a, along_b));
    const float a_between = dot(along_a, between), b_between = dot(along_b, between);
    const float t = (ab * a_between - aa * b_between) / squared;
    const float s = (a_between + ab * share(t)) / aa;
    const Vec3 on_a = from_a + along_a * share(s), on_b = from_b + along_b * share((ab * share(s) - b_between) / bb);
    HullContact contact;
    contact.whole = t >= 0 && t <= 1 && s >= 0 && s <= 1;
    contact.manifold.normal = best.normal;
    const float separation = dot(best.normal, on_b - on_a);
    if (!(separation <= margin)) return contact;
    contact.manifold.count = 1;
    contact.manifold.points[0] = {(on_a + on_b) * 0.5f, separation,
                                  3u | (best.edge_a & 0x7fffu) << 2 | best.edge_b << 17};
    return contact;
}

/// Normal: of all face normals and edge pairs the axis with the largest separation; faces of a win over faces of b, and
/// both over edges, unless the other is better by 1 % and by 2e-4 of the hulls' thickness. Features: see FaceClipper;
/// bits 0–1 = 3: two edges. An edge axis within 10° of the best face's normal gives way to the face when what lies over
/// the face is as deep to 3 %: four points carry better than one. Not whole: the hulls pass corner to corner or corner
/// to edge, the margin between them.
inline HullContact touch_hulls(const HullView& a, const HullView& b, const LocalPose& b_in_a, float margin) {
    const HullPair pair = {a, b, to_matrix(b_in_a.rotation), b_in_a.position};
    const Vec3 reach = abs(b_in_a.position) + abs(a.vertices[0]) + abs(b.vertices[0]);
    const float noise = 4e-7f * (reach.x + reach.y + reach.z);
    const BestFace of_a = find_best_face(a, b, pair.turn, pair.place, margin, noise);
    if (!(of_a.separation <= margin)) return {};
    const BestFace of_b =
        find_best_face(b, a, transpose(pair.turn), -transpose_times(pair.turn, pair.place), margin, noise);
    if (!(of_b.separation <= margin)) return {};
    const float clearly = noise + 2e-4f * (of_a.inner < of_b.inner ? of_a.inner : of_b.inner);
    const auto ahead = [&](float separation) { return separation + clearly + 0.01f * std::fabs(separation); };
    const bool from_a = !(of_b.separation > ahead(of_a.separation));
    const BestFace& best = from_a ? of_a : of_b;
    const float by_face = best.separation;
    BestEdges edges = find_best_edges(pair, of_a, of_b, ahead(by_face), clearly, noise);
    if (edges.found && !(edges.separation <= margin)) return {};
    const auto over_edges = [&] {
        HullContact contact = touch_hull_edges(pair, edges, margin);
        contact.whole = contact.whole || edges.separation <= 0;
        return contact;
    };
    constexpr float cos_10 = 0.985f;
    const Vec3 face_normal = from_a ? a.faces[best.face].plane.normal : pair.turn * -b.faces[best.face].plane.normal;
    if (edges.found && dot(edges.normal, face_normal) < cos_10) return over_edges();
    const HullContact contact = touch_hull_faces(pair, best, from_a, margin);
    const auto faces_or_edges = [&] {
        const float as_deep = edges.separation + clearly + 0.03f * std::fabs(edges.separation);
        const bool by_faces = contact.deepest <= as_deep && dot(edges.normal, face_normal) >= cos_10;
        return by_faces ? HullContact{contact.manifold} : over_edges();
    };
    if (edges.found) return faces_or_edges();
    if (contact.whole) return contact;
    // The face won only because faces are preferred, but its contact is not there.
    if (by_face < 0) edges = find_best_edges(pair, of_a, of_b, by_face, 0, noise);
    if (edges.found) return faces_or_edges();
    // Apart, the nearest place may lie beside the face, and nearer than all that is over it.
    const bool nearest_is_there = contact.manifold.count > 0 && contact.deepest <= by_face + 0.1f * margin;
    return {contact.manifold, by_face < 0 || nearest_is_there};
}

}  // namespace fase::narrow
