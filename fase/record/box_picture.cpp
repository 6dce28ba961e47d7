/// Projects boxes and cells onto the page and writes them as SVG.
#include "fase/record/box_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "fase/drawing/svg.hpp"

namespace fase::record {
namespace {

using drawing::svg_fixed;
using drawing::svg_number;
using drawing::SvgPath;
using drawing::SvgWriter;

constexpr double page_width = 900, edge = 20, legend_height = 64, min_height = 120, max_height = 1400;
constexpr double min_side = 0.8;  // thinner rectangles would be invisible
constexpr std::string_view box_opacity = ".3";

/// In page units, y downward.
struct Rectangle {
    double left = 0, top = 0, right = 0, bottom = 0;
};

/// Maps metres to the page. The bounds of all finite coordinates fill the page.
class Page {
public:
    explicit Page(const BoxPicture& picture) : view_(picture.view) {
        const auto extend = [](double value, double& lo, double& hi) {
            if (!(std::abs(value) < 1e30)) return;
            lo = std::min(lo, value);
            hi = std::max(hi, value);
        };
        constexpr double none = 1e300;
        double lo_u = none, hi_u = -none, lo_v = none, hi_v = -none;
        for (const PicturedBox& one : picture.boxes) {
            if (is_empty(one.box)) continue;
            for (const Vec3 corner : {one.box.lo, one.box.hi}) {
                extend(corner[across()], lo_u, hi_u);
                extend(corner[upward()], lo_v, hi_v);
            }
        }
        if (lo_u > hi_u) lo_u = -1, hi_u = 1;
        if (lo_v > hi_v) lo_v = -1, hi_v = 1;
        const double largest =
            std::max({hi_u - lo_u, hi_v - lo_v, 1e-6 * std::abs(hi_u), 1e-6 * std::abs(hi_v), 1e-30});
        const double width = page_width - 2 * edge;
        scale_ = std::min(width / std::max(hi_u - lo_u, 1e-3 * largest),
                          (max_height - 2 * edge) / std::max(hi_v - lo_v, 1e-3 * largest));
        middle_u_ = (lo_u + hi_u) / 2;
        middle_v_ = (lo_v + hi_v) / 2;
        height_ = std::clamp((hi_v - lo_v) * scale_ + 2 * edge, min_height, max_height);
    }
    [[nodiscard]] double height() const { return height_; }
    [[nodiscard]] Rectangle rectangle(const Aabb& box) const {
        const auto place_u = [&](float u) { return page_width / 2 + (u - middle_u_) * scale_; };
        const auto place_v = [&](float v) {
            const double down = (v - middle_v_) * scale_;
            return height_ / 2 + (view_ == View::FromAbove ? down : -down);
        };
        const double v1 = place_v(box.lo[upward()]), v2 = place_v(box.hi[upward()]);
        Rectangle r{place_u(box.lo[across()]), std::min(v1, v2), place_u(box.hi[across()]), std::max(v1, v2)};
        keep_within(r.left, r.right, page_width);
        keep_within(r.top, r.bottom, height_);
        return r;
    }

private:
    View view_;
    double scale_ = 1, middle_u_ = 0, middle_v_ = 0, height_ = 0;

