/// Rasterizes drawings: computes the coverage of each pixel, row by row, with four scan lines a row.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "fase/level/drawing.hpp"

namespace fase::level {
namespace {

/// The strokes of a character on a grid of 4 by 6, y upward; a bar separates strokes.
struct Glyph {
    char character;
    std::string_view strokes;
};
constexpr Glyph glyphs[] = {
    {'A', "00 26 40|12 32"},
    {'B', "00 06 36 45 44 33 42 41 30 00|03 33"},
    {'C', "45 36 16 05 01 10 30 41"},
    {'D', "00 06 26 45 41 20 00"},
    {'E', "40 00 06 46|03 33"},
    {'F', "00 06 46|03 33"},
    {'G', "45 36 16 05 01 10 30 41 43 23"},
    {'H', "00 06|40 46|03 43"},
    {'I', "10 30|20 26|16 36"},
    {'J', "01 10 20 31 36"},
    {'K', "00 06|46 03 40"},
    {'L', "06 00 40"},
    {'M', "00 06 23 46 40"},
    {'N', "00 06 40 46"},
    {'O', "10 01 05 16 36 45 41 30 10"},
    {'P', "00 06 36 45 44 33 03"},
    {'Q', "10 01 05 16 36 45 41 30 10|22 40"},
    {'R', "00 06 36 45 44 33 03|23 40"},
    {'S', "45 36 16 05 04 13 33 42 41 30 10 01"},
    {'T', "06 46|26 20"},
    {'U', "06 01 10 30 41 46"},
    {'V', "06 20 46"},
    {'W', "06 10 23 30 46"},
    {'X', "00 46|06 40"},
    {'Y', "06 23 46|23 20"},
    {'Z', "06 46 00 40"},
    {'0', "10 01 05 16 36 45 41 30 10|02 44"},
    {'1', "15 26 20|10 30"},
    {'2', "05 16 36 45 44 00 40"},
    {'3', "05 16 36 45 44 33 42 41 30 10 01|13 33"},
    {'4', "30 36 02 42"},
    {'5', "46 06 03 33 42 41 30 10 01"},
    {'6', "45 36 16 05 01 10 30 41 42 33 03"},
    {'7', "06 46 10"},
    {'8', "13 04 05 16 36 45 44 33 13 02 01 10 30 41 42 33"},
    {'9', "01 10 30 41 45 36 16 05 04 13 43"},
    {'.', "20 21"},
    {',', "21 10"},
    {':', "21 22|24 25"},
    {'-', "13 33"},
    {'+', "03 43|21 25"},
    {'/', "00 46"},
    {'%', "00 46|05 16|30 41"},
    {'(', "36 24 22 30"},
    {')', "16 24 22 10"},
};

/// Draws marks over each other.
class Rasterizer {
public:
    Rasterizer(const Drawing& drawing, double scale) : scale_(scale) {
        constexpr int max_side = 16384;
        pixels_.width = std::clamp(static_cast<int>(std::ceil(drawing.width * scale)), 1, max_side);
        pixels_.height = std::clamp(static_cast<int>(std::ceil(drawing.height * scale)), 1, max_side);
        pixels_.rgba.assign(4 * static_cast<std::size_t>(pixels_.width) * static_cast<std::size_t>(pixels_.height),
                            255);
        cover_.resize(static_cast<std::size_t>(pixels_.width) + 2);
    }

    void draw(const Mark& mark) {
        switch (mark.kind) {
            case Mark::Kind::Polygon: {
                std::vector<Point> corners;
                for (const Point p : mark.points) corners.push_back({p.x * scale_, p.y * scale_});
                fill(corners, mark.colour);
                break;
            }
            case Mark::Kind::Line:
                for (std::size_t i = 0; i + 1 < mark.points.size(); ++i)
                    stroke(mark.points[i], mark.points[i + 1], mark.size, mark.colour);
                break;
            case Mark::Kind::Text: draw_text(mark); break;
        }
    }
    Pixels&& release() { return std::move(pixels_); }

private:
    static constexpr int lines_a_row = 4;
    double scale_;
    Pixels pixels_;
    std::vector<float> cover_;  ///< of the current row: differences of coverage from pixel to pixel
    std::vector<double> crossings_;

    void stroke(Point from, Point to, double width, Colour colour) {
        const double half = std::max(width * scale_, 0.7) / 2;
        const Point a{from.x * scale_, from.y * scale_}, b{to.x * scale_, to.y * scale_};
        const double length = std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
        if (!(length > 0)) return;
        const double x = (b.x - a.x) / length * half, y = (b.y - a.y) / length * half, cap = 0.5;
        const Point from_end{a.x - cap * x, a.y - cap * y}, to_end{b.x + cap * x, b.y + cap * y};
        const std::array<Point, 4> corners{{{from_end.x - y, from_end.y + x},
                                            {to_end.x - y, to_end.y + x},
                                            {to_end.x + y, to_end.y - x},
                                            {from_end.x + y, from_end.y - x}}};
        fill(corners, colour);
    }

