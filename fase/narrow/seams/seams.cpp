/// Removes ghost hits: contacts of a moving shape with faces and edges that its neighbours hide.
#include "fase/narrow/seams/seams.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "fase/narrow/detail/infinity.hpp"
#include "fase/narrow/seams/plane_contact.hpp"

namespace fase::narrow {
namespace {

constexpr double max_step = 0.002;     // metres: lower steps are none
constexpr double gap = 0.001;          // metres: narrower gaps are closed
constexpr double same_normal = 1e-4;   // radians
constexpr double nearly = 2e-3;        // radians: a normal this close to that of a face is this normal
constexpr double rounding = 1e-6;      // radians
constexpr double flat = 1e-3;          // radians: faces that meet at less lie in one plane
constexpr double turned_away = -0.02;  // cosine: faces that look this far away hide nothing

bool same_direction(Vec3d a, Vec3d b, double angle) { return length_squared(a - b) < angle * angle; }
double above(const CoreFace& plane, Vec3d point) { return dot(plane.normal, point) - plane.offset; }

/// What a piece shows in a direction: its corners within rounding of the farthest one.
struct Shown {
    static constexpr int capacity = 64;
    Buffer<Vec3d, capacity> corners;
    int count = 0;
};

class SeamPass {
public:
    SeamPass(const SeamMover& mover, std::span<SeamContact> contacts)
        : mover_(mover),
          core_{view_of(*mover.shape), mover.pose, mover.path},
          contacts_(contacts),
          step_(std::min(max_step, 0.05 * double(mover.inner_radius))),
          deepest_(0.5 * double(mover.inner_radius)) {}

    void run() {
        for (SeamContact& contact : contacts_) begin(contact);
        end_missed();
        for (std::size_t i = 0; i < contacts_.size(); ++i)
            if (contacts_[i].is_live && !contacts_[i].is_kept) judge(i);
        for (SeamContact& contact : contacts_)
            if (contact.own_face >= 0) contact.is_live = false;
        resolve_passed_where(true);
        for (SeamContact& contact : contacts_)
            if (contact.hidden_by >= 0) resolve_hidden(contact);
        resolve_passed_where(false);
        if (!mover_.is_fast) return;
        for (std::size_t i = 0; i < contacts_.size(); ++i)
            if (contacts_[i].is_live && !contacts_[i].is_kept) widen(i);
    }

private:
    static ShownFaces faces_of(const SeamContact& contact) { return {*contact.piece.shape, contact.piece.pose}; }

    static void begin(SeamContact& contact) {
        contact.changed = false;
        contact.hidden_by = contact.hiding_face = contact.own_face = -1;
        set_place(contact);
    }

    /// Reads normal, deepest point and separation of the manifold.
    static void set_place(SeamContact& contact) {
        const Manifold& manifold = contact.manifold;
        contact.is_live = manifold.count > 0;
        if (!contact.is_live) return;
        std::size_t deepest = 0;
        for (std::size_t i = 1; i < static_cast<std::size_t>(manifold.count); ++i)
            if (manifold.points[i].separation < manifold.points[deepest].separation) deepest = i;
        contact.normal = normalized(to_double(manifold.normal));
        contact.separation = manifold.points[deepest].separation;
        contact.point = to_double(manifold.points[deepest].position) - contact.normal * (contact.separation / 2);
    }

    /// Ends contacts that would act although the path misses the piece, by more than other contacts can push the mover
    /// from it.
    void end_missed() {
        double pushed = 0;  // metres
        bool any = false;
        for (SeamContact& contact : contacts_) {
            contact.clearance = 0;
            const double acts =
                contact.is_live ? -dot(core_.path, contact.normal) - std::max(0.0, contact.separation) : 0;
            if (acts <= 0) continue;
            if (contact.separation > gap && !contact.is_kept && contact.piece.frame == 0)
                contact.clearance = clearance_of(core_, *contact.piece.shape, contact.piece.pose);
            if (contact.clearance <= gap) pushed += acts;
            any = any || contact.clearance > gap;
        }
        constexpr double bounce = 2;  // a push may be returned
        if (!any) return;
        for (SeamContact& contact : contacts_)
            if (contact.is_live && contact.clearance > gap + mover_.detour + bounce * pushed) end(contact);
    }

    /// Decides whether a contact is hidden, or passes over another face of its piece.
    void judge(std::size_t index) {
        SeamContact& contact = contacts_[index];
        const ShownFaces faces = faces_of(contact);
        if (faces.count() == 0 || faces.is_half_space()) return;
        Shown shown;
        find_shown(faces, contact, shown);
        if (find_hiding_face(index, shown)) return;
        int own = facing_face(faces, contact.normal);
        if (!same_direction(faces.plane(own).normal, contact.normal, nearly))
            own = contact.piece.frame == 0 ? entered_face(faces) : -1;
        if (own < 0) return;
        if (same_direction(faces.plane(own).normal, contact.normal, rounding) && !rolls_over(faces.plane(own))) return;
        if (!is_covered(index, faces, own, contact.point)) contact.own_face = own;
    }

