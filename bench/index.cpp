/// The benchmark behind `fase bench index`: the check of all answers, then alternating rounds.
#include "bench/index.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "bench/split_list.hpp"
#include "bench/timing.hpp"
#include "fase/core/random.hpp"

namespace fase::bench {
namespace {

constexpr std::array<std::string_view, index_questions> names{
    "moves",      "neighbours_moved", "frame",   "neighbours",    "grown_pairs", "rectangles_moved",
    "rectangles", "nearest_moved",    "nearest", "nearest_eight", "rays"};
constexpr double area_of_a_unit = 31.25;  // m²
constexpr float stride = 0.2f;            // of a unit in a round, at most, in x and in z
constexpr std::uint64_t brute_force_tests = 40'000'000;

constexpr std::size_t number_of(IndexQuestion question) { return static_cast<std::size_t>(question); }

/// What one contender answered in one round.
struct IndexAnswer {
    Tally tally;                   // pairs and rectangles
    std::vector<query::Hit> hits;  // the others
};

constexpr bool has_hits(IndexQuestion question) { return question >= IndexQuestion::NearestMoved; }

void ask(IndexContender& contender, const IndexQuestions& questions, IndexQuestion question, IndexAnswer& answer) {
    switch (question) {
        case IndexQuestion::Moves:
        case IndexQuestion::Frame: break;
        case IndexQuestion::NeighboursMoved:
        case IndexQuestion::Neighbours: contender.neighbours(questions.radius, answer.tally); break;
        case IndexQuestion::GrownPairs: contender.grown_pairs(questions.radius, answer.tally); break;
        case IndexQuestion::RectanglesMoved:
        case IndexQuestion::Rectangles: contender.rectangles(questions.rectangles, answer.tally); break;
        case IndexQuestion::NearestMoved:
        case IndexQuestion::Nearest: contender.nearest(questions.places, 1, answer.hits); break;
        case IndexQuestion::NearestEight: contender.nearest(questions.places, 8, answer.hits); break;
        case IndexQuestion::Rays: contender.rays(questions.rays, answer.hits); break;
    }
}

/// Peers round distances otherwise, and name any of equally near units.
bool same_hit(const query::Hit& a, const query::Hit& b) {
    if (!a.is_hit() || !b.is_hit()) return a.is_hit() == b.is_hit();
    return std::abs(a.distance - b.distance) <= 1e-4f * (1 + b.distance);
}

/// The units and the questions, the same for all contenders.
struct IndexWorld {
    float side;
    std::vector<Unit> units;
    IndexQuestions questions;
    Random random;

