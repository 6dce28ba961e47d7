#pragma once
/// A structure chosen at run time by its name.
#include <span>
#include <variant>

#include "fase/broad/cull.hpp"
#include "fase/broad/registry.hpp"
#include "fase/broad/stats.hpp"
#include "fase/core/detail/function_ref.hpp"
#include "fase/core/result.hpp"

namespace fase::broad {

/// A region for which AnyStructure has no walk of its own. (A lambda fits a template better than a FunctionRef: without
/// the requirement the general walk would be taken for every region.)
template <class R>
concept OtherRegion =
    Region<R> && !std::same_as<R, BoxRegion> && !std::same_as<R, FrustumRegion> && !std::same_as<R, Everything>;

/// One structure of the registry behind calls that hand over many boxes at once: one branch a call, none a box. The
/// contracts are those of the concept Structure; default: the default structure, empty. Copies are deep.
class AnyStructure {
public:
    /// The structure with that name, empty. BadArgument with all names when there is none.
    [[nodiscard]] static Result<AnyStructure> named(std::string_view name);
    /// "brute_force, dynamic_bvh, …": for help and error texts.
    [[nodiscard]] static std::string names();

    AnyStructure();

    void insert(std::span<const Move> boxes);
    /// No proxy twice.
    void move(std::span<const Move> boxes) { move(nullptr, boxes); }
    /// The same, shared among threads by structures that can.
    void move(TaskRunner& tasks, std::span<const Move> boxes) { move(&tasks, boxes); }
    /// The same for boxes that stand in a list by proxy.
    void insert(std::span<const Proxy> proxies, std::span<const Aabb> by_proxy);
    void move(std::span<const Proxy> proxies, std::span<const Aabb> by_proxy) { move(nullptr, proxies, by_proxy); }
    void move(TaskRunner& tasks, std::span<const Proxy> proxies, std::span<const Aabb> by_proxy) {
        move(&tasks, proxies, by_proxy);
    }
    void erase(std::span<const Proxy> proxies);
    void set_awake(std::span<const Proxy> proxies, bool awake);
    void clear();
    /// Replaces all that is stored by boxes that are awake, and commits.
    void build(std::span<const Move> boxes);
    /// The same for boxes that are likely to stay where they are; what is stored and found is no different.
    void build_still(std::span<const Move> boxes);
    /// Puts all that is stored into `other`, which is empty, and takes its place; awake or not as it is. Commits.
    void convert_to(AnyStructure other);
    /// To be called after changes and before anything const.
    void commit();
    /// The same, shared among threads by structures that can; it makes no difference to what is stored.
    void commit(TaskRunner& tasks);

    /// Appends each pair of stored boxes once, smaller proxy first; sort them for an order that does not depend on the
    /// structure.
    void find_pairs(std::vector<Pair>& out) const;
    void find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const;
    /// Appends each pair of which one box is awake once, as find_pairs() does.
    void find_awake_pairs(std::vector<Pair>& out) const;
    /// Appends for each asker its pairs with stored boxes; see broad::find_pairs_of for what `is_query` does. With
    /// tasks, many askers that are stored here cost little more than find_pairs().
    void find_pairs_of(std::span<const Move> query_boxes, std::vector<Pair>& out) const;
    void find_pairs_of(std::span<const Move> query_boxes, std::span<const std::uint8_t> is_query,
                       std::vector<Pair>& out) const;
    void find_pairs_of(TaskRunner& tasks, std::span<const Move> query_boxes, std::span<const std::uint8_t> is_query,
                       std::vector<Pair>& out) const;
    /// Appends each pair of a box stored here and one stored in `other` (which may be of another kind); cheapest for
    /// two trees of one kind. Proxies of both count as one numbering.
    void find_pairs_between(const AnyStructure& other, std::vector<Pair>& out) const;
    /// The same pairs; several threads share out the boxes of the one that has fewer.
    void find_pairs_between(TaskRunner& tasks, const AnyStructure& other, std::vector<Pair>& out) const;
    /// Appends the proxies of the stored boxes that overlap `box`, in the structure's own order.
    void overlapping(const Aabb& box, std::vector<Proxy>& out) const;
    /// As Structure::traverse: `visit(proxy, box)` returns false to stop. Compiled once for these regions: an indirect
    /// call for each box that is visited, none for nodes.
    void traverse(const BoxRegion& region, FunctionRef<bool(Proxy, const Aabb&)> visit) const;
    void traverse(const FrustumRegion& region, FunctionRef<bool(Proxy, const Aabb&)> visit) const;
    void traverse(const Everything& region, FunctionRef<bool(Proxy, const Aabb&)> visit) const;
    /// For any other region: an indirect call a node more.
    template <OtherRegion R, class Visit> void traverse(const R& region, Visit&& visit) const {
        const auto touches = [&region](const Aabb& box) { return region.touches(box); };
        traverse_any(AnyRegion(touches, region.bounds()), visit);
    }
    /// As broad::nearest_first(), compiled once: an indirect call for each box that is visited, none for nodes.
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
    /// "" when all is well; else what is not. O(n).
    [[nodiscard]] std::string broken_invariant() const;
    /// Appends the boxes of the structure's cells; none when it has none to draw.
    void cells(std::vector<DrawnCell>& out) const;

private:
    template <class> struct VariantOf;
    template <class... S> struct VariantOf<StructureList<S...>> { using type = std::variant<S...>; };
    VariantOf<AllStructures>::type structure_;

    void move(TaskRunner* tasks, std::span<const Move> boxes);
    void move(TaskRunner* tasks, std::span<const Proxy> proxies, std::span<const Aabb> by_proxy);

    /// A region of a type that is not known here.
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