    /// Finds what the piece shows along the normal, and moves the point there: points of manifolds need not lie on the
    /// surface.
    static void find_shown(const ShownFaces& faces, SeamContact& contact, Shown& shown) {
        const int facing = facing_face(faces, contact.normal);
        if (same_direction(faces.plane(facing).normal, contact.normal, nearly)) {
            read_corners(faces, facing, shown);
        } else {
            double farthest = -infinity;
            faces.for_each_corner([&](Vec3d corner) { farthest = std::max(farthest, dot(corner, contact.normal)); });
            faces.for_each_corner([&](Vec3d corner) {
                const double slack = 1e-4 + 1e-2 * length(corner - contact.point);
                if (shown.count < Shown::capacity && dot(corner, contact.normal) > farthest - slack)
                    shown.corners[static_cast<std::size_t>(shown.count++)] = corner;
            });
        }
        if (shown.count == 1) contact.point = shown.corners[0];
        if (shown.count == 2) contact.point = nearest_on_segment(shown.corners[0], shown.corners[1], contact.point);
        if (shown.count > 2) contact.point = faces.nearest(facing, contact.point);
    }

    static void read_corners(const ShownFaces& faces, int face, Shown& shown) {
        shown.count = std::min(faces.corner_count(face), Shown::capacity);
        for (int k = 0; k < shown.count; ++k) shown.corners[static_cast<std::size_t>(k)] = faces.corner(face, k);
    }

    /// Whether the mover touches a plane with a line of a curved side. Points beside this line would push it, because
    /// the surface there moves towards the plane.
    [[nodiscard]] bool rolls_over(const CoreFace& plane) const {
        if (core_.view.table->polyhedral) return false;
        Feature lowest;
        core_.view.table->feature(core_.view.shape, transpose_times(core_.pose.rotation, -plane.normal), lowest);
        return lowest.count == 2;
    }

    /// The face whose normal is nearest to a direction.
    static int facing_face(const ShownFaces& faces, Vec3d direction) {
        int most = 0;
        for (int f = 1; f < faces.count(); ++f)
            if (dot(faces.plane(f).normal, direction) > dot(faces.plane(most).normal, direction)) most = f;
        return most;
    }

    /// Whether a neighbour of piece `own` has a face over which the normal leans, and nothing that the piece shows
    /// along the normal stands out of it. Notes that face in the contact.
    bool find_hiding_face(std::size_t own, const Shown& shown) {
        SeamContact& contact = contacts_[own];
        const double reach = 2 * gap + step_ + std::max(contact.separation, 0.0);
        for (std::size_t j = 0; j < contacts_.size(); ++j) {
            if (!are_neighbours(j, own)) continue;
            const ShownFaces faces = faces_of(contacts_[j]);
            if (!faces.is_near(contact.point, reach)) continue;
            for (int f = 0; f < faces.count(); ++f) {
                if (!hides(j, faces, f, contact, shown)) continue;
                const Vec3d normal = faces.plane(f).normal;
                contact.hidden_by = static_cast<int>(j);
                contact.hiding_face = f;
                contact.lean = normalized(contact.normal - normal * dot(contact.normal, normal));
                return true;
            }
        }
        return false;
    }

    /// Whether two contacts are with different pieces that do not move against each other.
    [[nodiscard]] bool are_neighbours(std::size_t i, std::size_t j) const {
        return i != j && contacts_[i].piece.frame == contacts_[j].piece.frame;
    }

    bool hides(std::size_t other, const ShownFaces& faces, int face, const SeamContact& contact,
               const Shown& shown) const {
        const CoreFace plane = faces.plane(face);
        const double facing = dot(contact.normal, plane.normal), height = above(plane, contact.point);
        if (facing < turned_away || same_direction(contact.normal, plane.normal, same_normal) || height > step_ ||
            above(plane, core_.pose.position) <= 0)
            return false;
        Vec3d at = contact.point;
        if (height < -step_) {  // below the face: the face must cut the way to the mover, or the piece be in the way
            const double way = facing > flat ? -height / facing : infinity;
            if (way <= std::max(contact.separation, 0.0) + step_) {
                at += contact.normal * way;
            } else if (!is_inside(faces, just_off(contact.point, contact.normal, shown), contact.normal)) {
                return false;
            }
        }
        const Vec3d lean = normalized(contact.normal - plane.normal * facing);
        if (!faces.covers(face, at, gap) ||
            !(faces.covers(face, at + lean * (2 * gap), 1e-4) || faces.covers(face, at + lean * 3e-4, 2e-5)))
            return false;
        if (shown.count == Shown::capacity) return false;  // others may stand out
        for (int k = 0; k < shown.count; ++k)
            if (above(plane, shown.corners[static_cast<std::size_t>(k)]) > step_) return false;
        return core_.height(plane) >= -deepest_ && !is_covered(other, faces, face, at);
    }