    [[nodiscard]] int across() const { return view_ == View::FromSide ? 2 : 0; }
    [[nodiscard]] int upward() const { return view_ == View::FromAbove ? 2 : 1; }
    static void keep_within(double& lo, double& hi, double size) {
        constexpr double inset = edge / 2;
        lo = std::clamp(lo, inset, size - inset);
        hi = std::clamp(hi, inset, size - inset);
        const double missing = min_side - (hi - lo);
        if (missing > 0) lo -= missing / 2, hi += missing / 2;
    }
};

struct KindStyle {
    BoxKind kind;
    const char *name, *colour;
};
constexpr std::array<KindStyle, 3> styles{{{BoxKind::Static, "static", "#8d96a3"},
                                           {BoxKind::Resting, "resting", "#3f7fd9"},
                                           {BoxKind::Awake, "awake", "#ee7b30"}}};

void draw_boxes(const BoxPicture& picture, const Page& page, SvgWriter& svg) {
    for (const KindStyle& style : styles) {
        std::vector<Rectangle> boxes;
        for (const PicturedBox& one : picture.boxes)
            if (one.kind == style.kind && !is_empty(one.box)) boxes.push_back(page.rectangle(one.box));
        if (boxes.empty()) continue;
        const auto area = [](const Rectangle& r) { return (r.right - r.left) * (r.bottom - r.top); };
        std::stable_sort(boxes.begin(), boxes.end(),  // small boxes on top of large ones
                         [&](const Rectangle& a, const Rectangle& b) { return area(a) > area(b); });
        svg.open(
            "g",
            {{"fill", style.colour}, {"fill-opacity", box_opacity}, {"stroke", style.colour}, {"stroke-width", ".8"}});
        for (const Rectangle& r : boxes) svg.rectangle(r.left, r.top, r.right - r.left, r.bottom - r.top);
        svg.close();
    }
}

struct CellShape {
    std::string path;
    int depth;
};

/// Returns one shape for all cells that look the same, the deepest first, so that cells above cover them.
std::vector<CellShape> cell_shapes(const BoxPicture& picture, const Page& page) {
    std::vector<CellShape> shapes;
    for (const broad::DrawnCell& cell : picture.cells) {
        if (is_empty(cell.box)) continue;
        const Rectangle r = page.rectangle(cell.box);
        SvgPath path;
        path.rectangle(r.left, r.top, r.right - r.left, r.bottom - r.top);
        shapes.push_back({path.data(), cell.depth});
    }
    std::sort(shapes.begin(), shapes.end(), [](const CellShape& a, const CellShape& b) {
        return a.path != b.path ? a.path < b.path : a.depth < b.depth;
    });
    shapes.erase(std::unique(shapes.begin(), shapes.end(),
                             [](const CellShape& a, const CellShape& b) { return a.path == b.path; }),
                 shapes.end());
    std::stable_sort(shapes.begin(), shapes.end(),
                     [](const CellShape& a, const CellShape& b) { return a.depth > b.depth; });
    return shapes;
}

/// From dark blue at the root (0) to sea green at the leaves (1).
std::string depth_colour(double share) {
    const auto between = [&](int root, int leaf) {
        return static_cast<std::uint8_t>(std::lround(root + (leaf - root) * share));
    };
    return drawing::svg_colour(between(0x12, 0x2a), between(0x2b, 0xa1), between(0x5c, 0x98));
}

/// All cells of one depth as one path.
struct CellLayer {
    std::string path, id;
    double share = 0;  ///< of the greatest depth
};

std::vector<CellLayer> cell_layers(const BoxPicture& picture, const Page& page) {
    const std::vector<CellShape> shapes = cell_shapes(picture, page);
    const int deepest = shapes.empty() ? 0 : shapes.front().depth;
    std::vector<CellLayer> layers;
    for (std::size_t i = 0; i < shapes.size();) {
        const int depth = shapes[i].depth;
        CellLayer& layer = layers.emplace_back();
        layer.id = fmt::format("depth{}", depth);
        layer.share = deepest > 0 ? static_cast<double>(depth) / deepest : 0.5;
        for (; i < shapes.size() && shapes[i].depth == depth; ++i) layer.path += shapes[i].path;
    }
    return layers;
}

/// Defines the path of each layer, and uses it for faint areas, which are below the boxes.
void draw_cell_areas(const std::vector<CellLayer>& layers, SvgWriter& svg) {
    svg.open("defs");
    for (const CellLayer& layer : layers) svg.element("path", {{"id", layer.id}, {"d", layer.path}});
    svg.close();
    svg.open("g", {{"fill-opacity", ".035"}});
    for (const CellLayer& layer : layers)
        svg.element("use", {{"href", "#" + layer.id}, {"fill", depth_colour(layer.share)}});
    svg.close();
}

/// Draws the outlines of the cells, which are above the boxes.
void draw_cell_lines(const std::vector<CellLayer>& layers, SvgWriter& svg) {
    svg.open("g", {{"fill", "none"}});
    for (const CellLayer& layer : layers) {
        svg.element("use", {{"href", "#" + layer.id},
                            {"stroke", depth_colour(layer.share)},
                            {"stroke-opacity", svg_fixed(0.95 - 0.3 * layer.share, 2)},
                            {"stroke-width", svg_fixed(2.0 - 1.1 * layer.share, 1)}});
    }
    svg.close();
}

void draw_legend(const BoxPicture& picture, SvgWriter& svg) {
    svg.text({{"x", edge / 2}, {"y", 28}, {"font-size", 20}},
             {{picture.title, {{"font-weight", "bold"}}},
              {picture.note, {{"dx", 14}, {"font-size", 14}, {"fill", "#5b6470"}}}});
    double x = edge / 2;
    const auto entry = [&](const std::string& name, auto&& draw_symbol) {
        svg.open_inline("g", {{"transform", "translate(" + svg_number(x) + " 42)"}});
        draw_symbol();
        svg.text({{"x", 24}, {"y", 10.5}, {"font-size", 13}}, name);
        svg.close();
        x += 46 + 7 * static_cast<double>(name.size());
    };
    for (const KindStyle& style : styles) {
        const auto count = std::count_if(picture.boxes.begin(), picture.boxes.end(),
                                         [&](const PicturedBox& one) { return one.kind == style.kind; });
        if (count == 0) continue;
        entry(fmt::format("{} {}", count, style.name), [&] {
            svg.element("rect", {{"width", 18},
                                 {"height", 12},
                                 {"fill", style.colour},
                                 {"fill-opacity", box_opacity},
                                 {"stroke", style.colour}});
        });
    }
    int deepest = 0;
    for (const broad::DrawnCell& cell : picture.cells) deepest = std::max(deepest, cell.depth);
    if (picture.cells.empty()) return;
    entry(deepest == 0 ? std::string("cells") : fmt::format("cells, depth 0 to {}", deepest), [&] {
        svg.element("path", {{"d", "M0 2h18"}, {"stroke", depth_colour(0)}, {"stroke-width", 2}});
        svg.element("path", {{"d", "M0 9h18"}, {"stroke", depth_colour(1)}, {"stroke-width", ".9"}});
    });
}

}  // namespace

std::string svg_of(const BoxPicture& picture) {
    const Page page(picture);
    SvgWriter svg(
        page_width, page.height() + legend_height,
        {{"role", "img"}, {"font-family", "system-ui, 'DejaVu Sans', Arial, sans-serif"}, {"fill", "#1f2733"}});
    svg.title(picture.title + ": " + picture.note);
    svg.background("#fff");
    draw_legend(picture, svg);
    svg.open("g", {{"transform", "translate(0 " + svg_number(legend_height) + ")"}});
    const std::vector<CellLayer> layers = cell_layers(picture, page);
    draw_cell_areas(layers, svg);
    draw_boxes(picture, page, svg);
    draw_cell_lines(layers, svg);
    return svg.finish();
}

}  // namespace fase::record
