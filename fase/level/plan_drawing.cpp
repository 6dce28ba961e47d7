/// Draws the plan in layers: tints, partition lines, walls, the eye, the legend.
#include "fase/level/plan_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fase::level {
namespace {

constexpr double edge = 24, head = 40, foot = 46, page_width = 1200, max_height = 1600;
constexpr Colour ink{34, 38, 46, 255}, grey{110, 118, 130, 255}, wall{28, 32, 40, 255}, step{120, 128, 140, 255},
    border{188, 193, 200, 255}, lit{255, 214, 64, 110}, bright{255, 190, 0, 90}, here{226, 32, 60, 255};

constexpr std::array<Colour, 12> tints{{{214, 232, 247, 255},
                                        {223, 240, 216, 255},
                                        {252, 236, 206, 255},
                                        {240, 221, 240, 255},
                                        {216, 240, 238, 255},
                                        {250, 224, 219, 255},
                                        {230, 230, 247, 255},
                                        {240, 242, 208, 255},
                                        {225, 233, 226, 255},
                                        {247, 229, 237, 255},
                                        {219, 236, 225, 255},
                                        {238, 231, 220, 255}}};

/// Returns a colour between red (0), orange, green, blue and violet (1).
Colour ramp(double t) {
    constexpr std::array<Colour, 6> stops{{{214, 28, 44, 255},
                                           {240, 130, 20, 255},
                                           {150, 160, 20, 255},
                                           {20, 150, 110, 255},
                                           {40, 110, 210, 255},
                                           {130, 70, 190, 255}}};
    const double place = std::clamp(t, 0.0, 1.0) * (stops.size() - 1);
    const auto k = std::min(static_cast<std::size_t>(place), stops.size() - 2);
    const double share = place - static_cast<double>(k);
    const auto mix = [&](std::uint8_t a, std::uint8_t b) {
        return static_cast<std::uint8_t>(a + (b - a) * share + 0.5);
    };
    return {mix(stops[k].red, stops[k + 1].red), mix(stops[k].green, stops[k + 1].green),
            mix(stops[k].blue, stops[k + 1].blue), 255};
}

/// A piece of a partition line.
struct Chord {
    Point a, b;
    std::size_t depth = 0;
};

double left_of(const Node& node, Point p) {
    const double dx = node.dx, dy = node.dy;
    return side_value(node, p) / std::sqrt(dx * dx + dy * dy);
}

/// Draws one plan.
class Plan {
public:
    Plan(const Map& map, const LevelBsp& bsp, const PlanOptions& options) : map_(map), bsp_(bsp), options_(options) {
        for (const Line& line : map.lines)
            for (const std::uint16_t v : {line.from, line.to}) plan_.add(bsp.vertices[v]);
        const double across = std::max(plan_.hi.x - plan_.lo.x, 1.0), up = std::max(plan_.hi.y - plan_.lo.y, 1.0);
        scale_ = std::min((page_width - 2 * edge) / across, (max_height - head - foot - 2 * edge) / up);
        drawing_.width = page_width;
        drawing_.height = std::max(up * scale_, 120.0) + head + foot + 2 * edge;
        shift_x_ = (page_width - across * scale_) / 2;
    }
    Drawing draw() {
        walk();
        tint();
        draw_partitions();
        draw_lines();
        draw_eye();
        draw_legend();
        return std::move(drawing_);
    }

private:
    const Map& map_;
    const LevelBsp& bsp_;
    const PlanOptions& options_;
    PlanBox plan_;
    double scale_ = 1, shift_x_ = 0;
    Drawing drawing_;
    std::vector<Chord> between_;  ///< open borders between sub-sectors
    std::vector<Chord> across_;   ///< the first partition lines, over their entire cells

    [[nodiscard]] Point place(Point p) const {
        return {shift_x_ + (p.x - plan_.lo.x) * scale_, head + edge + (plan_.hi.y - p.y) * scale_};
    }
    [[nodiscard]] Point corner(std::uint32_t vertex) const { return place(bsp_.vertices[vertex]); }