    /// A point just off the surface that shows these corners, moved from its border so that a wall that stands there
    /// does not hold it.
    [[nodiscard]] Vec3d just_off(Vec3d point, Vec3d normal, const Shown& shown) const {
        Vec3d middle;
        for (int k = 0; k < shown.count; ++k) middle += shown.corners[static_cast<std::size_t>(k)];
        const Vec3d inward = middle * (1.0 / shown.count) - point;
        const double way = length(inward), from_border = 4 * step_;
        return point + normal * (2 * gap) + (way > from_border ? inward * (from_border / way) : inward);
    }

    /// Whether a point is inside a piece that may be larger by the height of a step, but not along the normal.
    [[nodiscard]] bool is_inside(const ShownFaces& faces, Vec3d point, Vec3d normal) const {
        for (int f = 0; f < faces.count(); ++f) {
            const CoreFace plane = faces.plane(f);
            if (above(plane, point) > (dot(plane.normal, normal) > 0.5 ? 0 : step_)) return false;
        }
        return faces.count() > 0;
    }

    /// Whether a neighbour covers the face of a piece near a point: the face is inside the ground there.
    [[nodiscard]] bool is_covered(std::size_t piece, const ShownFaces& faces, int face, Vec3d near) const {
        Shown shown;
        read_corners(faces, face, shown);
        if (shown.count == 0) return false;
        const Vec3d normal = faces.plane(face).normal, off = just_off(faces.nearest(face, near), normal, shown);
        for (std::size_t j = 0; j < contacts_.size(); ++j)
            if (are_neighbours(j, piece) && is_inside(faces_of(contacts_[j]), off, normal)) return true;
        return false;
    }

    /// The face over which the mover passes without entering the piece, or through which its path enters it: the one
    /// whose plane it reaches last. -1: it is not over that face then.
    [[nodiscard]] int entered_face(const ShownFaces& faces) const {
        int best = -1;
        double last = -1, nearest = infinity;
        for (int f = 0; f < faces.count(); ++f) {
            const CoreFace plane = faces.plane(f);
            const double height = core_.height(plane);
            if (height < -step_) continue;
            const double approach = -dot(plane.normal, core_.path);
            const double reaches = approach > 0 ? std::min((height + step_) / approach, 1.0) : 1.0;
            if (reaches < last || (reaches == last && height >= nearest)) continue;
            if (reaches < 1 && !mover_.is_fast) continue;
            if (!over_face(core_, faces, f).later) continue;
            best = f;
            last = reaches;
            nearest = height;
        }
        return best;
    }

    /// The piece's own face at the point of a hidden contact that the mover can touch; -1: none.
    [[nodiscard]] int visible_face(const SeamContact& contact, const ShownFaces& faces) const {
        const auto index = static_cast<std::size_t>(&contact - contacts_.data());
        const ShownFaces hiding = faces_of(contacts_[static_cast<std::size_t>(contact.hidden_by)]);
        const CoreFace hiding_plane = hiding.plane(contact.hiding_face);
        int best = -1;
        double most = -2;
        for (int f = 0; f < faces.count(); ++f) {
            const CoreFace plane = faces.plane(f);
            if (above(plane, core_.pose.position) <= 0 || std::abs(above(plane, contact.point)) > step_ ||
                !faces.covers(f, contact.point, step_) || same_direction(plane.normal, contact.normal, same_normal) ||
                core_.height(plane) < -deepest_)
                continue;
            bool is_under = dot(plane.normal, contact.lean) > flat;
            for (int k = 0; k < faces.corner_count(f) && is_under; ++k)
                is_under = above(hiding_plane, faces.corner(f, k)) <= step_;
            const double facing = dot(plane.normal, contact.normal);
            if (is_under || facing <= most || is_covered(index, faces, f, contact.point)) continue;
            best = f;
            most = facing;
        }
        return best;
    }

    /// Whether a contact that is kept lies in the plane of a face.
    [[nodiscard]] bool has_contact_in(const CoreFace& plane) const {
        return std::any_of(contacts_.begin(), contacts_.end(),
                           [&](const SeamContact& c) { return c.is_live && c.hidden_by < 0 && lies_in(c, plane); });
    }
    [[nodiscard]] bool lies_in(const SeamContact& contact, const CoreFace& plane) const {
        return same_direction(contact.normal, plane.normal, flat) &&
               std::abs(above(plane, contact.point)) < 2 * step_ + std::max(0.0, -contact.separation);
    }

