/// Two grids as games have them, to compare an index with: a hash map of cells, and one array sorted by cell.
#include <cmath>
#include <unordered_map>

#include "bench/index_contender.hpp"
#include "fase/query/detail/near_pairs.hpp"

namespace fase::bench {
namespace {

bool offered_by_grids(IndexQuestion question) {
    return question == IndexQuestion::Moves || question == IndexQuestion::NeighboursMoved ||
           question == IndexQuestion::Neighbours || question == IndexQuestion::RectanglesMoved ||
           question == IndexQuestion::Rectangles;
}

/// The side of cells that are so large that neighbours lie in adjacent ones.
float cell_side(float radius) { return (radius + 2 * std::max(unit_half.x, unit_half.z)) * 1.0001f; }

class HashGrid final : public IndexContender {
public:
    explicit HashGrid(const IndexUse& use) : side_(cell_side(use.radius)) {}

    [[nodiscard]] bool offers(IndexQuestion question) const override { return offered_by_grids(question); }
    void move(std::span<const Unit> units) override {
        for (auto& [key, cell] : cells_) cell.clear();
        boxes_.clear();
        for (const Unit& unit : units) {
            cells_[key_of(at(unit.x), at(unit.z))].push_back(static_cast<std::uint32_t>(boxes_.size()));
            boxes_.push_back(box_of(unit));
        }
    }
    void neighbours(float radius, Tally& tally) override {
        for (std::uint32_t a = 0; a < boxes_.size(); ++a)
            for_each_near(boxes_[a], [&](std::uint32_t b) {
                if (a < b && query::squared_distance(boxes_[a], boxes_[b]) <= radius * radius) tally.add(a, b);
            });
    }
    void rectangles(std::span<const Aabb> rectangles, Tally& tally) override {
        for (const Aabb& rectangle : rectangles)
            for_each_near(rectangle, [&](std::uint32_t unit) {
                if (overlaps(rectangle, boxes_[unit])) tally.add(unit);
            });
    }
    [[nodiscard]] std::string settings() const override { return "unordered_map of vectors, cells of 6 m"; }

private:
    [[nodiscard]] int at(float x) const { return static_cast<int>(std::floor(x / side_)); }
    static std::uint64_t key_of(int x, int z) {
        return static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32 | static_cast<std::uint32_t>(z);
    }
    /// Calls f for the units in the cells of a box and in those around them.
    template <class F> void for_each_near(const Aabb& box, const F& f) const {
        for (int x = at(box.lo.x + unit_half.x) - 1; x <= at(box.hi.x - unit_half.x) + 1; ++x)
            for (int z = at(box.lo.z + unit_half.z) - 1; z <= at(box.hi.z - unit_half.z) + 1; ++z)
                if (const auto cell = cells_.find(key_of(x, z)); cell != cells_.end())
                    for (const std::uint32_t unit : cell->second) f(unit);
    }

    float side_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
    std::vector<Aabb> boxes_;
};

/// Cells in rows along x, with a border of empty ones.
class FlatGrid final : public IndexContender {
public:
    explicit FlatGrid(const IndexUse& use)
        : side_(cell_side(use.radius)), width_(static_cast<std::size_t>(use.side / side_) + 3) {}

    [[nodiscard]] bool offers(IndexQuestion question) const override {
        return offered_by_grids(question) || question == IndexQuestion::GrownPairs;
    }
    void move(std::span<const Unit> units) override {
        begins_.assign(width_ * width_ + 2, 0);
        cell_of_.resize(units.size());
        sorted_.resize(units.size());
        for (std::size_t i = 0; i < units.size(); ++i) {
            cell_of_[i] = static_cast<std::uint32_t>(row(units[i].z) * width_ + row(units[i].x));
            ++begins_[cell_of_[i] + 2];
        }
        for (std::size_t cell = 2; cell < begins_.size(); ++cell) begins_[cell] += begins_[cell - 1];
        for (std::uint32_t i = 0; i < units.size(); ++i) sorted_[begins_[cell_of_[i] + 1]++] = {box_of(units[i]), i};
    }
    void neighbours(float radius, Tally& tally) override {
        for_each_candidate([&](const Entry& a, const Entry& b) {
            if (query::squared_distance(a.box, b.box) <= radius * radius) tally.add(a.unit, b.unit);
        });
    }
    void grown_pairs(float radius, Tally& tally) override {
        const Vec3 growth{0.5f * radius, 0.5f * radius, 0.5f * radius};
        for_each_candidate([&](const Entry& a, const Entry& b) {
            if (overlaps({a.box.lo - growth, a.box.hi + growth}, {b.box.lo - growth, b.box.hi + growth}))
                tally.add(a.unit, b.unit);
        });
    }
    void rectangles(std::span<const Aabb> rectangles, Tally& tally) override {
        for (const Aabb& rectangle : rectangles) {
            const std::size_t from = row(rectangle.lo.x - unit_half.x), to = row(rectangle.hi.x + unit_half.x);
            for (std::size_t z = row(rectangle.lo.z - unit_half.z); z <= row(rectangle.hi.z + unit_half.z); ++z)
                for (std::uint32_t i = begins_[z * width_ + from]; i < begins_[z * width_ + to + 1]; ++i)
                    if (overlaps(rectangle, sorted_[i].box)) tally.add(sorted_[i].unit);
        }
    }
    [[nodiscard]] std::string settings() const override { return "counting sort, cells of 6 m"; }

private:
    struct Entry {
        Aabb box;
        std::uint32_t unit;
    };
    /// The column of an x, or the row of a z.
    [[nodiscard]] std::size_t row(float x) const {
        return 1 + static_cast<std::size_t>(std::clamp(x / side_, 0.0f, static_cast<float>(width_ - 3)));
    }
    /// Calls f once for each pair of units in the same cell or in adjacent ones.
    template <class F> void for_each_candidate(const F& f) const {
        for (std::size_t cell = width_ + 1; cell + width_ + 1 < width_ * width_; ++cell)
            for (std::uint32_t i = begins_[cell]; i < begins_[cell + 1]; ++i) {
                const Entry entry = sorted_[i];
                for (std::uint32_t k = i + 1; k < begins_[cell + 2]; ++k) f(entry, sorted_[k]);
                const std::uint32_t end = begins_[cell + width_ + 2];
                for (std::uint32_t k = begins_[cell + width_ - 1]; k < end; ++k) f(entry, sorted_[k]);
            }
    }

    float side_;
    std::size_t width_;                  // cells of a row
    std::vector<std::uint32_t> begins_;  // of each cell in sorted_
    std::vector<std::uint32_t> cell_of_;
    std::vector<Entry> sorted_;
};

}  // namespace

std::unique_ptr<IndexContender> make_hash_grid(const IndexUse& use) { return std::make_unique<HashGrid>(use); }
std::unique_ptr<IndexContender> make_flat_grid(const IndexUse& use) { return std::make_unique<FlatGrid>(use); }

}  // namespace fase::bench
