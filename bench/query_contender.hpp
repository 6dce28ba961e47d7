#pragma once
/// The interface of a structure that `fase bench queries` measures: build it from a scene, then answer queries.
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

/// The answers to several box or frustum queries, concatenated.
struct AnswerLists {
    std::vector<broad::Proxy> proxies;  ///< all answers
    std::vector<std::size_t> ends;      ///< end of each answer in `proxies`
    void clear() {
        proxies.clear();
        ends.clear();
    }
};

/// A structure of Fase or a peer.
class QueryContender {
public:
    virtual ~QueryContender() = default;
    /// Whether it can answer this kind of query on this scene.
    [[nodiscard]] virtual bool offers(QueryKind kind, const QueryScene& scene) const = 0;
    /// Replaces the contents by frame 0 of the scene. The scene must outlive the contender.
    virtual void build(const QueryScene& scene) = 0;
    /// Moves all boxes.
    virtual void move(std::span<const broad::Move> boxes) = 0;
    /// Appends the nearest hit of each ray; a hit with `is_hit() == false` where there is none.
    virtual void rays(std::span<const Ray> rays, std::vector<query::Hit>& out) const = 0;
    /// Appends the items that overlap each box.
    virtual void boxes(std::span<const Aabb> boxes, AnswerLists& out) const = 0;
    /// Appends the items that touch each frustum.
    virtual void frusta(std::span<const Frustum> frusta, AnswerLists& out) const = 0;
    /// Whether its ray tests round differently; then distances are compared with a tolerance of 1e-4.
    [[nodiscard]] virtual bool rounds_differently(const QueryScene&) const { return false; }
    /// The settings in a few words, for tables.
    [[nodiscard]] virtual std::string settings() const = 0;
    /// Memory in use; 0: unknown.
    [[nodiscard]] virtual std::size_t bytes() const { return 0; }
};

struct QueryContenderInfo {
    std::string name;
    std::unique_ptr<QueryContender> (*make)(std::string_view name);
};

/// THE list: each structure of the registry, RayMesh for rays, a lower bound for frusta, then each peer found.
[[nodiscard]] std::span<const QueryContenderInfo> query_contenders();

/// Returns the distance along a ray to a triangle of the mesh, in metres; infinite_distance: no hit. Double precision,
/// two-sided. Source: Möller and Trumbore 1997, Fast, minimum storage ray/triangle intersection.
[[nodiscard]] float distance_to_triangle(const TriangleMesh& mesh, broad::Proxy triangle, const Ray& ray);

}  // namespace fase::bench
