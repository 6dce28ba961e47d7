/// Boost.Geometry's R-tree in `fase bench queries`: boxes that overlap a box.
#include "bench/peers/boost_rtree.hpp"

#include <boost/function_output_iterator.hpp>
#include <boost/version.hpp>
#include <utility>

#include "bench/peers/boost_tree.hpp"

namespace fase::bench {
namespace {

using namespace boost_tree;

class BoostRtree final : public QueryContender {
public:
    [[nodiscard]] bool offers(QueryKind kind, const QueryScene&) const override { return kind == QueryKind::Boxes; }
    void build(const QueryScene& scene) override { move(scene.boxes); }
    void move(std::span<const broad::Move> boxes) override {
        entries_.clear();
        for (const broad::Move& m : boxes) entries_.emplace_back(to_boost(m.box), m.proxy);
        tree_ = Tree(entries_);
    }
    void rays(std::span<const Ray>, std::vector<query::Hit>&) const override {}
    void boxes(std::span<const Aabb> boxes, AnswerLists& out) const override {
        for (const Aabb& box : boxes) {
            const auto append = [&](const Entry& entry) { out.proxies.push_back(entry.second); };
            tree_.query(bg::index::intersects(to_boost(box)), boost::make_function_output_iterator(append));
            out.ends.push_back(out.proxies.size());
        }
    }
    void frusta(std::span<const Frustum>, AnswerLists&) const override {}
    [[nodiscard]] std::string settings() const override {
        return "Boost " BOOST_LIB_VERSION " R-tree, quadratic, 16 a node, packed";
    }

private:
    using Tree = bg::index::rtree<Entry, bg::index::quadratic<16>>;
    std::vector<Entry> entries_;
    Tree tree_;
};

}  // namespace

std::unique_ptr<QueryContender> make_boost_rtree(std::string_view) { return std::make_unique<BoostRtree>(); }

}  // namespace fase::bench
