#pragma once
/// The list of rules that a packing tries, and the filling of a page by one of them.
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "fase/atlas/packer.hpp"
#include "fase/atlas/packers/kd_tree.hpp"
#include "fase/atlas/packers/skyline.hpp"

namespace fase::atlas {

/// The key by which rectangles are sorted, greatest first.
enum class OrderRule : std::uint8_t { Area, LongSide, ShortSide, SideSum, Diagonal, Cubes };
inline constexpr int order_rules = 6;

/// One set of rules to fill a page.
struct TryRules {
    OrderRule order = OrderRule::Area;
    std::uint32_t shuffle = 0;  ///< 0: sorted by `order`; else the number of a slight random variation
    bool kd_tree = false;
    bool landscape_first = false;  ///< skyline
    SkylineRules skyline;
    LeafRule leaf = LeafRule::ShortSide;  ///< kD-tree
    SplitRule split = SplitRule::ShorterRest;
};

/// Describes the rules: "skyline by area, portrait first, gap left", "kd_tree by long side, …".
[[nodiscard]] std::string text_of(const TryRules& rules);

/// Returns the rules of the n-th try: first those that did best on sprites and glyphs, then all others, then random
/// variations of them.
[[nodiscard]] TryRules rules_of(std::uint32_t number, Method method);

/// Fills pages with kinds of rectangles by given rules; reuses sorting results and memory between tries.
class PageFiller {
public:
    PageFiller(std::vector<Kind> kinds, bool may_rotate);
    /// Fills a page; returns the same as Skyline::fill().
    std::int64_t fill(const TryRules& rules, Size page, std::span<const std::uint32_t> counts, std::int64_t max_lost,
                      std::vector<PlacedKind>& out);
    [[nodiscard]] std::span<const Kind> kinds() const { return kinds_; }

private:
    void sort(const TryRules& rules);
    std::int64_t fill_tree(const TryRules& rules, Size page, std::span<const std::uint32_t> counts,
                           std::int64_t max_lost, std::vector<PlacedKind>& out);

    std::vector<Kind> kinds_;
    bool may_rotate_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint64_t> keys_;
    std::tuple<int, std::uint32_t, bool, bool> prepared_{
        -1, 0, false, false};  ///< the rules for which order_ and skyline_ are prepared
    Skyline skyline_;
    KdTree tree_;
};

}  // namespace fase::atlas
