/// Boost's R-tree in `fase bench pairs`.
#include <boost/iterator/function_output_iterator.hpp>
#include <boost/version.hpp>

#include "bench/pair_engine.hpp"
#include "bench/peers/boost_tree.hpp"

namespace fase::bench {
namespace {

using namespace boost_tree;
using Tree = bg::index::rtree<Entry, bg::index::rstar<16>>;

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
