/// The list of rules that a packing tries, and the filling of a page by one of them.
#include "fase/atlas/packers/tries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "fase/core/random.hpp"

namespace fase::atlas {
namespace {

constexpr std::uint32_t skyline_rules = order_rules * 2 * 2 * 4, tree_rules = order_rules * 4 * 4;
/// One try in this many uses a kD-tree.
constexpr std::uint32_t tree_period = 32;

constexpr const char* order_names[] = {"area", "long side", "short side", "sum of sides", "diagonal", "cubes of sides"};
constexpr const char* side_names[] = {"left", "higher wall", "lower wall", "nearer height"};
constexpr const char* leaf_names[] = {"least area", "short side", "long side", "upper"};
constexpr const char* split_names[] = {"shorter rest", "longer rest", "shorter side", "longer side"};

TryRules skyline_rules_of(std::uint32_t number) {
    TryRules rules;
    rules.shuffle = number / skyline_rules;
    std::uint32_t n = number % skyline_rules;
    // Rules with the same order are adjacent, so that the rectangles are sorted once for all of them.
    rules.skyline.side =
        std::array{GapSide::Left, GapSide::HigherWall, GapSide::NearerHeight, GapSide::LowerWall}[n % 4];
    n /= 4;
    rules.skyline.widest_last = n % 2 == 0;
    n /= 2;
    rules.landscape_first = n % 2 == 1;
    n /= 2;
    rules.order = static_cast<OrderRule>(n);
    return rules;
}

TryRules tree_rules_of(std::uint32_t number) {
    TryRules rules;
    rules.kd_tree = true;
    rules.shuffle = number / tree_rules;
    std::uint32_t n = number % tree_rules;
    rules.order = std::array{OrderRule::LongSide, OrderRule::ShortSide, OrderRule::Area,
                             OrderRule::Diagonal, OrderRule::SideSum,   OrderRule::Cubes}[n % order_rules];
    n /= order_rules;
    rules.leaf = std::array{LeafRule::ShortSide, LeafRule::LeastArea, LeafRule::Upper, LeafRule::LongSide}[n % 4];
    n /= 4;
    rules.split = static_cast<SplitRule>(n);
    return rules;
}

std::uint64_t key_of(Kind kind, OrderRule rule) {
    const auto lo = static_cast<std::uint64_t>(std::min(kind.width, kind.height));
    const auto hi = static_cast<std::uint64_t>(std::max(kind.width, kind.height));
    switch (rule) {
        case OrderRule::Area: return lo * hi;
        case OrderRule::LongSide: return hi << 20 | lo;
        case OrderRule::ShortSide: return lo << 20 | hi;
        case OrderRule::SideSum: return lo + hi;
        case OrderRule::Diagonal: return lo * lo + hi * hi;
        case OrderRule::Cubes: return lo * lo * lo + hi * hi * hi;
    }
    return 0;
}

}  // namespace

std::string text_of(const TryRules& rules) {
    const auto name = [](const char* const* names, auto rule) { return names[static_cast<std::size_t>(rule)]; };
    std::string text =
        rules.kd_tree
            ? fmt::format("kd_tree by {}, leaf {}, split at {}", name(order_names, rules.order),
                          name(leaf_names, rules.leaf), name(split_names, rules.split))
            : fmt::format("skyline by {}, {} first, gap {}", name(order_names, rules.order),
                          rules.landscape_first ? "landscape" : "portrait", name(side_names, rules.skyline.side));
    if (rules.shuffle > 0) text += fmt::format(", variation {}", rules.shuffle);
    return text;
}

TryRules rules_of(std::uint32_t number, Method method) {
    if (method == Method::KdTree) return tree_rules_of(number);
    if (method == Method::Skyline) return skyline_rules_of(number);
    const std::uint32_t period = number / tree_period;
    return number % tree_period == tree_period - 1 ? tree_rules_of(period) : skyline_rules_of(number - period);
}

PageFiller::PageFiller(std::vector<Kind> kinds, bool may_rotate) : kinds_(std::move(kinds)), may_rotate_(may_rotate) {}

void PageFiller::sort(const TryRules& rules) {
    keys_.resize(kinds_.size());
    const Random variation(rules.shuffle, static_cast<std::uint64_t>(rules.order));
    for (std::size_t i = 0; i < kinds_.size(); ++i) {
        keys_[i] = key_of(kinds_[i], rules.order);
        // Keys are below 2^51, so adding 0 to 127 times a 1024th of one cannot overflow.
        if (rules.shuffle > 0) keys_[i] += (keys_[i] >> 10) * (variation.at(i) >> 57);
    }
    order_.resize(kinds_.size());
    std::iota(order_.begin(), order_.end(), 0u);
    std::sort(order_.begin(), order_.end(),
              [&](std::uint32_t a, std::uint32_t b) { return keys_[a] != keys_[b] ? keys_[a] > keys_[b] : a < b; });
}

std::int64_t PageFiller::fill(const TryRules& rules, Size page, std::span<const std::uint32_t> counts,
                              std::int64_t max_lost, std::vector<PlacedKind>& out) {
    const auto preparation =
        std::tuple(static_cast<int>(rules.order), rules.shuffle, rules.kd_tree, rules.landscape_first);
    if (preparation != prepared_) {
        sort(rules);
        if (!rules.kd_tree) skyline_.prepare(kinds_, order_, may_rotate_, rules.landscape_first);
        prepared_ = preparation;
    }
    return rules.kd_tree ? fill_tree(rules, page, counts, max_lost, out)
                         : skyline_.fill(page, counts, rules.skyline, max_lost, out);
}

std::int64_t PageFiller::fill_tree(const TryRules& rules, Size page, std::span<const std::uint32_t> counts,
                                   std::int64_t max_lost, std::vector<PlacedKind>& out) {
    out.clear();
    tree_.clear(page);
    std::int64_t left = 0;
    for (std::size_t i = 0; i < kinds_.size(); ++i) left += area_of(kinds_[i]) * counts[i];
    // With a limit, everything must fit: stop at the first kind that does not.
    const std::int64_t max_left = max_lost >= area_of(page) ? left : 0;
    std::int64_t refused = 0;
    for (const std::uint32_t kind : order_) {
        for (std::uint32_t n = 0; n < counts[kind]; ++n) {
            const auto place = tree_.insert(kinds_[kind], may_rotate_, rules.leaf, rules.split);
            if (!place) {
                refused += area_of(kinds_[kind]) * (counts[kind] - n);
                break;
            }
            out.push_back({kind, place->x, place->y, place->width != kinds_[kind].width});
            left -= area_of(kinds_[kind]);
        }
        if (refused > max_left) break;
    }
    return left;
}

}  // namespace fase::atlas
