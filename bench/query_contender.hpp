#pragma once
/// What `fase bench queries` measures: a set of things goes in, questions are answered.
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/query_scene.hpp"
#include "fase/query/hit.hpp"

namespace fase::bench {

enum class QueryKind { Rays, Boxes, Frusta };
inline constexpr QueryKind all_query_kinds[]{QueryKind::Rays, QueryKind::Boxes, QueryKind::Frusta};
[[nodiscard]] constexpr std::string_view name_of(QueryKind kind) {
    return kind == QueryKind::Rays ? "rays" : kind == QueryKind::Boxes ? "boxes" : "frusta";
}

/// Answers to boxes or frusta, one after the other.
struct Lists {
    std::vector<broad::Proxy> proxies;  ///< of all answers
    std::vector<std::size_t> ends;      ///< of each answer, in `proxies`
    void clear() {
        proxies.clear();
        ends.clear();
    }
};

/// A structure, ours or another's.
class QueryContender {
public:
    virtual ~QueryContender() = default;
    /// Whether it has an answer to this kind for this scene.
    [[nodiscard]] virtual bool offers(QueryKind kind, const QueryScene& scene) const = 0;
    /// Forgets what it holds and takes the scene, as it is in frame 0; the scene stays alive.
    virtual void build(const QueryScene& scene) = 0;
    /// All boxes are elsewhere.
    virtual void move(std::span<const broad::Move> boxes) = 0;
    /// Appends the nearest thing on each ray, or a hit that met nothing.
    virtual void rays(std::span<const Ray> rays, std::vector<query::Hit>& out) const = 0;
    virtual void boxes(std::span<const Aabb> boxes, Lists& out) const = 0;
    virtual void frusta(std::span<const Frustum> frusta, Lists& out) const = 0;
    /// Its ray tests round in their own way: distances are compared within a ten-thousandth.
    [[nodiscard]] virtual bool rounds_its_own_way(const QueryScene&) const { return false; }
    /// How it is set, in a few words for tables.
    [[nodiscard]] virtual std::string settings() const = 0;
    /// Memory in use; 0: it does not tell.
    [[nodiscard]] virtual std::size_t bytes() const { return 0; }
};

struct QueryContenderInfo {
    std::string name;
    std::unique_ptr<QueryContender> (*make)(std::string_view name);
};

/// THE list: each structure of the registry, meshes for rays, the floor for cameras, then each peer that was found.
[[nodiscard]] std::span<const QueryContenderInfo> query_contenders();

/// Where a ray meets a triangle of the scene's mesh, metres; beyond: it does not. In double, both sides. Source:
/// Möller, Trumbore 1997, Fast, minimum storage ray/triangle intersection.
[[nodiscard]] float distance_to_triangle(const TriangleMesh& mesh, broad::Proxy triangle, const Ray& ray);

}  // namespace fase::bench
