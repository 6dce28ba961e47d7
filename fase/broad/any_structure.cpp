/// Dispatches each call once on the variant, then runs the code of the concrete structure.
#include "fase/broad/any_structure.hpp"

#include <variant>

#include "fase/broad/find_pairs.hpp"
#include "fase/broad/registry.hpp"

namespace fase::broad {
namespace {

template <class> struct VariantOf;
template <class... S> struct VariantOf<StructureList<S...>> { using type = std::variant<S...>; };

}  // namespace

struct AnyStructure::Held {
    VariantOf<AllStructures>::type structure;

    /// All stored boxes, in the structure's order.
    [[nodiscard]] std::vector<Move> boxes() const {
        std::vector<Move> all;
        std::visit([&](const auto& s) { stored_boxes(s, all); }, structure);
        return all;
    }
};

Result<AnyStructure> AnyStructure::named(std::string_view name) {
    AnyStructure found;
    bool known = false;
    for_each_structure([&]<Structure S>() {
        if (S::info.name != name) return;
        found.held_->structure.template emplace<S>();
        known = true;
    });
    if (!known) {
        return Error{Status::BadArgument, "structure",
                     "found \"" + std::string(name) + "\"; expected one of " + names(), ""};
    }
    return found;
}

std::string AnyStructure::names() {
    std::string all;
    for_each_structure([&]<Structure S>() { all += (all.empty() ? "" : ", ") + std::string(S::info.name); });
    return all;
}

AnyStructure::AnyStructure(const AnyStructure& other) : held_(std::make_unique<Held>(*other.held_)) {}
AnyStructure& AnyStructure::operator=(const AnyStructure& other) {
    if (this != &other) held_ = std::make_unique<Held>(*other.held_);
    return *this;
}
AnyStructure::AnyStructure(AnyStructure&&) noexcept = default;
AnyStructure& AnyStructure::operator=(AnyStructure&&) noexcept = default;
AnyStructure::~AnyStructure() = default;

AnyStructure::AnyStructure() : held_(std::make_unique<Held>()) {
    for_each_structure([&]<Structure S>() {
        if (S::info.name == default_structure) held_->structure.template emplace<S>();
    });
}

void AnyStructure::insert(std::span<const Move> boxes) {
    std::visit(
        [&](auto& s) {
            for (const Move& m : boxes) s.insert(m.proxy, m.box);
        },
        held_->structure);
}

void AnyStructure::move(TaskRunner* tasks, std::span<const Move> boxes) {
    std::visit(
        [&]<class S>(S& s) {
            if constexpr (MovesInBulk<S>) {
                s.move(tasks, boxes);
            } else {
                for (const Move& m : boxes) s.move(m.proxy, m.box);
            }
        },
        held_->structure);
}

void AnyStructure::insert(std::span<const Proxy> proxies, std::span<const Aabb> by_proxy) {
    std::visit(
        [&](auto& s) {
            for (const Proxy p : proxies) s.insert(p, by_proxy[p]);
        },
        held_->structure);
}

void AnyStructure::move(TaskRunner* tasks, std::span<const Proxy> proxies, std::span<const Aabb> by_proxy) {
    std::visit(
        [&]<class S>(S& s) {
            if constexpr (MovesInBulk<S>) {
                s.move(tasks, proxies, by_proxy);
            } else {
                for (const Proxy p : proxies) s.move(p, by_proxy[p]);
            }
        },
        held_->structure);
}

void AnyStructure::erase(std::span<const Proxy> proxies) {
    std::visit(
        [&](auto& s) {
            for (const Proxy p : proxies) s.erase(p);
        },
        held_->structure);
}

void AnyStructure::clear() {
    std::visit([](auto& s) { s.clear(); }, held_->structure);
}

void AnyStructure::set_awake(std::span<const Proxy> proxies, bool awake) {
    std::visit(
        [&](auto& s) {
            for (const Proxy p : proxies) s.set_awake(p, awake);
        },
        held_->structure);
}

void AnyStructure::build(std::span<const Move> boxes) {
    std::visit(
        [&]<class S>(S& s) {
            if constexpr (BuildsInBulk<S>) {
                s.build(boxes);
            } else {
                s.clear();
                for (const Move& m : boxes) s.insert(m.proxy, m.box);
                s.commit();
            }
        },
        held_->structure);
}

void AnyStructure::convert_to(AnyStructure other) {
    commit();
    std::vector<Move> all;
    all.reserve(size());
    std::vector<Proxy> resting;
    traverse(Everything{}, [&](Proxy p, const Aabb& box) {
        all.push_back({p, box});
        if (!is_awake(p)) resting.push_back(p);
        return true;
    });
    other.build(all);
    if (!resting.empty()) {
        other.set_awake(resting, false);
        other.commit();
    }
    held_ = std::move(other.held_);
}

void AnyStructure::build_static(std::span<const Move> boxes) {
    const bool built = std::visit(
        [&]<class S>(S& s) {
            if constexpr (BuildsStatic<S>) s.build_static(boxes);
            return BuildsStatic<S>;
        },
        held_->structure);
    if (!built) build(boxes);
}

void AnyStructure::commit() {
    std::visit([](auto& s) { s.commit(); }, held_->structure);
}

void AnyStructure::commit(TaskRunner& tasks) {
    std::visit(
        [&]<class S>(S& s) {
            if constexpr (CommitsInParallel<S>) {
                s.commit(tasks);
            } else {
                s.commit();
            }
        },
        held_->structure);
}

void AnyStructure::find_pairs(std::vector<Pair>& out) const {
    std::visit([&](const auto& s) { broad::find_pairs(s, out); }, held_->structure);
}

void AnyStructure::find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const {
    std::visit([&](const auto& s) { broad::find_pairs(tasks, s, out); }, held_->structure);
}

void AnyStructure::find_awake_pairs(std::vector<Pair>& out) const {
    std::visit([&](const auto& s) { broad::find_awake_pairs(s, out); }, held_->structure);
}

void AnyStructure::find_pairs_of(std::span<const Move> query_boxes, std::vector<Pair>& out) const {
    find_pairs_of(query_boxes, {}, out);
}

void AnyStructure::find_pairs_of(std::span<const Move> query_boxes, std::span<const std::uint8_t> is_query,
                                 std::vector<Pair>& out) const {
    std::visit([&](const auto& s) { broad::find_pairs_of(s, query_boxes, is_query, out); }, held_->structure);
}

void AnyStructure::find_pairs_of(TaskRunner& tasks, std::span<const Move> query_boxes,
                                 std::span<const std::uint8_t> is_query, std::vector<Pair>& out) const {
    std::visit([&](const auto& s) { broad::find_pairs_of(tasks, s, query_boxes, is_query, out); }, held_->structure);
}

void AnyStructure::find_pairs_between(TaskRunner& tasks, const AnyStructure& other, std::vector<Pair>& out) const {
    if (size() == 0 || other.size() == 0) return;
    if (tasks.threads() == 1) return find_pairs_between(other, out);
    const bool is_smaller = size() < other.size();
    (is_smaller ? other : *this).find_pairs_of(tasks, (is_smaller ? *this : other).held_->boxes(), {}, out);
}

void AnyStructure::find_pairs_between(const AnyStructure& other, std::vector<Pair>& out) const {
    if (held_->structure.index() == other.held_->structure.index()) {
        std::visit(
            [&]<class S>(const S& mine) {
                broad::find_pairs_between(mine, *std::get_if<S>(&other.held_->structure), out);
            },
            held_->structure);
    } else if (size() > other.size()) {
        find_pairs_of(other.held_->boxes(), out);
    } else {
        other.find_pairs_of(held_->boxes(), out);
    }
}

void AnyStructure::overlapping(const Aabb& box, std::vector<Proxy>& out) const {
    traverse(BoxRegion{box}, [&](Proxy p, const Aabb&) {
        out.push_back(p);
        return true;
    });
}

void AnyStructure::traverse(const BoxRegion& region, FunctionRef<bool(Proxy, const Aabb&)> visit) const {
    std::visit([&](const auto& s) { s.traverse(region, visit); }, held_->structure);
}

void AnyStructure::traverse(const FrustumRegion& region, FunctionRef<bool(Proxy, const Aabb&)> visit) const {
    std::visit([&](const auto& s) { s.traverse(region, visit); }, held_->structure);
}

void AnyStructure::traverse(const Everything& region, FunctionRef<bool(Proxy, const Aabb&)> visit) const {
    std::visit([&](const auto& s) { s.traverse(region, visit); }, held_->structure);
}

void AnyStructure::traverse_any(const AnyRegion& region, FunctionRef<bool(Proxy, const Aabb&)> visit) const {
    std::visit([&](const auto& s) { s.traverse(region, visit); }, held_->structure);
}

void AnyStructure::nearest_first(const RayMeasure& measure, float limit,
                                 FunctionRef<float(Proxy, const Aabb&, float)> visit) const {
    std::visit([&](const auto& s) { broad::nearest_first(s, measure, limit, visit); }, held_->structure);
}

void AnyStructure::nearest_first(const PointMeasure& measure, float limit,
                                 FunctionRef<float(Proxy, const Aabb&, float)> visit) const {
    std::visit([&](const auto& s) { broad::nearest_first(s, measure, limit, visit); }, held_->structure);
}

void AnyStructure::cull(const FrustumRegion& region, FunctionRef<void(std::span<const Proxy>, bool)> take) const {
    std::visit([&](const auto& s) { broad::cull(s, region, take); }, held_->structure);
}

void AnyStructure::for_each_leaf(FunctionRef<void(const Leaf&)> visit) const {
    std::visit([&](const auto& s) { s.for_each_leaf(visit); }, held_->structure);
}

StructureStats AnyStructure::stats() const {
    return std::visit([](const auto& s) { return stats_of(s); }, held_->structure);
}

bool AnyStructure::is_awake(Proxy p) const {
    return std::visit([&](const auto& s) { return s.is_awake(p); }, held_->structure);
}

StructureInfo AnyStructure::info() const {
    return std::visit([]<class S>(const S&) -> StructureInfo { return S::info; }, held_->structure);
}

std::size_t AnyStructure::size() const {
    return std::visit([](const auto& s) { return s.size(); }, held_->structure);
}

std::size_t AnyStructure::bytes() const {
    return std::visit([](const auto& s) { return s.bytes(); }, held_->structure);
}

std::string AnyStructure::broken_invariant() const {
    return std::visit([](const auto& s) { return s.broken_invariant(); }, held_->structure);
}

void AnyStructure::cells(std::vector<DrawnCell>& out) const {
    std::visit(
        [&]<class S>(const S& s) {
            if constexpr (Drawable<S>) s.cells(out);
        },
        held_->structure);
}

}  // namespace fase::broad