    /// Traverses the tree to find the node of each miniseg.
    void walk() {
        struct Step {
            std::uint32_t child = 0;
            std::size_t depth = 0;
        };
        std::vector<Step> stack{{bsp_.root(), 0}};
        std::vector<std::uint32_t> above;
        while (!stack.empty()) {
            const Step current = stack.back();
            stack.pop_back();
            above.resize(current.depth);
            const std::uint32_t index = current.child & ~Node::leaf_bit;
            if ((current.child & Node::leaf_bit) != 0) {
                find_minisegs(bsp_.sub_sectors[index], above);
                continue;
            }
            if (current.depth < 4) add_across(index, above);
            above.push_back(index);
            for (const std::uint32_t child : bsp_.nodes[index].children) stack.push_back({child, current.depth + 1});
        }
    }
    void find_minisegs(const SubSector& s, const std::vector<std::uint32_t>& above) {
        for (const Seg& seg : bsp_.edges(s)) {
            if (seg.line != no_index || seg.from > seg.to) continue;  // one of two partners is enough
            const Point a = bsp_.vertices[seg.from], b = bsp_.vertices[seg.to];
            for (std::size_t depth = 0; depth < above.size(); ++depth) {
                const Node& node = bsp_.nodes[above[depth]];
                if (std::abs(left_of(node, a)) > 1e-3 || std::abs(left_of(node, b)) > 1e-3) continue;
                between_.push_back({a, b, depth});
                break;
            }
        }
    }
    /// Adds the part of the node's line inside its cell and the box of the plan.
    void add_across(std::uint32_t index, const std::vector<std::uint32_t>& above) {
        const Node& node = bsp_.nodes[index];
        double from = -1e9, to = 1e9;
        const auto clip = [&](double at_origin, double slope) {  // to the t for which at_origin + t * slope is below 0
            if (slope > 0) to = std::min(to, -at_origin / slope);
            if (slope < 0) from = std::max(from, -at_origin / slope);
        };
        const Point origin{double(node.x), double(node.y)};
        const double dx = node.dx, dy = node.dy;
        clip(plan_.lo.x - origin.x, -dx);
        clip(origin.x - plan_.hi.x, dx);
        clip(plan_.lo.y - origin.y, -dy);
        clip(origin.y - plan_.hi.y, dy);
        std::uint32_t below = index;
        for (std::size_t k = above.size(); k-- > 0;) {
            const Node& other = bsp_.nodes[above[k]];
            const double sign = other.children[0] == below ? 1 : -1;
            clip(sign * side_value(other, origin), sign * (other.dx * dy - other.dy * dx));
            below = above[k];
        }
        if (from >= to) return;
        across_.push_back(
            {{origin.x + from * dx, origin.y + from * dy}, {origin.x + to * dx, origin.y + to * dy}, above.size()});
    }

    void tint() {
        const auto outline = [&](const SubSector& s) {
            std::vector<Point> corners;
            for (const Seg& seg : bsp_.edges(s)) corners.push_back(corner(seg.from));
            return corners;
        };
        std::vector<std::uint32_t> by_tint;
        for (std::uint32_t s = 0; s < bsp_.sub_sectors.size(); ++s) by_tint.push_back(s);
        const auto tint_of = [&](std::uint32_t s) { return bsp_.sub_sectors[s].sector * 5 % tints.size(); };
        std::stable_sort(by_tint.begin(), by_tint.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return tint_of(a) < tint_of(b); });
        for (const std::uint32_t s : by_tint) drawing_.polygon(outline(bsp_.sub_sectors[s]), tints[tint_of(s)]);
        for (const std::uint32_t s : options_.seen)
            if (s < bsp_.sub_sectors.size()) drawing_.polygon(outline(bsp_.sub_sectors[s]), lit);
        for (const std::vector<Point>& polygon : options_.sight) {
            std::vector<Point> corners;
            for (const Point p : polygon) corners.push_back(place(p));
            drawing_.polygon(std::move(corners), bright);
        }
    }

