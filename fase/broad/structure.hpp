#pragma once
/// What every broad-phase structure offers, checked by the compiler.
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fase/broad/region.hpp"

namespace fase::broad {

/// Index of a box, chosen by the caller, small numbers from 0 (arrays are sized by the largest); valid from insert() to
/// erase().
using Proxy = std::uint32_t;

/// Two overlapping proxies, a < b.
struct Pair {
    Proxy a = 0, b = 0;
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

/// A set of boxes with names. Changes may be put off to commit(); after it, every const function is safe to call from
/// any number of threads. insert() of a stored proxy and move()/erase() of an unknown one are broken contracts.
/// traverse() calls `visit(proxy, box)` once for each stored box that touches the region, in an order of the
/// structure's own that depends on the calls so far alone; a `visit` that returns false stops it.
template <class S>
concept Structure = std::default_initializable<S> && std::movable<S> &&
    requires(S s, const S& c, Proxy p, const Aabb& box, const BoxRegion& region, bool (*visit)(Proxy, const Aabb&)) {
    { S::info } -> std::convertible_to<StructureInfo>;
    s.insert(p, box);
    s.move(p, box);
    s.erase(p);
    s.clear();
    s.commit();
    c.traverse(region, visit);
    { c.size() } -> std::same_as<std::size_t>;
    { c.bytes() } -> std::same_as<std::size_t>;
    { c.broken_invariant() } -> std::same_as<std::string>;  // "" when all is well
};

/// A structure that finds all its pairs faster than one query a box can: appends each pair once, a < b, in any order.
template <class S>
concept FindsOwnPairs = Structure<S> && requires(const S& c, std::vector<Pair>& out) {
    c.find_pairs(out);
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
