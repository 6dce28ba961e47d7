/// The table of all pairs of shapes. A new special pair needs one include here only.
#include "fase/narrow/dispatch.hpp"

#include <array>
#include <concepts>
#include <type_traits>
#include <variant>

#include "fase/narrow/collide_mesh.hpp"
#include "fase/narrow/detail/general.hpp"
#include "fase/narrow/pairs/collide_box_box.hpp"
#include "fase/narrow/pairs/collide_box_capsule.hpp"
#include "fase/narrow/pairs/collide_box_convex_hull.hpp"
#include "fase/narrow/pairs/collide_box_half_space.hpp"
#include "fase/narrow/pairs/collide_capsule_capsule.hpp"
#include "fase/narrow/pairs/collide_capsule_convex_hull.hpp"
#include "fase/narrow/pairs/collide_capsule_half_space.hpp"
#include "fase/narrow/pairs/collide_convex_hull_convex_hull.hpp"
#include "fase/narrow/pairs/collide_convex_hull_half_space.hpp"
#include "fase/narrow/pairs/collide_cylinder_half_space.hpp"
#include "fase/narrow/pairs/collide_sphere_box.hpp"
#include "fase/narrow/pairs/collide_sphere_capsule.hpp"
#include "fase/narrow/pairs/collide_sphere_convex_hull.hpp"
#include "fase/narrow/pairs/collide_sphere_cylinder.hpp"
#include "fase/narrow/pairs/collide_sphere_half_space.hpp"
#include "fase/narrow/pairs/collide_sphere_sphere.hpp"

namespace fase::narrow {
namespace {

/// Whether there is a function of exactly this signature, without conversions.
template <class A, class B>
concept HasSpecial = requires {
    static_cast<Manifold (*)(const A&, const B&, const LocalPose&, float)>(&collide);
};

/// The contact of a mesh with a convex shape: the deepest of its manifolds.
template <ConvexShape B> Manifold collide_deepest(const Mesh& a, const B& b, const LocalPose& b_in_a, float margin) {
    MeshContacts contacts;
    Manifold best;
    float nearest = 0;
    for (const MeshManifold& m : contacts.find(a, Shape(b), to_double(b_in_a), margin)) {
        for (int i = 0; i < m.manifold.count; ++i) {
            const float separation = m.manifold.points[static_cast<std::size_t>(i)].separation;
            if (best.count != 0 && !(separation < nearest)) continue;
            nearest = separation;
            best = m.manifold;
        }
    }
    for (int i = 0; i < best.count; ++i) best.points[static_cast<std::size_t>(i)].position += b_in_a.position;
    return best;
}

/// Calls the special function for (A, B), or that for (B, A) with a flipped result; else the general function.
template <class A, class B> Manifold collide_best(const A& a, const B& b, const LocalPose& b_in_a, float margin) {
    if constexpr (HasSpecial<A, B>) {
        return collide(a, b, b_in_a, margin);
    } else if constexpr (HasSpecial<B, A>) {
        return flipped(collide(b, a, inverse(b_in_a), margin), b_in_a);
    } else if constexpr (std::is_same_v<A, Mesh> && ConvexShape<B>) {
        return collide_deepest(a, b, b_in_a, margin);
    } else if constexpr (std::is_same_v<B, Mesh> && ConvexShape<A>) {
        return flipped(collide_deepest(b, a, inverse(b_in_a), margin), b_in_a);
    } else {
        return collide_general(a, b, b_in_a, margin);
    }
}

/// Runs a batch of jobs of kinds A and B: one indirect call per batch, none per pair.
template <class A, class B> void run(std::span<const CollideJob> batch) {
    for (const CollideJob& job : batch) {
        *job.out = collide_best(*std::get_if<A>(job.a), *std::get_if<B>(job.b), job.b_in_a, job.margin);
    }
}

struct Entry {
    void (*run)(std::span<const CollideJob>);
    bool special;
};

constexpr std::size_t kinds = AllShapes::count;
using Row = std::array<Entry, kinds>;

template <class... S> constexpr std::array<Row, kinds> make_table(ShapeList<S...>) {
    constexpr auto row = []<class A>(std::type_identity<A>) {
        return Row{Entry{&run<A, S>, HasSpecial<A, S> || HasSpecial<S, A>}...};
    };
    return {row(std::type_identity<S>{})...};
}

constexpr std::array<Row, kinds> table = make_table(AllShapes{});

}  // namespace

void collide_batch(std::span<const CollideJob> jobs) {
    std::size_t begin = 0;
    while (begin < jobs.size()) {
        const std::size_t a = jobs[begin].a->index(), b = jobs[begin].b->index();
        std::size_t end = begin + 1;
        while (end < jobs.size() && jobs[end].a->index() == a && jobs[end].b->index() == b) ++end;
        table[a][b].run(jobs.subspan(begin, end - begin));
        begin = end;
    }
}

Manifold collide(const Shape& a, const Shape& b, const LocalPose& b_in_a, float margin) {
    Manifold manifold;
    const CollideJob job{&a, &b, b_in_a, margin, &manifold};
    table[a.index()][b.index()].run({&job, 1});
    return manifold;
}

bool has_special_pair(std::size_t kind_a, std::size_t kind_b) {
    return kind_a < kinds && kind_b < kinds && table[kind_a][kind_b].special;
}

}  // namespace fase::narrow