    explicit IndexWorld(const IndexOptions& options)
        : side(static_cast<float>(std::sqrt(area_of_a_unit * static_cast<double>(options.units)))),
          random(options.seed) {
        for (std::size_t i = 0; i < options.units; ++i)
            units.push_back({random.between(0, side), unit_half.y, random.between(0, side), static_cast<int>(i)});
        const auto place = [&] {
            return Vec3d{static_cast<double>(random.between(0, side)), 1, static_cast<double>(random.between(0, side))};
        };
        for (int i = 0; i < 10; ++i) {
            const Vec3 lo = to_float(place());
            questions.rectangles.push_back({{lo.x, -10, lo.z}, {lo.x + 100, 10, lo.z + 100}});
        }
        for (int i = 0; i < 2000; ++i) questions.places.push_back(place());
        for (int i = 0; i < 1000; ++i) {
            const Vec3 towards{random.between(-1, 1), 0, random.between(-1, 1)};
            questions.rays.push_back({place(), dot(towards, towards) > 0 ? normalized(towards) : Vec3{1, 0, 0}, 100});
        }
    }
    void move() {
        for (Unit& unit : units) {
            unit.x = std::clamp(unit.x + random.between(-stride, stride), 0.0f, side);
            unit.z = std::clamp(unit.z + random.between(-stride, stride), 0.0f, side);
        }
    }
    /// Returns the first answers by brute force: k for each place, or one for each ray.
    [[nodiscard]] std::vector<query::Hit> brute_force(IndexQuestion question) const {
        std::vector<query::Hit> out;
        const std::size_t k = question == IndexQuestion::NearestEight ? 8 : 1;
        const std::size_t all = question == IndexQuestion::Rays ? questions.rays.size() : questions.places.size();
        const std::size_t count =
            std::min<std::size_t>(all, std::max<std::size_t>(1, brute_force_tests / units.size()));
        std::vector<query::Hit> hits(units.size());
        for (std::size_t i = 0; i < count; ++i) {
            for (std::uint32_t unit = 0; unit < units.size(); ++unit)
                hits[unit] = {question == IndexQuestion::Rays ? RayBoxTest(questions.rays[i]).entry(box_of(units[unit]))
                                                              : distance_to(box_of(units[unit]), questions.places[i]),
                              unit};
            const std::size_t few = std::min(k, hits.size());
            std::partial_sort(hits.begin(), hits.begin() + static_cast<std::ptrdiff_t>(few), hits.end());
            for (std::size_t n = 0; n < few; ++n)
                out.push_back(hits[n].distance < query::infinite_distance ? hits[n] : query::Hit{});
        }
        return out;
    }
    static float distance_to(const Aabb& box, Vec3d place) {
        double sum = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double outside = std::max({static_cast<double>(box.lo[axis]) - place[axis],
                                             place[axis] - static_cast<double>(box.hi[axis]), 0.0});
            sum += outside * outside;
        }
        return static_cast<float>(std::sqrt(sum));
    }
};

/// One contender with its times.
struct IndexEntry {
    const IndexContenderInfo* info;
    std::unique_ptr<IndexContender> contender;
    int threads;
    std::array<std::vector<double>, index_questions> times;  // by question
    std::array<std::uint64_t, index_questions> found{}, compared{}, differ{};

    [[nodiscard]] bool offers(IndexQuestion question) const {
        return contender->offers(question == IndexQuestion::Frame ? IndexQuestion::NeighboursMoved : question);
    }
};

/// The answers that all contenders must give in a round.
struct ExpectedAnswers {
    std::array<IndexAnswer, index_questions> answers;
    std::array<bool, index_questions> is_known{};

