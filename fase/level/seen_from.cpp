/// A walk through openings, from the eye on.
#include "fase/level/seen_from.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fase/level/level_order.hpp"
#include "fase/level/level_place.hpp"

namespace fase::level {
namespace {

constexpr std::size_t max_steps = 1'000'000;
/// Angles less wide than this (their sine) are not followed.
constexpr double narrowest = 0x1p-40;

Point between(Point a, Point b, double share) { return {a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share}; }

/// Appends the part of a row of corners on the left of the way from a to b; or on the right.
void cut(const std::vector<Point>& row, Point a, Point b, bool left, std::vector<Point>& out) {
    out.clear();
    for (std::size_t i = 0; i < row.size(); ++i) {
        const Point p = row[i], q = row[(i + 1) % row.size()];
        const double sp = left ? turn(a, b, p) : turn(b, a, p), sq = left ? turn(a, b, q) : turn(b, a, q);
        if (sp >= 0) out.push_back(p);
        if ((sp > 0 && sq < 0) || (sp < 0 && sq > 0)) out.push_back(between(p, q, sp / (sp - sq)));
    }
}

/// A stretch of an opening, and the sub-sector seen through it.
struct Look {
    std::uint32_t sub_sector = 0;
    Point right, left;
    double least = -std::numeric_limits<double>::infinity();  ///< slope of lines from the eye
    double most = std::numeric_limits<double>::infinity();
};

class Looker {
public:
    Looker(const LevelBsp& bsp, const Map& map, const Eye& eye, Heights heights)
        : bsp_(bsp), map_(map), eye_(eye), heights_(heights) {}

    SeenFrom look(std::uint32_t at) {
        row_.clear();
        for (const Seg& seg : bsp_.edges(bsp_.sub_sectors[at])) row_.push_back(bsp_.vertices[seg.from]);
        add_part(at);
        go_on({at, {}, {}}, true);
        for (std::size_t steps = 1; !looks_.empty(); ++steps) {
            if (steps == max_steps) {
                seen_.complete = false;
                break;
            }
            const Look look = looks_.back();
            looks_.pop_back();
            row_.clear();
            for (const Seg& seg : bsp_.edges(bsp_.sub_sectors[look.sub_sector]))
                row_.push_back(bsp_.vertices[seg.from]);
            cut(row_, eye_.at, look.right, true, other_);
            cut(other_, eye_.at, look.left, false, row_);
            add_part(look.sub_sector);
            go_on(look, false);
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
    std::vector<Look> looks_;
    std::vector<Point> row_, other_;

    void add_part(std::uint32_t sub_sector) {
        seen_.sub_sectors.push_back(sub_sector);
        if (row_.size() < 3) return;
        double twice = 0;
        for (std::size_t i = 2; i < row_.size(); ++i) twice -= turn(row_[0], row_[i - 1], row_[i]);
        seen_.area += 0.5 * twice;
        seen_.corners.insert(seen_.corners.end(), row_.begin(), row_.end());
        seen_.part_ends.push_back(static_cast<std::uint32_t>(seen_.corners.size()));
    }

    [[nodiscard]] double distance(Point p) const {
        return std::sqrt((p.x - eye_.at.x) * (p.x - eye_.at.x) + (p.y - eye_.at.y) * (p.y - eye_.at.y));
    }

    /// Looks through the openings of a sub-sector, as far as the look into it allows.
    void go_on(const Look& look, bool all_around) {
        for (const Seg& seg : bsp_.edges(bsp_.sub_sectors[look.sub_sector])) {
            if (seg.partner == no_seg) continue;
            const Point from = bsp_.vertices[seg.from], to = bsp_.vertices[seg.to];
            Look next{bsp_.segs[seg.partner].sub_sector, to, from, look.least, look.most};
            if (turn(from, to, eye_.at) > 0) continue;  // one comes in through it
            if (!all_around && !narrow(next, look)) continue;
            const double wide = turn(eye_.at, next.right, next.left);
            const double right = distance(next.right), left = distance(next.left);
            if (!(wide > narrowest * right * left) && !(all_around && turn(from, to, eye_.at) == 0)) continue;
            if (heights_ == Heights::Counted && !rise(next, opening_between(bsp_, map_, seg))) continue;
            looks_.push_back(next);
        }
    }

    /// What of an opening lies between the edges of a look.
    bool narrow(Look& next, const Look& look) const {
        const double right_r = turn(eye_.at, look.right, next.right), left_r = turn(eye_.at, look.right, next.left);
        if (left_r <= 0) return false;
        if (right_r < 0) next.right = between(next.right, next.left, right_r / (right_r - left_r));
        const double right_l = turn(eye_.at, look.left, next.right), left_l = turn(eye_.at, look.left, next.left);
        if (right_l >= 0) return false;
        if (left_l > 0) next.left = between(next.left, next.right, left_l / (left_l - right_l));
        return true;
    }

    /// What slopes get through an opening.
    bool rise(Look& next, const Opening& opening) const {
        if (!opening.is_open()) return false;
        const double far = std::max(distance(next.right), distance(next.left));
        // Nearest to the foot of the perpendicular, if that lies within.
        const double dx = next.left.x - next.right.x, dy = next.left.y - next.right.y, squared = dx * dx + dy * dy;
        const double share =
            squared > 0 ? ((eye_.at.x - next.right.x) * dx + (eye_.at.y - next.right.y) * dy) / squared : 0;
        const double near = distance(between(next.right, next.left, std::clamp(share, 0.0, 1.0)));
        const double up = opening.ceiling - eye_.z, down = opening.floor - eye_.z;
        if (near > 0) {
            next.most = std::min(next.most, up / (up > 0 ? near : far));
            next.least = std::max(next.least, down / (down > 0 ? far : near));
        }
        return next.least <= next.most;
    }
};

}  // namespace

std::optional<SeenFrom> seen_from(const LevelBsp& bsp, const Map& map, const Eye& eye, Heights heights) {
    if (!std::isfinite(eye.at.x) || !std::isfinite(eye.at.y) || !std::isfinite(eye.z)) return std::nullopt;
    const auto at = sub_sector_at(bsp, eye.at);
    if (!at) return std::nullopt;
    return Looker(bsp, map, eye, heights).look(*at);
}

}  // namespace fase::level
