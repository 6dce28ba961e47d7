#pragma once
/// What every broad-phase structure offers, checked by the compiler.
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

/// Index of a box, chosen by the caller, small numbers from 0 (arrays are sized by the largest); valid from insert() to
/// erase().
using Proxy = std::uint32_t;

/// Two overlapping proxies, a < b. Without defaults, so that vectors of pairs are copied and set in whole blocks.
struct Pair {
    Proxy a, b;
    friend constexpr auto operator<=>(Pair, Pair) = default;
};
constexpr Pair ordered_pair(Proxy p, Proxy q) { return p < q ? Pair{p, q} : Pair{q, p}; }

/// A proxy and its box, for calls that hand over many at once.
struct Move {
    Proxy proxy = 0;
    Aabb box;
};

/// What a person is told about a structure: in `--help`, in the tables of the benchmark, in the docs.
struct StructureInfo {
    std::string_view name;    ///< unique; the file's name: "dynamic_bvh"; the value of `--structure`
    std::string_view idea;    ///< one sentence
    std::string_view source;  ///< author, year, title; or "folklore"
};

/// A leaf of a tree, a cell of a grid, or all there is of a list, and the boxes in it.
struct Leaf {
    Aabb cell;                       ///< what the structure knows of where its boxes are; everything for a list
    std::span<const Proxy> proxies;  ///< valid for the length of the call
    int depth = 0;                   ///< the root's is 0
};

/// A set of boxes with names. Changes may be put off to commit(); after it, every const function is safe to call from
/// any number of threads. insert() of a stored proxy and move()/erase()/set_awake() of an unknown one are broken
/// contracts.
///
/// A box is awake when it is inserted; set_awake() changes that, and takes effect at commit() as the rest. Being awake
/// matters to find_awake_pairs() alone: a pair of two that rest is of no interest to it.
///
/// traverse() calls `visit(proxy, box)` once for each stored box that touches the region, in an order of the
/// structure's own that depends on the calls so far alone; a `visit` that returns false stops it.
///
/// for_each_leaf() calls `visit(leaf)` for each leaf that holds a box. Each stored box is in one leaf or in several.
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
    { c.broken_invariant() } -> std::same_as<std::string>;  // "" when all is well
};

/// A structure that finds all its pairs faster than one query a box can: appends each pair once, a < b, in any order.
template <class S>
concept FindsOwnPairs = Structure<S> && requires(const S& c, std::vector<Pair>& out) {
    c.find_pairs(out);
};

/// A structure whose nodes know whether anything below is awake: appends each pair of which one is awake once, a < b,
/// and passes over branches in which all rest.
template <class S>
concept HoldsAwake = Structure<S> && requires(const S& c, std::vector<Pair>& out) {
    c.find_awake_pairs(out);
};

/// A structure that is best filled in one go: build() replaces all that is stored (all awake), and commits.
template <class S>
concept BuildsAtOnce = Structure<S> && requires(S s, std::span<const Move> boxes) {
    s.build(boxes);
};

/// A structure that moves many boxes, each at most once, faster than one after the other; with tasks, by several
/// threads. What is stored is no different.
template <class S>
concept MovesMany = Structure<S> && requires(S s, TaskRunner* tasks, std::span<const Move> moves,
                                             std::span<const Proxy> proxies, std::span<const Aabb> by_proxy) {
    s.move(tasks, moves);
    s.move(tasks, proxies, by_proxy);
};

/// A structure that likes to know that boxes will seldom move: build() otherwise.
template <class S>
concept BuildsStill = Structure<S> && requires(S s, std::span<const Move> boxes) {
    s.build_still(boxes);
};

/// A structure that goes through near boxes first; see broad::nearest_first().
template <class S>
concept BestFirst = Structure<S> &&
    requires(const S& c, const RayMeasure& measure, float (*visit)(Proxy, const Aabb&, float)) {
    c.nearest_first(measure, 1.0f, visit);
};

/// A structure that takes or leaves whole branches at once; see broad::cull().
template <class S>
concept TakesWhole = Structure<S> &&
    requires(const S& c, const FrustumRegion& region, void (*take)(std::span<const Proxy>, bool)) {
    c.cull(region, take);
};

/// A structure whose cells can be drawn: appends the boxes of its nodes, with their depth.
struct DrawnCell {
    Aabb box;
    int depth = 0;
};
template <class S>
concept Drawable = Structure<S> && requires(const S& c, std::vector<DrawnCell>& out) {
    c.cells(out);
};

}  // namespace fase::broad
