/// Traverses openings, starting at the eye.
#include "fase/level/seen_from.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fase/level/level_order.hpp"
#include "fase/level/level_place.hpp"

namespace fase::level {
namespace {

constexpr std::size_t max_steps = 1'000'000;
/// Views with a smaller sine of their angle are not followed.
constexpr double min_sine = 0x1p-40;

/// Clips a polygon to the left, or to the right, of the line from a to b.
void clip(const std::vector<Point>& polygon, Point a, Point b, bool left, std::vector<Point>& out) {
    out.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point p = polygon[i], q = polygon[(i + 1) % polygon.size()];
        const double sp = left ? orient2d(a, b, p) : orient2d(b, a, p),
                     sq = left ? orient2d(a, b, q) : orient2d(b, a, q);
        if (sp >= 0) out.push_back(p);
        if ((sp > 0 && sq < 0) || (sp < 0 && sq > 0)) out.push_back(between(p, q, sp / (sp - sq)));
    }
}

/// The view through a part of an opening into the sub-sector behind it.
struct View {
    std::uint32_t sub_sector = 0;
    Point right, left;
    double min_slope = -std::numeric_limits<double>::infinity();  ///< of lines from the eye
    double max_slope = std::numeric_limits<double>::infinity();
};

/// Collects the views from one eye.
class PortalWalker {
public:
    PortalWalker(const LevelBsp& bsp, const Map& map, const Eye& eye, Heights heights)
        : bsp_(bsp), map_(map), eye_(eye), heights_(heights) {}

    SeenFrom walk(std::uint32_t start) {
        polygon_.clear();
        for (const Seg& seg : bsp_.edges(bsp_.sub_sectors[start])) polygon_.push_back(bsp_.vertices[seg.from]);
        add_part(start);
        add_views({start, {}, {}}, true);
        for (std::size_t steps = 1; !views_.empty(); ++steps) {
            if (steps == max_steps) {
                seen_.complete = false;
                break;
            }
            const View view = views_.back();
            views_.pop_back();
            polygon_.clear();
            for (const Seg& seg : bsp_.edges(bsp_.sub_sectors[view.sub_sector]))
                polygon_.push_back(bsp_.vertices[seg.from]);
            clip(polygon_, eye_.position, view.right, true, clipped_);
            clip(clipped_, eye_.position, view.left, false, polygon_);
            add_part(view.sub_sector);
            add_views(view, false);
        }
        std::sort(seen_.sub_sectors.begin(), seen_.sub_sectors.end());
        seen_.sub_sectors.erase(std::unique(seen_.sub_sectors.begin(), seen_.sub_sectors.end()),
                                seen_.sub_sectors.end());
        return std::move(seen_);
    }

private:
    const LevelBsp& bsp_;
    const Map& map_;
    const Eye& eye_;
    Heights heights_;
    SeenFrom seen_;
    std::vector<View> views_;
    std::vector<Point> polygon_, clipped_;

    void add_part(std::uint32_t sub_sector) {
        seen_.sub_sectors.push_back(sub_sector);
        if (polygon_.size() < 3) return;
        double twice = 0;
        for (std::size_t i = 2; i < polygon_.size(); ++i) twice -= orient2d(polygon_[0], polygon_[i - 1], polygon_[i]);
        seen_.area += 0.5 * twice;
        seen_.corners.insert(seen_.corners.end(), polygon_.begin(), polygon_.end());
        seen_.part_ends.push_back(static_cast<std::uint32_t>(seen_.corners.size()));
    }

    [[nodiscard]] double distance(Point p) const {
        return std::sqrt((p.x - eye_.position.x) * (p.x - eye_.position.x) +
                         (p.y - eye_.position.y) * (p.y - eye_.position.y));
    }

    /// Adds the views through the openings of a sub-sector, clipped to the view into it. `first`: the eye is in it.
    void add_views(const View& view, bool first) {
        for (const Seg& seg : bsp_.edges(bsp_.sub_sectors[view.sub_sector])) {
            if (seg.partner == no_index) continue;
            const Point from = bsp_.vertices[seg.from], to = bsp_.vertices[seg.to];
            View next{bsp_.segs[seg.partner].sub_sector, to, from, view.min_slope, view.max_slope};
            if (orient2d(from, to, eye_.position) > 0) continue;  // the view enters through it
            if (!first && !clip_to_view(next, view)) continue;
            const double wide = orient2d(eye_.position, next.right, next.left);
            const double right = distance(next.right), left = distance(next.left);
            if (!(wide > min_sine * right * left) && !(first && orient2d(from, to, eye_.position) == 0)) continue;
            if (heights_ == Heights::Counted && !clip_slopes(next, opening_between(bsp_, map_, seg))) continue;
            views_.push_back(next);
        }
    }

    /// Clips an opening to the edges of a view. Returns false if nothing is left.
    bool clip_to_view(View& next, const View& view) const {
        const double right_r = orient2d(eye_.position, view.right, next.right),
                     left_r = orient2d(eye_.position, view.right, next.left);
        if (left_r <= 0) return false;
        if (right_r < 0) next.right = between(next.right, next.left, right_r / (right_r - left_r));
        const double right_l = orient2d(eye_.position, view.left, next.right),
                     left_l = orient2d(eye_.position, view.left, next.left);
        if (right_l >= 0) return false;
        if (left_l > 0) next.left = between(next.left, next.right, left_l / (left_l - right_l));
        return true;
    }

    /// Clips the slopes of a view to an opening. Returns false if nothing is left.
    bool clip_slopes(View& next, const Opening& opening) const {
        if (!opening.is_open()) return false;
        const double far = std::max(distance(next.right), distance(next.left));
        // The nearest point is the foot of the perpendicular, if it is inside the opening.
        const double dx = next.left.x - next.right.x, dy = next.left.y - next.right.y, squared = dx * dx + dy * dy;
        const double share =
            squared > 0 ? ((eye_.position.x - next.right.x) * dx + (eye_.position.y - next.right.y) * dy) / squared : 0;
        const double near = distance(between(next.right, next.left, std::clamp(share, 0.0, 1.0)));
        const double up = opening.ceiling - eye_.z, down = opening.floor - eye_.z;
        if (near > 0) {
            next.max_slope = std::min(next.max_slope, up / (up > 0 ? near : far));
            next.min_slope = std::max(next.min_slope, down / (down > 0 ? far : near));
        }
        return next.min_slope <= next.max_slope;
    }
};

}  // namespace

std::optional<SeenFrom> seen_from(const LevelBsp& bsp, const Map& map, const Eye& eye, Heights heights) {
    if (!std::isfinite(eye.position.x) || !std::isfinite(eye.position.y) || !std::isfinite(eye.z)) return std::nullopt;
    const auto start = sub_sector_at(bsp, eye.position);
    if (!start) return std::nullopt;
    return PortalWalker(bsp, map, eye, heights).walk(*start);
}

}  // namespace fase::level