    void resolve_hidden(SeamContact& contact) {
        const ShownFaces faces = faces_of(contact);
        const int own = visible_face(contact, faces);
        if (own >= 0) {
            const CoreFace plane = faces.plane(own);
            const double bend = dot(plane.normal, contact.lean);
            const bool has_plane = bend < flat && has_contact_in(plane) && !over_face(core_, faces, own).now;
            if (bend > -flat && !has_plane && make_plane_contact(contact, faces, own)) return;
        }
        SeamContact& hiding = contacts_[static_cast<std::size_t>(contact.hidden_by)];
        const ShownFaces hiding_faces = faces_of(hiding);
        const bool is_free = !hiding.is_live || hiding.hidden_by >= 0;  // it keeps the mover out of nothing else
        const bool is_held = has_contact_in(hiding_faces.plane(contact.hiding_face)) ||
                             (is_free && make_plane_contact(hiding, hiding_faces, contact.hiding_face));
        if (&hiding != &contact && is_held) {
            end(contact);
        } else {
            contact.hidden_by = -1;  // nothing else keeps the mover out
        }
    }

    /// Makes the contacts with own faces, of those faces that the mover is over now or of the others.
    void resolve_passed_where(bool over_now) {
        for (SeamContact& contact : contacts_)
            if (contact.own_face >= 0 && over_face(core_, faces_of(contact), contact.own_face).now == over_now)
                resolve_passed(contact, over_now);
    }

    void resolve_passed(SeamContact& contact, bool over_now) {
        const ShownFaces faces = faces_of(contact);
        const int own = contact.own_face;
        if (!over_now && has_contact_in(faces.plane(own))) {
            end(contact);
        } else if (!make_plane_contact(contact, faces, own)) {
            set_place(contact);
        }
        contact.own_face = -1;
    }

    /// Adds to the contact of a fast mover with a face the points that come over the face on its path, or over its
    /// neighbours in the same plane: what hits a ramp with one end must not turn into it with the other.
    void widen(std::size_t index) {
        SeamContact& contact = contacts_[index];
        const ShownFaces faces = faces_of(contact);
        if (faces.count() == 0 || faces.is_half_space()) return;
        const int face = facing_face(faces, contact.normal);
        const CoreFace plane = faces.plane(face);
        if (!same_direction(plane.normal, contact.normal, nearly)) return;
        const auto in_plane = [&](const SeamContact& other) { return other.is_live && lies_in(other, plane); };
        const auto first = std::find_if(contacts_.begin(), contacts_.end(), in_plane);
        if (first != contacts_.begin() + static_cast<std::ptrdiff_t>(index)) return;
        const bool is_whole = comes_over_plane(plane);
        const bool is_alone = std::none_of(first + 1, contacts_.end(), in_plane);
        if (is_whole || is_alone) make_plane_contact(contact, faces, face, is_whole);
    }

    /// Whether all corners of the lowest feature above a plane are over pieces in that plane, or come over them.
    [[nodiscard]] bool comes_over_plane(const CoreFace& plane) const {
        std::array<bool, Feature::capacity> over{};
        int corners = 0;
        for (const SeamContact& contact : contacts_) {
            const ShownFaces faces = faces_of(contact);
            if (faces.count() == 0) continue;
            const int face = facing_face(faces, plane.normal);
            const CoreFace other = faces.plane(face);
            if (!same_direction(other.normal, plane.normal, flat)) continue;
            if (faces.is_half_space()) return true;
            if (std::abs(above(plane, faces.corner(face, 0))) > step_) continue;
            corners = mark_corners_over(core_, faces, face, over);
        }
        return std::all_of(over.begin(), over.begin() + corners, [](bool corner) { return corner; });
    }

    /// Replaces a contact by that with the plane of a face. Returns false when the mover does not come over the face in
    /// this step: then the contact is as before.
    bool make_plane_contact(SeamContact& contact, const ShownFaces& faces, int face, bool whole = false) {
        if (!over_face(core_, faces, face).later) return false;
        const Manifold manifold = plane_contact(core_, faces, face, {mover_.margin, step_, mover_.is_fast, whole});
        if (manifold.count == 0) return false;
        contact.manifold = manifold;
        set_place(contact);
        contact.changed = true;
        contact.hidden_by = contact.own_face = -1;
        return true;
    }

    static void end(SeamContact& contact) {
        contact.manifold.count = 0;
        contact.is_live = false;
        contact.changed = true;
    }

    const SeamMover& mover_;
    MovingCore core_;
    std::span<SeamContact> contacts_;
    double step_, deepest_;
};

}  // namespace

void correct_seams(const SeamMover& mover, std::span<SeamContact> contacts) { SeamPass(mover, contacts).run(); }

}  // namespace fase::narrow
