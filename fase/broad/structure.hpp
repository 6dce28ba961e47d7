#pragma once
/// The concept of a broad-phase structure and its optional refinements, checked by the compiler.
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fase/broad/measure.hpp"
#include "fase/broad/region.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// Index of a box, chosen by the caller: small numbers from 0, as arrays are sized by the largest. Valid from insert()
/// to erase().
using Proxy = std::uint32_t;

/// Two overlapping proxies, a < b. Has no default values, so that vectors of pairs are copied and set block by block.
struct Pair {
    Proxy a, b;
    friend constexpr auto operator<=>(Pair, Pair) = default;
};
constexpr Pair ordered_pair(Proxy p, Proxy q) { return p < q ? Pair{p, q} : Pair{q, p}; }

/// A proxy and its box, for calls that take many boxes.
struct Move {
    Proxy proxy = 0;
    Aabb box;
};

/// Describes a structure in `--help`, in the benchmark tables and in the docs.
struct StructureInfo {
    std::string_view name;    ///< unique; the file's name: "dynamic_bvh"; the value of `--structure`
    std::string_view idea;    ///< one sentence
    std::string_view source;  ///< author, year, title; or "folklore"
};

/// A leaf of a tree, a cell of a grid, or a complete list, with the boxes in it.
struct Leaf {
    Aabb cell;                       ///< bounds of its boxes as the structure knows them; everything for a list
    std::span<const Proxy> proxies;  ///< valid during the call
    int depth = 0;                   ///< 0 for the root
};

/// A set of boxes identified by proxies. A structure may defer changes to commit(); after it, every const function is
/// safe to call from any number of threads. insert() of a stored proxy and move(), erase() or set_awake() of an unknown
/// one violate the contract.
///
/// An inserted box is awake. set_awake() changes that; like all changes it takes effect at commit(). Only
/// find_awake_pairs() uses it: it leaves out pairs of two sleeping boxes.
///
/// traverse() calls `visit(proxy, box)` once for each stored box that touches the region. The order is specific to the
/// structure and depends only on the previous calls. A `visit` that returns false stops the traversal.
///
/// for_each_leaf() calls `visit(leaf)` for each leaf that holds a box. Each stored box is in one or more leaves.
template <class S>
concept Structure = std::default_initializable<S> && std::movable<S> &&
    requires(S s, const S& c, Proxy p, const Aabb& box, const BoxRegion& region, bool (*visit)(Proxy, const Aabb&),
             void (*visit_leaf)(const Leaf&)) {
    { S::info } -> std::convertible_to<StructureInfo>;
    s.insert(p, box);
    s.move(p, box);
    s.erase(p);
    s.set_awake(p, true);
    s.clear();
    s.commit();
    c.traverse(region, visit);
    c.for_each_leaf(visit_leaf);
    { c.is_awake(p) } -> std::same_as<bool>;
    { c.size() } -> std::same_as<std::size_t>;
    { c.nodes() } -> std::same_as<std::size_t>;  // inner nodes, leaves and empty children; 1 for a list
    { c.bytes() } -> std::same_as<std::size_t>;
    { c.broken_invariant() } -> std::same_as<std::string>;  // "" when none is broken
};

/// Finds all pairs faster than one query per box: appends each pair once, a < b, in any order.
template <class S>
concept FindsOwnPairs = Structure<S> && requires(const S& c, std::vector<Pair>& out) {
    c.find_pairs(out);
};

/// Stores in each node whether anything below is awake. Appends each pair with an awake box once, a < b, and skips
/// branches in which all boxes sleep.
template <class S>
concept FindsAwakePairs = Structure<S> && requires(const S& c, std::vector<Pair>& out) {
    c.find_awake_pairs(out);
};

/// Offers a bulk build: build() replaces all stored boxes by new ones, all awake, and commits.
template <class S>
concept BuildsInBulk = Structure<S> && requires(S s, std::span<const Move> boxes) {
    s.build(boxes);
};

/// Moves many boxes, each at most once, faster than sequential calls; with tasks, on several threads. The stored boxes
/// are the same.
template <class S>
concept MovesInBulk = Structure<S> && requires(S s, TaskRunner* tasks, std::span<const Move> moves,
                                               std::span<const Proxy> proxies, std::span<const Aabb> by_proxy) {
    s.move(tasks, moves);
    s.move(tasks, proxies, by_proxy);
};

/// Offers a bulk build for boxes that seldom move. Without this refinement, build() is used.
template <class S>
concept BuildsStatic = Structure<S> && requires(S s, std::span<const Move> boxes) {
    s.build_static(boxes);
};

/// Visits near boxes first; see broad::nearest_first().
template <class S>
concept BestFirst = Structure<S> &&
    requires(const S& c, const RayMeasure& measure, float (*visit)(Proxy, const Aabb&, float)) {
    c.nearest_first(measure, 1.0f, visit);
};

/// Accepts or rejects complete branches with one test; see broad::cull().
template <class S>
concept CullsBranches = Structure<S> &&
    requires(const S& c, const FrustumRegion& region, void (*take)(std::span<const Proxy>, bool)) {
    c.cull(region, take);
};

/// Box and depth of a node, for pictures of a structure.
struct DrawnCell {
    Aabb box;
    int depth = 0;
};
/// Appends the boxes of its nodes with their depths, for pictures.
template <class S>
concept Drawable = Structure<S> && requires(const S& c, std::vector<DrawnCell>& out) {
    c.cells(out);
};

}  // namespace fase::broad
