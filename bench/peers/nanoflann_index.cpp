/// nanoflann's k-d tree in `fase bench index`: points only, so boxes of one size are centres with another distance.
#include <cmath>
#include <nanoflann.hpp>
#include <string>

#include "bench/index_contender.hpp"
#include "fase/query/detail/near_pairs.hpp"

namespace fase::bench {
namespace {

/// The centres, and by how much they are nearer on each axis because they have boxes.
struct Centres {
    std::span<const Unit> units;
    Vec3 nearer{};

    [[nodiscard]] std::size_t kdtree_get_point_count() const { return units.size(); }
    [[nodiscard]] float kdtree_get_pt(std::size_t i, std::size_t axis) const {
        return axis == 0 ? units[i].x : axis == 1 ? units[i].y : units[i].z;
    }
    template <class Bounds> bool kdtree_get_bbox(Bounds&) const { return false; }
};

/// The square of the distance to a box, or between boxes. Grows with each axis, as the tree requires.
struct BoxDistance {
    using ElementType = float;
    using DistanceType = float;
    explicit BoxDistance(const Centres& centres) : centres_(centres) {}

    [[nodiscard]] float evalMetric(const float* a, std::uint32_t b, std::size_t) const {
        return accum_dist(a[0], centres_.kdtree_get_pt(b, 0), 0) + accum_dist(a[1], centres_.kdtree_get_pt(b, 1), 1) +
               accum_dist(a[2], centres_.kdtree_get_pt(b, 2), 2);
    }
    [[nodiscard]] float accum_dist(float a, float b, std::size_t axis) const {
        const float gap = std::max(std::abs(a - b) - centres_.nearer[static_cast<int>(axis)], 0.0f);
        return gap * gap;
    }

private:
    const Centres& centres_;
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<BoxDistance, Centres, 3, std::uint32_t>;

/// Passes each unit within a distance on, so that nothing is stored.
template <class F> struct Visitor {
    float reach;  // squared
    const F& f;
    [[nodiscard]] float worstDist() const { return reach; }
    [[nodiscard]] bool full() const { return true; }
    [[nodiscard]] std::size_t size() const { return 0; }
    bool addPoint(float, std::uint32_t unit) const {
        f(unit);
        return true;
    }
};

class NanoflannIndex final : public IndexContender {
public:
    [[nodiscard]] bool offers(IndexQuestion question) const override {
        return question == IndexQuestion::Moves || question == IndexQuestion::NeighboursMoved ||
               question == IndexQuestion::Neighbours || question == IndexQuestion::NearestMoved ||
               question == IndexQuestion::Nearest || question == IndexQuestion::NearestEight;
    }
    void move(std::span<const Unit> units) override {
        units_.assign(units.begin(), units.end());
        centres_.units = units_;
        tree_ = std::make_unique<Tree>(3, centres_, nanoflann::KDTreeSingleIndexAdaptorParams(10));
    }
    void neighbours(float radius, Tally& tally) override {
        centres_.nearer = unit_half + unit_half;
        for (std::uint32_t a = 0; a < units_.size(); ++a) {
            const Aabb box = box_of(units_[a]);
            const auto visit = [&](std::uint32_t b) {
                if (a < b && query::squared_distance(box, box_of(units_[b])) <= radius * radius) tally.add(a, b);
            };
            // A little more, as the tree rounds otherwise: the distance of the boxes decides.
            const Visitor<decltype(visit)> visitor{radius * radius * 1.001f, visit};
            find(visitor, units_[a].x, units_[a].y, units_[a].z);
        }
    }
    void nearest(std::span<const Vec3d> places, std::size_t k, std::vector<query::Hit>& out) override {
        centres_.nearer = unit_half;
        numbers_.resize(k);
        squares_.resize(k);
        for (const Vec3d place : places) {
            nanoflann::KNNResultSet<float, std::uint32_t> found(k);
            found.init(numbers_.data(), squares_.data());
            find(found, static_cast<float>(place.x), static_cast<float>(place.y), static_cast<float>(place.z));
            for (std::size_t i = 0; i < found.size(); ++i) out.push_back({std::sqrt(squares_[i]), numbers_[i]});
        }
    }
    [[nodiscard]] std::string settings() const override {
        const auto digit = [](int n) { return std::to_string(n % 16); };
        return "nanoflann " + digit(NANOFLANN_VERSION / 256) + "." + digit(NANOFLANN_VERSION / 16) + "." +
               digit(NANOFLANN_VERSION) + " k-d tree over centres, leaves of 10, built each frame";
    }

private:
    template <class Found> void find(Found& found, float x, float y, float z) const {
        const float point[3]{x, y, z};
        tree_->findNeighbors(found, point, nanoflann::SearchParams());
    }

    std::vector<Unit> units_;
    Centres centres_;
    std::unique_ptr<Tree> tree_;
    std::vector<std::uint32_t> numbers_;
    std::vector<float> squares_;
};

}  // namespace

std::unique_ptr<IndexContender> make_nanoflann_index(const IndexUse&) { return std::make_unique<NanoflannIndex>(); }

}  // namespace fase::bench
