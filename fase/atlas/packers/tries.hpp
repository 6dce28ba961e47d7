#pragma once
/// The list of rules that a packing goes through, and what one of them makes of a page.
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "fase/atlas/packer.hpp"
#include "fase/atlas/packers/kd_tree.hpp"
#include "fase/atlas/packers/skyline.hpp"

namespace fase::atlas {

/// By what rectangles are preferred, the greatest first.
enum class OrderRule : std::uint8_t { Area, LongSide, ShortSide, SideSum, Diagonal, Cubes };
inline constexpr int order_rules = 6;

/// One way to fill a page.
struct TryRules {
    OrderRule order = OrderRule::Area;
    std::uint32_t shuffle = 0;  ///< 0: strictly by `order`; else the number of a slight disorder
    bool kd_tree = false;
    bool lying_first = false;  ///< skyline
    SkylineRules skyline;
    LeafRule leaf = LeafRule::ShortSide;  ///< kD-tree
    SplitRule split = SplitRule::ShorterRest;
};

/// "skyline by area, gap left", "kd_tree by long side, …".
[[nodiscard]] std::string text_of(const TryRules& rules);

/// The rules of the n-th try: first those that did best on sprites and glyphs, then all others, then disorders.
[[nodiscard]] TryRules rules_of(std::uint32_t number, Method method);

/// What the tries work on: kinds of rectangles, and memory that they reuse.
class TryBench {
public:
    TryBench(std::vector<Kind> kinds, bool may_turn);
    /// Fills a page; answers as Skyline::fill() does.
    std::int64_t fill(const TryRules& rules, Size page, std::span<const std::uint32_t> counts, std::int64_t max_lost,
                      std::vector<Laid>& out);
    [[nodiscard]] std::span<const Kind> kinds() const { return kinds_; }

private:
    void sort(const TryRules& rules);
    std::int64_t fill_tree(const TryRules& rules, Size page, std::span<const std::uint32_t> counts,
                           std::int64_t max_left, std::vector<Laid>& out);

    std::vector<Kind> kinds_;
    bool may_turn_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint64_t> keys_;
    std::tuple<int, std::uint32_t, bool, bool> prepared_{-1, 0, false,
                                                         false};  ///< for which rules order_ and skyline_ stand
    Skyline skyline_;
    KdTree tree_;
};

}  // namespace fase::atlas
