/// How boxes and cells become an SVG document.
#include "fase/record/box_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <vector>

namespace fase::record {
namespace {

constexpr double page_width = 900, edge = 20, legend_height = 64, min_height = 120, max_height = 1400;
constexpr double min_side = 0.8;  // what is thinner could not be seen

/// In units of the page, y downward.
struct Rectangle {
    double left = 0, top = 0, right = 0, bottom = 0;
};

std::string escaped(std::string_view text) {
    std::string safe;
    for (const char c : text) {
        switch (c) {
            case '&': safe += "&amp;"; break;
            case '<': safe += "&lt;"; break;
            case '>': safe += "&gt;"; break;
            case '"': safe += "&quot;"; break;
            default: safe += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
        }
    }
    return safe;
}

/// A page's coordinate: one decimal, none where it says nothing.
std::string number(double value) {
    std::string text = fmt::format("{:.1f}", value);
    if (text.ends_with(".0")) text.resize(text.size() - 2);
    return text == "-0" ? "0" : text;
}

/// From metres to the page: what is finite of all boxes fills it.
class Page {
public:
    explicit Page(const BoxPicture& picture) : seen_(picture.seen) {
        const auto reach = [](double value, double& lo, double& hi) {
            if (!(std::abs(value) < 1e30)) return;
            lo = std::min(lo, value);
            hi = std::max(hi, value);
        };
        constexpr double none = 1e300;
        double lo_u = none, hi_u = -none, lo_v = none, hi_v = -none;
        for (const PicturedBox& one : picture.boxes) {
            if (is_empty(one.box)) continue;
            for (const Vec3 corner : {one.box.lo, one.box.hi}) {
                reach(corner[across()], lo_u, hi_u);
                reach(corner[upward()], lo_v, hi_v);
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
            return height_ / 2 + (seen_ == Seen::FromAbove ? down : -down);
        };
        const double v1 = place_v(box.lo[upward()]), v2 = place_v(box.hi[upward()]);
        Rectangle r{place_u(box.lo[across()]), std::min(v1, v2), place_u(box.hi[across()]), std::max(v1, v2)};
        keep_within(r.left, r.right, page_width);
        keep_within(r.top, r.bottom, height_);
        return r;
    }

private:
    Seen seen_;
    double scale_ = 1, middle_u_ = 0, middle_v_ = 0, height_ = 0;

    [[nodiscard]] int across() const { return seen_ == Seen::FromSide ? 2 : 0; }
    [[nodiscard]] int upward() const { return seen_ == Seen::FromAbove ? 2 : 1; }
    static void keep_within(double& lo, double& hi, double size) {
        constexpr double inset = edge / 2;
        lo = std::clamp(lo, inset, size - inset);
        hi = std::clamp(hi, inset, size - inset);
        const double missing = min_side - (hi - lo);
        if (missing > 0) lo -= missing / 2, hi += missing / 2;
    }
};

struct KindLook {
    BoxKind kind;
    const char *name, *colour;
};
constexpr std::array<KindLook, 3> looks{{{BoxKind::Static, "static", "#8d96a3"},
                                         {BoxKind::Resting, "resting", "#3f7fd9"},
                                         {BoxKind::Awake, "awake", "#ee7b30"}}};

void draw_boxes(const BoxPicture& picture, const Page& page, std::string& svg) {
    for (const KindLook& look : looks) {
        std::vector<Rectangle> boxes;
        for (const PicturedBox& one : picture.boxes)
            if (one.kind == look.kind && !is_empty(one.box)) boxes.push_back(page.rectangle(one.box));
        if (boxes.empty()) continue;
        const auto area = [](const Rectangle& r) { return (r.right - r.left) * (r.bottom - r.top); };
        std::stable_sort(boxes.begin(), boxes.end(),  // small ones on large ones
                         [&](const Rectangle& a, const Rectangle& b) { return area(a) > area(b); });
        fmt::format_to(std::back_inserter(svg),
                       "<g fill=\"{0}\" fill-opacity=\".3\" stroke=\"{0}\" stroke-width=\".8\">\n", look.colour);
        for (const Rectangle& r : boxes)
            fmt::format_to(std::back_inserter(svg), "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n",
                           number(r.left), number(r.top), number(r.right - r.left), number(r.bottom - r.top));
        svg += "</g>\n";
    }
}

struct CellLine {
    std::string path;
    int depth;
};

/// Each cell that looks different once, the deepest first, so that those above are drawn over them.
std::vector<CellLine> cell_lines(const BoxPicture& picture, const Page& page) {
    std::vector<CellLine> lines;
    for (const broad::DrawnCell& cell : picture.cells) {
        if (is_empty(cell.box)) continue;
        const Rectangle r = page.rectangle(cell.box);
        const std::string width = number(r.right - r.left);
        lines.push_back(
            {fmt::format("M{} {}h{}v{}h-{}z", number(r.left), number(r.top), width, number(r.bottom - r.top), width),
             cell.depth});
    }
    std::sort(lines.begin(), lines.end(), [](const CellLine& a, const CellLine& b) {
        return a.path != b.path ? a.path < b.path : a.depth < b.depth;
    });
    lines.erase(
        std::unique(lines.begin(), lines.end(), [](const CellLine& a, const CellLine& b) { return a.path == b.path; }),
        lines.end());
    std::stable_sort(lines.begin(), lines.end(),
                     [](const CellLine& a, const CellLine& b) { return a.depth > b.depth; });
    return lines;
}

/// From dark blue at the root to sea green at the leaves.
std::string depth_colour(double share) {
    const auto between = [&](int root, int leaf) {
        return static_cast<int>(std::lround(root + (leaf - root) * share));
    };
    return fmt::format("#{:02x}{:02x}{:02x}", between(0x12, 0x2a), between(0x2b, 0xa1), between(0x5c, 0x98));
}

/// The shapes of all cells, a path a depth, and how they are used: as faint areas beneath the boxes, as lines above.
struct CellLayers {
    std::string shapes, areas, lines;
};

CellLayers cell_layers(const BoxPicture& picture, const Page& page) {
    const std::vector<CellLine> cells = cell_lines(picture, page);
    const int deepest = cells.empty() ? 0 : cells.front().depth;
    CellLayers layers;
    for (std::size_t i = 0; i < cells.size();) {
        const int depth = cells[i].depth;
        const double share = deepest > 0 ? static_cast<double>(depth) / deepest : 0.5;
        fmt::format_to(std::back_inserter(layers.shapes), "<path id=\"depth{}\" d=\"", depth);
        for (; i < cells.size() && cells[i].depth == depth; ++i) layers.shapes += cells[i].path;
        layers.shapes += "\"/>\n";
        fmt::format_to(std::back_inserter(layers.areas), "<use href=\"#depth{}\" fill=\"{}\"/>\n", depth,
                       depth_colour(share));
        fmt::format_to(std::back_inserter(layers.lines),
                       "<use href=\"#depth{}\" stroke=\"{}\" stroke-opacity=\"{:.2f}\" stroke-width=\"{:.1f}\"/>\n",
                       depth, depth_colour(share), 0.95 - 0.3 * share, 2.0 - 1.1 * share);
    }
    return layers;
}

void draw_legend(const BoxPicture& picture, std::string& svg) {
    fmt::format_to(std::back_inserter(svg),
                   "<text x=\"{0}\" y=\"28\" font-size=\"20\"><tspan font-weight=\"bold\">{1}</tspan>"
                   "<tspan dx=\"14\" font-size=\"14\" fill=\"#5b6470\">{2}</tspan></text>\n",
                   edge / 2, escaped(picture.title), escaped(picture.note));
    double x = edge / 2;
    const auto entry = [&](const std::string& sign, const std::string& name) {
        fmt::format_to(std::back_inserter(svg),
                       "<g transform=\"translate({} 42)\">{}<text x=\"24\" y=\"10.5\" font-size=\"13\">{}</text></g>\n",
                       number(x), sign, name);
        x += 46 + 7 * static_cast<double>(name.size());
    };
    for (const KindLook& look : looks) {
        const auto count = std::count_if(picture.boxes.begin(), picture.boxes.end(),
                                         [&](const PicturedBox& one) { return one.kind == look.kind; });
        if (count == 0) continue;
        entry(fmt::format("<rect width=\"18\" height=\"12\" fill=\"{0}\" fill-opacity=\".3\" stroke=\"{0}\"/>",
                          look.colour),
              fmt::format("{} {}", count, look.name));
    }
    int deepest = 0;
    for (const broad::DrawnCell& cell : picture.cells) deepest = std::max(deepest, cell.depth);
    if (picture.cells.empty()) return;
    entry(fmt::format("<path d=\"M0 2h18\" stroke=\"{}\" stroke-width=\"2\"/><path d=\"M0 9h18\" stroke=\"{}\" "
                      "stroke-width=\".9\"/>",
                      depth_colour(0), depth_colour(1)),
          deepest == 0 ? std::string("cells") : fmt::format("cells, depth 0 to {}", deepest));
}

}  // namespace

std::string svg_of(const BoxPicture& picture) {
    const Page page(picture);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" "
        "font-family=\"system-ui, 'DejaVu Sans', Arial, sans-serif\" fill=\"#1f2733\">\n<title>{2}: {3}</title>\n"
        "<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
        number(page_width), number(page.height() + legend_height), escaped(picture.title), escaped(picture.note));
    draw_legend(picture, svg);
    fmt::format_to(std::back_inserter(svg), "<g transform=\"translate(0 {})\">\n", number(legend_height));
    const CellLayers cells = cell_layers(picture, page);
    svg += "<defs>\n" + cells.shapes + "</defs>\n<g fill-opacity=\".035\">\n" + cells.areas + "</g>\n";
    draw_boxes(picture, page, svg);
    svg += "<g fill=\"none\">\n" + cells.lines + "</g>\n</g>\n</svg>\n";
    return svg;
}

}  // namespace fase::record
