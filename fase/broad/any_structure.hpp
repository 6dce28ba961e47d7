#pragma once
/// A structure chosen by name at run time.
#include <concepts>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fase/broad/cull.hpp"
#include "fase/broad/stats.hpp"
#include "fase/broad/structure.hpp"
#include "fase/core/detail/function_ref.hpp"
#include "fase/core/result.hpp"

namespace fase::broad {

/// A region for which AnyStructure has no precompiled traversal. Overload resolution prefers the template for a lambda
/// over a FunctionRef; without this constraint it would use the generic traversal for every region.
template <class R>
concept OtherRegion =
    Region<R> && !std::same_as<R, BoxRegion> && !std::same_as<R, FrustumRegion> && !std::same_as<R, Everything>;

/// One structure of the registry behind batch calls: one dispatch per call, none per box. The contracts are those of
/// the concept Structure. The default is an empty default structure. Copies are deep.
class AnyStructure {
public:
    /// Returns the structure with this name, empty; for an unknown name BadArgument with all known names.
    [[nodiscard]] static Result<AnyStructure> named(std::string_view name);
    /// All names, "brute_force, sweep_and_prune, …", for help and error texts.
    [[nodiscard]] static std::string names();

    AnyStructure();
    AnyStructure(const AnyStructure& other);
    AnyStructure& operator=(const AnyStructure& other);
    /// A structure that was moved from may only be destroyed or assigned to.
    AnyStructure(AnyStructure&& other) noexcept;
    AnyStructure& operator=(AnyStructure&& other) noexcept;
    ~AnyStructure();

    void insert(std::span<const Move> boxes);
    /// Moves stored boxes; each proxy at most once.
    void move(std::span<const Move> boxes) { move(nullptr, boxes); }
    /// The same; structures with parallel moves use several threads.
    void move(TaskRunner& tasks, std::span<const Move> boxes) { move(&tasks, boxes); }
    /// The same for boxes that are stored in an array by proxy.
    void insert(std::span<const Proxy> proxies, std::span<const Aabb> by_proxy);
    void move(std::span<const Proxy> proxies, std::span<const Aabb> by_proxy) { move(nullptr, proxies, by_proxy); }
    void move(TaskRunner& tasks, std::span<const Proxy> proxies, std::span<const Aabb> by_proxy) {
        move(&tasks, proxies, by_proxy);
    }
    void erase(std::span<const Proxy> proxies);
    void set_awake(std::span<const Proxy> proxies, bool awake);
    void clear();
    /// Replaces all stored boxes by these, all awake, and commits.
    void build(std::span<const Move> boxes);
    /// The same for boxes that seldom move; stored boxes and results are the same.
    void build_static(std::span<const Move> boxes);
    /// Moves all boxes into `other`, which must be empty, and becomes it. Keeps the awake flags. Commits. O(n log n).
    void convert_to(AnyStructure other);
    /// Applies pending changes. Call after changes and before any const function.
    void commit();
    /// The same; structures with a parallel commit use several threads. The result is the same.
    void commit(TaskRunner& tasks);

    /// Appends each overlapping pair of stored boxes once, smaller proxy first. The order depends on the structure;
    /// sort the pairs for a fixed order.
    void find_pairs(std::vector<Pair>& out) const;
    void find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const;
    /// Appends each pair with at least one awake box once, as find_pairs() does.
    void find_awake_pairs(std::vector<Pair>& out) const;
    /// Appends the pairs of each query box with stored boxes; see broad::find_pairs_of() for the meaning of `is_query`.
    /// With tasks, many query boxes that are stored here cost little more than find_pairs().
    void find_pairs_of(std::span<const Move> query_boxes, std::vector<Pair>& out) const;
    void find_pairs_of(std::span<const Move> query_boxes, std::span<const std::uint8_t> is_query,
                       std::vector<Pair>& out) const;
    void find_pairs_of(TaskRunner& tasks, std::span<const Move> query_boxes, std::span<const std::uint8_t> is_query,
                       std::vector<Pair>& out) const;
    /// Appends each overlapping pair of a box stored here and one stored in `other`, which may be a structure of
    /// another type; cheapest for two trees of the same type. Both share one numbering of proxies.
    void find_pairs_between(const AnyStructure& other, std::vector<Pair>& out) const;
    /// The same pairs; the boxes of the smaller structure are divided among threads.
    void find_pairs_between(TaskRunner& tasks, const AnyStructure& other, std::vector<Pair>& out) const;
    /// Appends the proxies of the stored boxes that overlap `box`, in the structure's order.
    void overlapping(const Aabb& box, std::vector<Proxy>& out) const;
    /// As Structure::traverse(): `visit(proxy, box)` returns false to stop. Compiled once for these regions: one
    /// indirect call per visited box, none per node.
    void traverse(const BoxRegion& region, FunctionRef<bool(Proxy, const Aabb&)> visit) const;
    void traverse(const FrustumRegion& region, FunctionRef<bool(Proxy, const Aabb&)> visit) const;
    void traverse(const Everything& region, FunctionRef<bool(Proxy, const Aabb&)> visit) const;
    /// For any other region: one more indirect call per node.
    template <OtherRegion R, class Visit> void traverse(const R& region, Visit&& visit) const {
        const auto touches = [&region](const Aabb& box) { return region.touches(box); };
        traverse_any(AnyRegion(touches, region.bounds()), visit);
    }
    /// As broad::nearest_first(), compiled once: one indirect call per visited box, none per node.
    void nearest_first(const RayMeasure& measure, float limit,
                       FunctionRef<float(Proxy, const Aabb&, float)> visit) const;
    void nearest_first(const PointMeasure& measure, float limit,
                       FunctionRef<float(Proxy, const Aabb&, float)> visit) const;
    /// As broad::cull(), compiled once.
    void cull(const FrustumRegion& region, FunctionRef<void(std::span<const Proxy>, bool)> take) const;
    /// As Structure::for_each_leaf().
    void for_each_leaf(FunctionRef<void(const Leaf&)> visit) const;

    [[nodiscard]] StructureInfo info() const;
    [[nodiscard]] StructureStats stats() const;
    [[nodiscard]] bool is_awake(Proxy p) const;
    [[nodiscard]] std::size_t size() const;
    /// Memory in use, spare capacity included.
    [[nodiscard]] std::size_t bytes() const;
    /// Describes the first broken invariant; "" when none is broken. O(n).
    [[nodiscard]] std::string broken_invariant() const;
    /// Appends the boxes of the structure's cells; nothing for structures without cells.
    void cells(std::vector<DrawnCell>& out) const;

private:
    struct Held;  // a variant over the registry, which users of this header do not parse
    std::unique_ptr<Held> held_;

    void move(TaskRunner* tasks, std::span<const Move> boxes);
    void move(TaskRunner* tasks, std::span<const Proxy> proxies, std::span<const Aabb> by_proxy);

    /// A type-erased region.
    class AnyRegion {
    public:
        AnyRegion(FunctionRef<bool(const Aabb&)> touches, const Aabb& bounds) : touches_(touches), bounds_(bounds) {}
        [[nodiscard]] bool touches(const Aabb& box) const { return touches_(box); }
        [[nodiscard]] Aabb bounds() const { return bounds_; }

    private:
        FunctionRef<bool(const Aabb&)> touches_;
        Aabb bounds_;
    };
    void traverse_any(const AnyRegion& region, FunctionRef<bool(Proxy, const Aabb&)> visit) const;
};

}  // namespace fase::broad