    void draw_text(const Mark& mark) {
        const double unit = mark.size / 6;
        Point pen = mark.points[0];
        for (const char c : mark.text) {
            const char upper = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
            const auto* glyph = std::find_if(std::begin(glyphs), std::end(glyphs),
                                             [&](const Glyph& one) { return one.character == upper; });
            if (glyph != std::end(glyphs)) {
                const std::string_view s = glyph->strokes;
                for (std::size_t i = 0; i + 4 < s.size(); i += 3) {
                    if (s[i + 2] == '|') continue;
                    const auto point = [&](std::size_t k) {
                        return Point{pen.x + (s[k] - '0') * unit, pen.y - (s[k + 1] - '0') * unit};
                    };
                    stroke(point(i), point(i + 3), unit, mark.colour);
                }
            }
            pen.x += (glyph == std::end(glyphs) ? 4 : 6) * unit;
        }
    }

    /// Fills a polygon by the even-odd rule.
    template <class Corners> void fill(const Corners& corners, Colour colour) {
        double top = 1e30, bottom = -1e30;
        for (const Point p : corners) {
            top = std::min(top, p.y);
            bottom = std::max(bottom, p.y);
        }
        const int first = std::max(static_cast<int>(std::floor(std::max(top, -1.0))), 0);
        const int last = std::min(static_cast<int>(std::floor(std::min(bottom, 1e6))), pixels_.height - 1);
        for (int row = first; row <= last; ++row) {
            int left = pixels_.width, right = -1;
            for (int k = 0; k < lines_a_row; ++k) {
                find_crossings(corners, row + (k + 0.5) / lines_a_row);
                for (std::size_t i = 0; i + 1 < crossings_.size(); i += 2)
                    cover(crossings_[i], crossings_[i + 1], left, right);
            }
            blend(row, left, right, colour);
        }
    }
    template <class Corners> void find_crossings(const Corners& corners, double y) {
        crossings_.clear();
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Point p = corners[i], q = corners[(i + 1) % corners.size()];
            if ((p.y <= y) == (q.y <= y)) continue;
            const double x = p.x + (y - p.y) / (q.y - p.y) * (q.x - p.x);
            crossings_.push_back(std::clamp(x, 0.0, static_cast<double>(pixels_.width)));
        }
        std::sort(crossings_.begin(), crossings_.end());
    }
    /// Adds an interval of one scan line, as differences: O(1) for any length.
    void cover(double from, double to, int& left, int& right) {
        if (!(from < to)) return;
        constexpr float share = 1.0F / lines_a_row;
        for (const auto& [x, sign] : {std::pair(from, share), std::pair(to, -share)}) {
            const int pixel = static_cast<int>(x);
            const auto within = static_cast<float>(x - pixel);
            cover_[static_cast<std::size_t>(pixel)] += sign * (1 - within);
            cover_[static_cast<std::size_t>(pixel) + 1] += sign * within;
        }
        left = std::min(left, static_cast<int>(from));
        right = std::max(right, static_cast<int>(to));
    }
    void blend(int row, int left, int right, Colour colour) {
        float covered = 0;
        for (int x = left; x <= right + 1; ++x) {
            covered += std::exchange(cover_[static_cast<std::size_t>(x)], 0.0F);
            if (x >= pixels_.width) continue;
            const float alpha = std::clamp(covered, 0.0F, 1.0F) * static_cast<float>(colour.alpha) / 255;
            if (alpha <= 0.002F) continue;
            std::uint8_t* pixel =
                pixels_.rgba.data() + 4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(pixels_.width) +
                                           static_cast<std::size_t>(x));
            const std::array<std::uint8_t, 3> components{colour.red, colour.green, colour.blue};
            for (std::size_t k = 0; k < 3; ++k) {
                const float mixed =
                    static_cast<float>(pixel[k]) * (1 - alpha) + static_cast<float>(components[k]) * alpha;
                pixel[k] = static_cast<std::uint8_t>(mixed + 0.5F);
            }
        }
    }
};

}  // namespace

Pixels pixels_of(const Drawing& drawing, double scale) {
    Rasterizer rasterizer(drawing, scale);
    for (const Mark& mark : drawing.marks) rasterizer.draw(mark);
    return rasterizer.release();
}

}  // namespace fase::level
