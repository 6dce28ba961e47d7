/// THE list of contenders for queries, and those of Fase.
#include <algorithm>

#include "bench/query_contender.hpp"
#include "fase/broad/any_structure.hpp"
#include "fase/broad/registry.hpp"
#include "fase/query/cast_ray.hpp"
#include "fase/query/ray_mesh.hpp"
#ifdef FASE_PEER_EMBREE
#include "bench/peers/embree.hpp"
#endif
#ifdef FASE_PEER_BOOST_RTREE
#include "bench/peers/boost_rtree.hpp"
#endif
#ifdef FASE_PEER_BULLET_DBVT
#include "bench/peers/bullet_dbvt.hpp"
#endif

namespace fase::bench {
namespace {

using broad::Proxy;

/// A structure of the registry.
class RegistryContender final : public QueryContender {
public:
    explicit RegistryContender(std::string_view name) : name_(name) {}

    [[nodiscard]] bool offers(QueryKind, const QueryScene&) const override { return true; }
    void build(const QueryScene& scene) override {
        scene_ = &scene;
        if (auto made = broad::AnyStructure::named(name_)) structure_ = *std::move(made);
        structure_.build(scene.boxes);
    }
    void move(std::span<const broad::Move> boxes) override {
        structure_.move(boxes);
        structure_.commit();
    }
    void rays(std::span<const Ray> rays, std::vector<query::Hit>& out) const override {
        const TriangleMesh& mesh = scene_->mesh;
        for (const Ray& ray : rays) {
            const auto hit = mesh.indices.empty()
                                 ? query::nearest_hit(structure_, ray)
                                 : query::nearest_hit(structure_, ray, [&](Proxy p, const Aabb&, float, float) {
                                       return distance_to_triangle(mesh, p, ray);
                                   });
            out.push_back(hit.value_or(query::Hit{}));
        }
    }
    void boxes(std::span<const Aabb> boxes, AnswerLists& out) const override {
        for (const Aabb& box : boxes) {
            structure_.overlapping(box, out.proxies);
            out.ends.push_back(out.proxies.size());
        }
    }
    void frusta(std::span<const Frustum> frusta, AnswerLists& out) const override {
        for (const Frustum& frustum : frusta) {
            structure_.cull(broad::FrustumRegion(frustum), [&](std::span<const Proxy> proxies, bool) {
                out.proxies.insert(out.proxies.end(), proxies.begin(), proxies.end());
            });
            out.ends.push_back(out.proxies.size());
        }
    }
    [[nodiscard]] std::string settings() const override { return "default"; }
    [[nodiscard]] std::size_t bytes() const override { return structure_.bytes(); }

private:
    std::string name_;
    const QueryScene* scene_ = nullptr;
    broad::AnyStructure structure_;
};

/// RayMesh: triangles in blocks of eight in the wide BVH.
class MeshContender final : public QueryContender {
public:
    [[nodiscard]] bool offers(QueryKind kind, const QueryScene& scene) const override {
        return kind == QueryKind::Rays && !scene.mesh.indices.empty();
    }
    void build(const QueryScene& scene) override {
        if (auto made = query::RayMesh::of(scene.mesh.positions, scene.mesh.indices)) mesh_ = *std::move(made);
    }
    void move(std::span<const broad::Move>) override {}
    void rays(std::span<const Ray> rays, std::vector<query::Hit>& out) const override {
        for (const Ray& ray : rays) out.push_back(mesh_.nearest_hit(ray).value_or(query::Hit{}));
    }
    void boxes(std::span<const Aabb>, AnswerLists&) const override {}
    void frusta(std::span<const Frustum>, AnswerLists&) const override {}
    [[nodiscard]] bool rounds_differently(const QueryScene&) const override { return true; }
    [[nodiscard]] std::string settings() const override { return "wide_bvh over blocks of 8 triangles, watertight"; }
    [[nodiscard]] std::size_t bytes() const override { return mesh_.bytes(); }

private:
    query::RayMesh mesh_;
};

/// Copies precomputed answers: a lower bound for the time of any frustum query.
class CopyContender final : public QueryContender {
public:
    [[nodiscard]] bool offers(QueryKind kind, const QueryScene& scene) const override {
        return kind == QueryKind::Frusta && !scene.moves();
    }
    void build(const QueryScene& scene) override {
        RegistryContender tree("wide_bvh");
        tree.build(scene);
        answers_.clear();
        tree.frusta(scene.queries.frusta, answers_);
        first_ = scene.queries.frusta.data();
    }
    void move(std::span<const broad::Move>) override {}
    void rays(std::span<const Ray>, std::vector<query::Hit>&) const override {}
    void boxes(std::span<const Aabb>, AnswerLists&) const override {}
    /// Only for frusta of the scene that it was built with.
    void frusta(std::span<const Frustum> frusta, AnswerLists& out) const override {
        for (const Frustum& frustum : frusta) {
            const auto index = static_cast<std::size_t>(&frustum - first_);
            const auto begin = answers_.proxies.begin();
            out.proxies.insert(out.proxies.end(),
                               begin + static_cast<std::ptrdiff_t>(index == 0 ? 0 : answers_.ends[index - 1]),
                               begin + static_cast<std::ptrdiff_t>(answers_.ends[index]));
            out.ends.push_back(out.proxies.size());
        }
    }
    [[nodiscard]] std::string settings() const override { return "lower bound: copies ready ids"; }

private:
    AnswerLists answers_;
    const Frustum* first_ = nullptr;
};

template <class Contender> std::unique_ptr<QueryContender> make(std::string_view name) {
    if constexpr (std::is_constructible_v<Contender, std::string_view>) {
        return std::make_unique<Contender>(name);
    } else {
        return std::make_unique<Contender>();
    }
}

std::vector<QueryContenderInfo> make_list() {
    std::vector<QueryContenderInfo> list;
    broad::for_each_structure([&]<broad::Structure S>() {
        list.push_back({std::string(S::info.name), make<RegistryContender>});
    });
    list.push_back({"ray_mesh", make<MeshContender>});
    list.push_back({"copy", make<CopyContender>});
#ifdef FASE_PEER_EMBREE
    list.push_back({"embree", make_embree});
#endif
#ifdef FASE_PEER_BOOST_RTREE
    list.push_back({"boost_rtree", make_boost_rtree});
#endif
#ifdef FASE_PEER_BULLET_DBVT
    list.push_back({"bullet_dbvt", make_bullet_dbvt});
#endif
    return list;
}

}  // namespace

std::span<const QueryContenderInfo> query_contenders() {
    static const std::vector<QueryContenderInfo> list = make_list();
    return list;
}

float distance_to_triangle(const TriangleMesh& mesh, Proxy triangle, const Ray& ray) {
    const auto corner = [&](std::size_t k) { return to_double(mesh.positions[mesh.indices[3 * triangle + k]]); };
    const Vec3d a = corner(0), ab = corner(1) - a, ac = corner(2) - a, d = to_double(ray.direction);
    const Vec3d p = cross(d, ac);
    const double det = dot(ab, p);
    if (det == 0) return broad::infinite_distance;
    const double inverse = 1 / det;
    const Vec3d from_a = ray.origin - a;
    const double u = dot(from_a, p) * inverse;
    if (u < 0 || u > 1) return broad::infinite_distance;
    const Vec3d q = cross(from_a, ab);
    const double v = dot(d, q) * inverse;
    if (v < 0 || u + v > 1) return broad::infinite_distance;
    const double t = dot(ac, q) * inverse;
    return t >= 0 ? static_cast<float>(t) : broad::infinite_distance;
}

}  // namespace fase::bench
