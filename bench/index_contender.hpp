#pragma once
/// The interface of an index that `fase bench index` measures: units that move, then questions about all of them.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fase/core/tasks.hpp"
#include "fase/geometry/ray.hpp"
#include "fase/query/hit.hpp"

namespace fase::bench {

/// A unit of a game, as its array has it; the first three numbers are its centre.
struct Unit {
    float x = 0, y = 0, z = 0;
    int value = 0;
};
inline constexpr Vec3 unit_half{0.5f, 1, 0.5f};  ///< half of each unit's box
[[nodiscard]] inline Aabb box_of(const Unit& unit) {
    const Vec3 centre{unit.x, unit.y, unit.z};
    return {centre - unit_half, centre + unit_half};
}

/// What is measured, in the order of a round.
enum class IndexQuestion {
    Moves,            ///< new places for all units, until questions are allowed
    NeighboursMoved,  ///< pairs of boxes within the radius: the first question after the moves
    Frame,            ///< the sum of the two above
    Neighbours,       ///< the same pairs again, nothing moved
    GrownPairs,       ///< pairs of boxes, grown by half of the radius on each side, that overlap
    RectanglesMoved,  ///< the units in rectangles: the first question of its kind after the moves
    Rectangles,
    NearestMoved,  ///< the nearest unit of places: the first question of its kind after the moves
    Nearest,
    NearestEight,
    Rays,
};
inline constexpr std::size_t index_questions = 11;
/// Returns the name in JSON and CSV, as "neighbours_moved".
[[nodiscard]] std::string_view name_of(IndexQuestion question);
/// Returns whether contenders answer `question` themselves.
[[nodiscard]] constexpr bool is_asked(IndexQuestion question) { return question != IndexQuestion::Frame; }

/// What the callbacks of a question add up, in any order. Cheap, because it is part of the measured time.
struct Tally {
    std::uint64_t count = 0, sum = 0;
    void add(std::uint32_t unit) {
        ++count;
        sum += mixed(unit);
    }
    void add(std::uint32_t a, std::uint32_t b) {
        ++count;
        sum += mixed(a) * mixed(b);
    }
    void add(const Tally& other) {
        count += other.count;
        sum += other.sum;
    }
    friend bool operator==(const Tally&, const Tally&) = default;

private:
    static std::uint64_t mixed(std::uint64_t n) { return (n + 1) * 0x9e3779b97f4a7c15u ^ n << 32; }
};

/// The questions of a run; they stay the same in all rounds.
struct IndexQuestions {
    float radius = 5;              ///< of neighbours, metres between boxes
    std::vector<Aabb> rectangles;  ///< higher and lower than any unit
    std::vector<Vec3d> places;     ///< for nearest
    std::vector<Ray> rays;
};

/// An index of Fase, a grid, or a peer.
class IndexContender {
public:
    IndexContender() = default;
    IndexContender(const IndexContender&) = delete;
    IndexContender& operator=(const IndexContender&) = delete;
    virtual ~IndexContender() = default;
    [[nodiscard]] virtual bool offers(IndexQuestion question) const = 0;
    /// Gives unit i a new place; the first call defines how many there are. Questions may follow.
    virtual void move(std::span<const Unit> units) = 0;
    /// Adds each pair of units whose boxes are at most `radius` metres apart, once.
    virtual void neighbours(float, Tally&) {}
    /// Adds each pair of units whose boxes overlap when they are larger by half of the radius on each side, once.
    virtual void grown_pairs(float, Tally&) {}
    /// Adds the units of each rectangle.
    virtual void rectangles(std::span<const Aabb>, Tally&) {}
    /// Appends the k units nearest to each place, nearest first. Order of equal distances: any.
    virtual void nearest(std::span<const Vec3d>, std::size_t, std::vector<query::Hit>&) {}
    /// Appends the first unit on each ray, or a hit with `is_hit() == false`.
    virtual void rays(std::span<const Ray>, std::vector<query::Hit>&) {}
    /// The settings in a few words, for tables.
    [[nodiscard]] virtual std::string settings() const = 0;
};

/// What a contender is made for.
struct IndexUse {
    float side = 0;               ///< units are between 0 and this in x and z, metres
    float radius = 5;             ///< of neighbours
    TaskRunner* tasks = nullptr;  ///< nullptr: one thread
};

struct IndexContenderInfo {
    std::string_view name;
    std::unique_ptr<IndexContender> (*make)(const IndexUse& use);
    bool has_threads = false;
};

/// THE list: the default index and one of a single structure, the bare structure, two grids as games have them, then
/// each peer found.
[[nodiscard]] std::span<const IndexContenderInfo> index_contenders();

/// A hash map from cells to lists of units, filled anew in each frame.
std::unique_ptr<IndexContender> make_hash_grid(const IndexUse& use);
/// Units sorted by cell into one array, anew in each frame.
std::unique_ptr<IndexContender> make_flat_grid(const IndexUse& use);

// Peers; each is defined only when its library is found.
std::unique_ptr<IndexContender> make_boost_index(const IndexUse& use);
std::unique_ptr<IndexContender> make_nanoflann_index(const IndexUse& use);

}  // namespace fase::bench