    /// Tallies of the benchmark's own grid; in the first round also brute force.
    ExpectedAnswers(const IndexWorld& world, IndexContender& grid, bool with_brute_force) {
        grid.move(world.units);
        for (std::size_t q = 0; q < index_questions; ++q) {
            const auto question = static_cast<IndexQuestion>(q);
            is_known[q] = !has_hits(question) || with_brute_force;
            if (!has_hits(question)) {
                ask(grid, world.questions, question, answers[q]);
            } else if (with_brute_force) {
                answers[q].hits = world.brute_force(question);
            }
        }
    }
    void compare(IndexEntry& entry, IndexQuestion question, const IndexAnswer& answer) {
        const std::size_t q = number_of(question);
        if (!has_hits(question)) {
            ++entry.compared[q];
            entry.differ[q] += answer.tally == answers[q].tally ? 0 : 1;
            entry.found[q] = answer.tally.count;
            return;
        }
        if (!is_known[q]) answers[q].hits = answer.hits;  // of the first contender
        is_known[q] = true;
        const std::size_t count = answers[q].hits.size();
        entry.compared[q] += count;
        for (std::size_t i = 0; i < count; ++i)
            entry.differ[q] += i < answer.hits.size() && same_hit(answer.hits[i], answers[q].hits[i]) ? 0 : 1;
        entry.found[q] = static_cast<std::uint64_t>(
            std::count_if(answer.hits.begin(), answer.hits.end(), [](const query::Hit& hit) { return hit.is_hit(); }));
    }
};

/// Runs one contender through a round; the times count if `timed`.
void run_round(IndexEntry& entry, const IndexWorld& world, ExpectedAnswers& expected, bool timed) {
    IndexAnswer answer;
    std::array<double, index_questions> ms{};
    for (std::size_t q = 0; q < index_questions; ++q) {
        const auto question = static_cast<IndexQuestion>(q);
        if (!is_asked(question) || !entry.offers(question)) continue;
        answer.tally = {};
        answer.hits.clear();
        const double begin = entry.threads == 1 ? cpu_ms() : wall_ms();
        if (question == IndexQuestion::Moves) {
            entry.contender->move(world.units);
        } else {
            ask(*entry.contender, world.questions, question, answer);
        }
        ms[q] = (entry.threads == 1 ? cpu_ms() : wall_ms()) - begin;
        if (question != IndexQuestion::Moves) expected.compare(entry, question, answer);
    }
    ms[number_of(IndexQuestion::Frame)] =
        ms[number_of(IndexQuestion::Moves)] + ms[number_of(IndexQuestion::NeighboursMoved)];
    if (!timed) return;
    for (std::size_t q = 0; q < index_questions; ++q)
        if (entry.offers(static_cast<IndexQuestion>(q))) entry.times[q].push_back(ms[q]);
}

IndexRow row_of(const IndexEntry& entry, const IndexOptions& options, std::size_t q) {
    IndexRow row;
    row.contender = entry.info->name;
    row.settings = entry.contender->settings();
    row.question = names[q];
    row.units = options.units;
    row.threads = entry.threads;
    row.rounds = options.rounds;
    const Timing ms = timing_of(entry.times[q]);
    row.median_ms = ms.median;
    row.worst_ms = ms.worst;
    std::tie(row.low_ms, row.high_ms) = tenths_of(entry.times[q]);
    row.found = entry.found[q];
    row.compared = entry.compared[q];
    row.differ = entry.differ[q];
    return row;
}

/// Returns the contenders for "all" or a list like "index,flat_grid", in the order of THE list.
Result<std::vector<const IndexContenderInfo*>> contenders_of(const std::string& list) {
    const auto all = index_contenders();
    std::vector<bool> selected(all.size(), false);
    for (const std::string& name : split_list(list)) {
        bool known = name == "all";
        for (std::size_t i = 0; i < all.size(); ++i)
            if (name == "all" || name == all[i].name) selected[i] = known = true;
        if (known) continue;
        std::string names = "all";
        for (const IndexContenderInfo& info : all) names += ", " + std::string(info.name);
        return Error{
            Status::BadArgument, "--contender", fmt::format("found \"{}\"; expected one of {}", name, names), {}};
    }
    std::vector<const IndexContenderInfo*> chosen;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (selected[i]) chosen.push_back(&all[i]);
    return chosen;
}

}  // namespace

std::string_view name_of(IndexQuestion question) { return names[number_of(question)]; }

Result<std::vector<IndexRow>> measure_index(const IndexOptions& options, const IndexProgress& progress) {
    const Result<std::vector<const IndexContenderInfo*>> chosen = contenders_of(options.contender);
    if (!chosen) return chosen.error();
    IndexWorld world(options);
    const std::unique_ptr<TaskRunner> tasks = options.threads > 1 ? make_thread_runner(options.threads) : nullptr;
    const std::unique_ptr<IndexContender> grid = make_flat_grid({world.side, world.questions.radius, nullptr});
    std::vector<IndexEntry> entries;
    for (const IndexContenderInfo* info : *chosen) {
        TaskRunner* const runner = info->has_threads ? tasks.get() : nullptr;
        entries.push_back(
            {info, info->make({world.side, world.questions.radius, runner}), runner != nullptr ? options.threads : 1});
    }
    std::vector<IndexRow> rows;
    const auto rounds = static_cast<std::uint64_t>(options.rounds);
    // The first round builds and is compared with brute force; the second warms memory, as structures follow now.
    for (std::uint64_t round = 0; round < rounds + 2; ++round) {
        world.move();
        ExpectedAnswers expected(world, *grid, round == 0);
        for (std::size_t i = 0; i < entries.size(); ++i) {
            if (!progress(round * entries.size() + i, (rounds + 2) * entries.size(), entries[i].info->name))
                return rows;
            run_round(entries[i], world, expected, round >= 2);
        }
    }
    for (std::size_t q = 0; q < index_questions; ++q)
        for (const IndexEntry& entry : entries)
            if (entry.offers(static_cast<IndexQuestion>(q))) rows.push_back(row_of(entry, options, q));
    return rows;
}

}  // namespace fase::bench