    [[nodiscard]] Colour colour_of(std::size_t depth) const {
        return ramp(static_cast<double>(depth) /
                    static_cast<double>(std::max<std::size_t>(bsp_.stats.worst_depth, 2) - 1));
    }
    void draw_partitions() {
        const auto deepest_first = [](const Chord& a, const Chord& b) { return a.depth > b.depth; };
        std::stable_sort(between_.begin(), between_.end(), deepest_first);
        std::stable_sort(across_.begin(), across_.end(), deepest_first);
        for (const Chord& chord : across_) {
            Colour colour = colour_of(chord.depth);
            colour.alpha = 80;
            drawing_.line({place(chord.a), place(chord.b)}, 0.8, colour);
        }
        for (const Chord& chord : between_) {
            const double width = 0.6 + 2.0 / (1.0 + static_cast<double>(chord.depth));
            drawing_.line({place(chord.a), place(chord.b)}, width, colour_of(chord.depth));
        }
    }
    void draw_lines() {
        const auto kind_of = [&](const Line& line) {
            if (line.right == no_side || line.left == no_side) return 2;
            const Sector &a = map_.sectors[map_.sides[line.right].sector],
                         &b = map_.sectors[map_.sides[line.left].sector];
            return a.floor != b.floor || a.ceiling != b.ceiling ? 1 : 0;
        };
        for (const int kind : {0, 1, 2}) {
            for (const Line& line : map_.lines)
                if (kind_of(line) == kind)
                    drawing_.line({corner(line.from), corner(line.to)}, kind == 2 ? 1.5 : 0.9,
                                  kind == 2   ? wall
                                  : kind == 1 ? step
                                              : border);
        }
    }
    void draw_eye() {
        if (!options_.eye) return;
        std::uint32_t child = bsp_.root();
        while ((child & Node::leaf_bit) == 0)
            child = bsp_.nodes[child].children[side_of(bsp_.nodes[child], *options_.eye)];
        for (const Seg& seg : bsp_.edges(bsp_.sub_sectors[child & ~Node::leaf_bit]))
            drawing_.line({corner(seg.from), corner(seg.to)}, 2, here);
        const Point eye = place(*options_.eye);
        constexpr double r = 5;
        drawing_.polygon({{eye.x - r, eye.y}, {eye.x, eye.y - r}, {eye.x + r, eye.y}, {eye.x, eye.y + r}}, here);
    }
    void draw_legend() {
        drawing_.text({edge, 30}, 12, options_.title, ink);
        drawing_.text({edge + 12 * 1.15 * static_cast<double>(options_.title.size()) + 16, 30}, 8, options_.note, grey);
        const double y = drawing_.height - foot / 2;
        double x = edge;
        drawing_.text({x, y + 4}, 8, "partition lines by depth: 0", grey);
        x += 235;
        const std::size_t depths = std::max<std::size_t>(bsp_.stats.worst_depth, 1);
        const double width = std::min(14.0, 420.0 / static_cast<double>(depths));
        for (std::size_t depth = 0; depth < depths; ++depth, x += width)
            drawing_.polygon({{x, y - 6}, {x + width, y - 6}, {x + width, y + 6}, {x, y + 6}}, colour_of(depth));
        x += 8;
        drawing_.text({x, y + 4}, 8, fmt::format("{}", depths - 1), grey);
        x += 40;
        struct Key {
            Colour colour;
            double width;
            const char* name;
        };
        for (const Key& key : {Key{wall, 1.5, "wall"}, Key{step, 0.9, "step"}, Key{border, 0.9, "border"}}) {
            drawing_.line({{x, y}, {x + 28, y}}, key.width, key.colour);
            drawing_.text({x + 34, y + 4}, 8, key.name, grey);
            x += 34 + 10.0 * static_cast<double>(std::string_view(key.name).size()) + 24;
        }
    }
};

}  // namespace

Drawing draw_plan(const Map& map, const LevelBsp& bsp, const PlanOptions& options) {
    return Plan(map, bsp, options).draw();
}

}  // namespace fase::level
