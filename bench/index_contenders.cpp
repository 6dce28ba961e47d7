/// THE list of contenders of `fase bench index`, and those of Fase.
#include "bench/index_contender.hpp"

#include <atomic>

#include "fase/broad/row_grid.hpp"
#include "fase/query/index.hpp"

namespace fase::bench {
namespace {

constexpr std::size_t pairs_per_task = 8192;

/// Adds pairs on the threads of `tasks`.
void add_pairs(TaskRunner* tasks, std::span<const broad::Pair> pairs, Tally& tally) {
    if (tasks == nullptr) {
        for (const broad::Pair pair : pairs) tally.add(pair.a, pair.b);
        return;
    }
    std::atomic<std::uint64_t> sum = 0;
    parallel_ranges(*tasks, pairs.size(), pairs_per_task, [&](std::size_t begin, std::size_t end) {
        Tally part;
        for (const broad::Pair pair : pairs.subspan(begin, end - begin)) part.add(pair.a, pair.b);
        sum += part.sum;
    });
    tally.add({pairs.size(), sum});
}

/// An index whose values are the numbers of the units.
template <class... Structure> class FaseIndex final : public IndexContender {
public:
    explicit FaseIndex(const IndexUse& use) : tasks_(use.tasks) {}

    [[nodiscard]] bool offers(IndexQuestion question) const override { return question != IndexQuestion::GrownPairs; }
    void move(std::span<const Unit> units) override {
        const StridedBoxes boxes = StridedBoxes::centres(&units[0].x, unit_half, units.size(), sizeof(Unit));
        if (index_.empty()) {
            std::vector<std::uint32_t> numbers;
            for (std::uint32_t i = 0; i < units.size(); ++i) numbers.push_back(i);
            index_.assign(boxes, std::span<const std::uint32_t>(numbers));
        } else {
            index_.move_all(boxes);
        }
        index_.commit();
    }
    void neighbours(float radius, Tally& tally) override {
        if (tasks_ == nullptr) {
            index_.neighbours(radius, [&](std::uint32_t a, std::uint32_t b) { tally.add(a, b); });
        } else {
            add_pairs(tasks_, index_.find_neighbours(radius, tasks_), tally);
        }
    }
    void rectangles(std::span<const Aabb> rectangles, Tally& tally) override {
        for (const Aabb& rectangle : rectangles)
            index_.overlapping(rectangle, [&](std::uint32_t unit) { tally.add(unit); });
    }
    void nearest(std::span<const Vec3d> places, std::size_t k, std::vector<query::Hit>& out) override {
        index_.nearest(places, k, Aabb::infinity, nearest_, tasks_);
        out.insert(out.end(), nearest_.items().begin(), nearest_.items().end());
    }
    void rays(std::span<const Ray> rays, std::vector<query::Hit>& out) override {
        index_.cast_rays(rays, hits_, tasks_);
        out.insert(out.end(), hits_.begin(), hits_.end());
    }
    [[nodiscard]] std::string settings() const override {
        return sizeof...(Structure) == 0 ? "Index<int>" : "Index<int, broad::RowGrid>";
    }

private:
    TaskRunner* tasks_;
    Index<std::uint32_t, Structure...> index_;
    query::Lists<query::Hit> nearest_;
    std::vector<query::Hit> hits_;
};

/// The bare structure, which holds the grown boxes.
class BareRowGrid final : public IndexContender {
public:
    explicit BareRowGrid(const IndexUse& use) : growth_(0.5f * use.radius), tasks_(use.tasks) {}

    [[nodiscard]] bool offers(IndexQuestion question) const override {
        return question == IndexQuestion::Moves || question == IndexQuestion::GrownPairs;
    }
    void move(std::span<const Unit> units) override {
        const bool first = moves_.empty();
        moves_.resize(units.size());
        const Vec3 growth{growth_, growth_, growth_};
        for (std::uint32_t i = 0; i < units.size(); ++i) {
            const Aabb box = box_of(units[i]);
            moves_[i] = {i, {box.lo - growth, box.hi + growth}};
        }
        if (first) return grid_.build(moves_);
        grid_.move(tasks_, std::span<const broad::Move>(moves_));
        tasks_ != nullptr ? grid_.commit(*tasks_) : grid_.commit();
    }
    void grown_pairs(float, Tally& tally) override {
        pairs_.clear();
        tasks_ != nullptr ? grid_.find_pairs(*tasks_, pairs_) : grid_.find_pairs(pairs_);
        add_pairs(tasks_, pairs_, tally);
    }
    [[nodiscard]] std::string settings() const override { return "broad::RowGrid, grown boxes"; }

private:
    float growth_;
    TaskRunner* tasks_;
    broad::RowGrid grid_;
    std::vector<broad::Move> moves_;
    std::vector<broad::Pair> pairs_;
};

template <class Contender> std::unique_ptr<IndexContender> make(const IndexUse& use) {
    return std::make_unique<Contender>(use);
}

constexpr IndexContenderInfo all_contenders[]{
    {"index", make<FaseIndex<>>, true},    {"index_row_grid", make<FaseIndex<broad::RowGrid>>, true},
    {"row_grid", make<BareRowGrid>, true}, {"flat_grid", make_flat_grid},
    {"hash_grid", make_hash_grid},
#ifdef FASE_PEER_BOOST_INDEX
    {"boost_rtree", make_boost_index},
#endif
#ifdef FASE_PEER_NANOFLANN_INDEX
    {"nanoflann", make_nanoflann_index},
#endif
};

}  // namespace

std::span<const IndexContenderInfo> index_contenders() { return all_contenders; }

}  // namespace fase::bench
