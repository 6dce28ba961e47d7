/// Boost's R-tree in `fase bench index`.
#include <boost/iterator/function_output_iterator.hpp>
#include <boost/version.hpp>
#include <cmath>
#include <utility>

#include "bench/index_contender.hpp"
#include "bench/peers/boost_tree.hpp"
#include "fase/query/detail/near_pairs.hpp"

namespace fase::bench {
namespace {

using namespace boost_tree;
using Tree = bg::index::rtree<Entry, bg::index::rstar<16>>;

/// Packs the tree again in each frame, which is far faster than removing and inserting all boxes. Finds neighbours with
/// one query for each box.
class BoostIndex final : public IndexContender {
public:
    [[nodiscard]] bool offers(IndexQuestion question) const override { return question != IndexQuestion::Rays; }
    void move(std::span<const Unit> units) override {
        boxes_.clear();
        entries_.clear();
        for (const Unit& unit : units) {
            boxes_.push_back(box_of(unit));
            entries_.emplace_back(to_boost(boxes_.back()), static_cast<std::uint32_t>(entries_.size()));
        }
        tree_ = Tree(entries_);
    }
    void neighbours(float radius, Tally& tally) override {
        const float reach = radius * 1.00001f;  // the distance decides
        for_each_in_grown(reach, [&](std::uint32_t a, std::uint32_t b) {
            if (query::squared_distance(boxes_[a], boxes_[b]) <= radius * radius) tally.add(a, b);
        });
    }
    void grown_pairs(float radius, Tally& tally) override {
        const float half = 0.5f * radius;
        const Vec3 growth{half, half, half};
        for_each_in_grown(radius * 1.00001f, [&](std::uint32_t a, std::uint32_t b) {
            if (overlaps({boxes_[a].lo - growth, boxes_[a].hi + growth},
                         {boxes_[b].lo - growth, boxes_[b].hi + growth}))
                tally.add(a, b);
        });
    }
    void rectangles(std::span<const Aabb> rectangles, Tally& tally) override {
        for (const Aabb& rectangle : rectangles)
            tree_.query(bg::index::intersects(to_boost(rectangle)),
                        boost::make_function_output_iterator([&](const Entry& found) { tally.add(found.second); }));
    }
    void nearest(std::span<const Vec3d> places, std::size_t k, std::vector<query::Hit>& out) override {
        for (const Vec3d place : places) {
            const auto first = static_cast<std::ptrdiff_t>(out.size());
            const Point point = to_boost(to_float(place));
            const auto append = [&](const Entry& found) {
                out.push_back({static_cast<float>(bg::distance(point, found.first)), found.second});
            };
            tree_.query(bg::index::nearest(point, static_cast<unsigned>(k)),
                        boost::make_function_output_iterator(append));
            std::sort(out.begin() + first, out.end());
        }
    }
    [[nodiscard]] std::string settings() const override {
        return "Boost " BOOST_LIB_VERSION " R-tree, rstar<16>, packed each frame";
    }

private:
    /// Calls f for each pair of which one box, larger by `reach`, overlaps the other.
    template <class F> void for_each_in_grown(float reach, const F& f) const {
        const Vec3 growth{reach, reach, reach};
        for (std::uint32_t a = 0; a < boxes_.size(); ++a)
            tree_.query(bg::index::intersects(to_boost({boxes_[a].lo - growth, boxes_[a].hi + growth})),
                        boost::make_function_output_iterator([&](const Entry& found) {
                            if (a < found.second) f(a, found.second);
                        }));
    }

    std::vector<Aabb> boxes_;
    std::vector<Entry> entries_;
    Tree tree_;
};

}  // namespace

std::unique_ptr<IndexContender> make_boost_index(const IndexUse&) { return std::make_unique<BoostIndex>(); }

}  // namespace fase::bench
