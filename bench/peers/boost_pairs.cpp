/// Boost's R-tree in `fase bench pairs`.
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>
#include <boost/version.hpp>

#include "bench/pair_engine.hpp"

namespace fase::bench {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::point<float, 3, bg::cs::cartesian>;
using Box = bg::model::box<Point>;
using Entry = std::pair<Box, broad::Proxy>;
using Tree = bg::index::rtree<Entry, bg::index::rstar<16>>;

Box to_boost(const Aabb& box) { return {Point(box.lo.x, box.lo.y, box.lo.z), Point(box.hi.x, box.hi.y, box.hi.z)}; }

/// Packs the tree again in each frame, which is far faster than removing and inserting the moved boxes; then queries
/// the tree once per box.
class BoostPairs final : public PairEngine {
public:
    explicit BoostPairs(const PairScene& scene) : scene_(scene) { update(scene.boxes); }
    void update(std::span<const Aabb> boxes) override {
        entries_.clear();
        for (const Aabb& box : boxes) entries_.emplace_back(to_boost(box), static_cast<broad::Proxy>(entries_.size()));
        tree_ = Tree(entries_);
    }
    void find_pairs(std::vector<Pair>& out) override {
        for (const Entry& entry : entries_) {
            const broad::Proxy p = entry.second;
            const auto append = boost::make_function_output_iterator([&](const Entry& other) {
                if (p < other.second && !scene_.both_static(p, other.second)) out.push_back({p, other.second});
            });
            tree_.query(bg::index::intersects(entry.first), append);
        }
    }
    [[nodiscard]] std::string settings() const override {
        return "Boost " + std::to_string(BOOST_VERSION / 100000) + "." + std::to_string(BOOST_VERSION / 100 % 1000) +
               " rtree, rstar<16>, packed each frame";
    }

private:
    PairScene scene_;
    std::vector<Entry> entries_;
    Tree tree_;
};

}  // namespace

std::unique_ptr<PairEngine> make_boost_pairs(const PairScene& scene, const std::string&) {
    return std::make_unique<BoostPairs>(scene);
}

}  // namespace fase::bench
