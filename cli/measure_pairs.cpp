/// Measures how long structures take to find the pairs of a trace, and checks the pairs.
#include "cli/measure_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "bench/timing.hpp"
#include "cli/common/clock.hpp"
#include "fase/broad/brute_force.hpp"
#include "fase/broad/search/plain_sweep.hpp"
#include "fase/core/random.hpp"
#include "fase/pairs/pair_tracker.hpp"

namespace fase::cli {
namespace {

using broad::Move;
using broad::Pair;
using broad::Proxy;

constexpr std::uint64_t max_pairs = std::uint64_t{1} << 28;  // 2 GiB
constexpr std::size_t max_tested = 1000;                     // boxes up to which the reference tests all pairs
constexpr std::uint64_t sampled_frames = 16;                 // frames whose pairs are estimated without a check

/// Estimates the number of pairs: tests a sample of the boxes against all.
double estimated_pairs(std::span<const Aabb> boxes) {
    constexpr std::size_t max_samples = 128;
    const std::size_t samples = std::min(max_samples, boxes.size());
    Random random(1);
    std::uint64_t hits = 0;
    for (std::size_t i = 0; i < samples; ++i) {
        const Aabb sample = boxes[samples == boxes.size() ? i : random.below(boxes.size())];
        std::uint64_t overlaps_found = 0;
        for (const Aabb& other : boxes) overlaps_found += overlaps(sample, other) ? 1 : 0;
        hits += overlaps_found - 1;  // without itself
    }
    return static_cast<double>(hits) / static_cast<double>(samples) * static_cast<double>(boxes.size()) / 2;
}

/// Appends all pairs except those of two static boxes, found by the simplest method that is fast enough.
void find_reference_pairs(std::span<const Aabb> boxes, std::span<const MotionState> motion_states,
                          std::vector<Pair>& out) {
    const auto is_reported = [&](Proxy p, Proxy q) {
        return motion_states[p] != MotionState::Static || motion_states[q] != MotionState::Static;
    };
    if (boxes.size() > max_tested) {
        std::vector<Move> moves;
        moves.reserve(boxes.size());
        for (const Aabb& box : boxes) moves.push_back({static_cast<Proxy>(moves.size()), box});
        return broad::find_pairs_by_sweep(moves, out, is_reported);
    }
    for (Proxy p = 0; p < boxes.size(); ++p)
        for (Proxy q = p + 1; q < boxes.size(); ++q)
            if (overlaps(boxes[p], boxes[q]) && is_reported(p, q)) out.push_back({p, q});
}

/// Estimates the time of brute force for the survey's frames: times it on a sample of the boxes.
double brute_force_seconds(std::span<const Aabb> boxes, const TraceSurvey& survey) {
    constexpr std::size_t max_samples = 1500;
    broad::AnyStructure sample = *broad::AnyStructure::named(broad::BruteForce::info.name);
    std::vector<Move> moves;
    for (std::size_t i = 0; i < std::min(max_samples, boxes.size()); ++i)
        moves.push_back({static_cast<Proxy>(i), boxes[i]});
    sample.build(moves);
    std::vector<Pair> pairs;
    sample.find_pairs(pairs);  // warms up
    pairs.clear();
    const auto begin = Clock::now();
    sample.find_pairs(pairs);
    const auto tests = [](double movers, double rest) { return movers * movers / 2 + movers * rest; };
    const double seconds_per_test = ms_since(begin) / 1000 / std::max(tests(static_cast<double>(moves.size()), 0), 1.0);
    const auto all = static_cast<double>(boxes.size());
    const auto fixed = static_cast<double>(survey.static_boxes), asleep = static_cast<double>(survey.asleep_boxes);
    const double frame = tests(all - fixed - asleep, fixed + asleep), build = tests(asleep, fixed);
    return seconds_per_test * (build + frame * static_cast<double>(survey.frames + 1));
}

/// Runs a structure frame by frame, either with all pairs or with changes.
class Player {
public:
    Player(const StructureChoice& choice, bool changes, TaskRunner& tasks) : tasks_(tasks), changes_(changes) {
        pairs::PairFinder empty =
            choice.requested == "auto" ? pairs::PairFinder::automatic() : pairs::PairFinder(choice.empty);
        if (changes) {
            tracker_ = pairs::PairTracker(std::move(empty));
        } else {
            finder_ = std::move(empty);
        }
    }
    void build(std::span<const Aabb> boxes, std::span<const MotionState> motion_states) {
        if (changes_) {
            fingerprint_ = broad::fingerprint_of(tracker_.build(tasks_, boxes, motion_states).begun);
        } else {
            finder_.build(tasks_, boxes, motion_states);
            find();  // allocates the memory before the timing
        }
    }
    /// Updates the boxes to the next frame; with changes, also finds those.
    void update(std::span<const Aabb> boxes) {
        if (changes_) {
            pair_changes_ = tracker_.update(tasks_, boxes);
        } else {
            finder_.update(tasks_, boxes);
        }
    }
    void find() {
        if (changes_) return;
        pairs_.clear();
        finder_.find_pairs(tasks_, pairs_);
    }
    /// Fingerprint of the pairs of this frame. Call exactly once after each update().
    broad::PairSetFingerprint fingerprint() {
        if (!changes_) return broad::fingerprint_of(pairs_);
        fingerprint_ += broad::fingerprint_of(pair_changes_.begun);
        fingerprint_ -= broad::fingerprint_of(pair_changes_.ended);
        return fingerprint_;
    }
    [[nodiscard]] std::uint64_t begun() const { return pair_changes_.begun.size(); }
    [[nodiscard]] std::uint64_t ended() const { return pair_changes_.ended.size(); }
    [[nodiscard]] const pairs::PairFinder& finder() const { return changes_ ? tracker_.finder() : finder_; }

private:
    TaskRunner& tasks_;
    bool changes_;
    pairs::PairTracker tracker_;  // for changes
    pairs::PairFinder finder_;    // for all pairs
    std::vector<Pair> pairs_;
    pairs::PairChanges pair_changes_;
    broad::PairSetFingerprint fingerprint_;
};

/// Stores which structures an automatic choice selected; `chosen` is the one of most boxes.
void add_choice(const pairs::PairFinder& finder, std::span<const MotionState> motion_states, PairFigures& figures) {
    std::array<std::size_t, 4> counts{};  // absent boxes have no structure
    for (Proxy p = 0; p < motion_states.size(); ++p) ++counts[static_cast<std::size_t>(finder.motion_state(p))];
    constexpr std::array<std::pair<MotionState, std::string_view>, 3> states{
        {{MotionState::Awake, "awake"}, {MotionState::Asleep, "asleep"}, {MotionState::Static, "static"}}};
    std::size_t max_count = 0;
    for (const auto& [state, name] : states) {
        const std::size_t count = counts[static_cast<std::size_t>(state)];
        if (count == 0) continue;
        const broad::StructureChoice chosen = finder.chosen(state);
        figures.reason += fmt::format("{}{} {}: {} ({})", figures.reason.empty() ? "" : "; ", count, name,
                                      chosen.structure, chosen.reason);
        if (count >= max_count) figures.chosen = chosen.structure;
        max_count = std::max(max_count, count);
    }
}

}  // namespace

Result<TraceSurvey> survey(record::TraceReader& trace, std::uint64_t frames, bool check, const ReportProgress& report) {
    TraceSurvey seen;
    seen.frames = frames == 0 ? trace.frames() : std::min<std::uint64_t>(frames, trace.frames());
    const std::vector<MotionState> motion_states = trace.motion_states();
    const auto count = [&](MotionState one) {
        return static_cast<std::uint64_t>(std::count(motion_states.begin(), motion_states.end(), one));
    };
    seen.static_boxes = count(MotionState::Static);
    seen.asleep_boxes = count(MotionState::Asleep);
    trace.rewind();
    std::vector<Aabb> boxes;
    std::vector<Pair> pairs;
    for (std::uint64_t frame = 0; frame < seen.frames; ++frame) {
        if (!report(frame, seen.frames, check ? "reference pairs" : "reading all boxes")) break;
        if (const Result<bool> read = trace.next(boxes); !read) return read.error();
        const double estimate = check || frame % (seen.frames / sampled_frames + 1) == 0 ? estimated_pairs(boxes) : 0;
        if (estimate > static_cast<double>(max_pairs)) {
            return Error{
                Status::Capacity,
                trace.path(),
                fmt::format("frame {}: found about {:.1e} pairs; expected at most {}", frame, estimate, max_pairs),
                {}};
        }
        if (!check) continue;
        pairs.clear();
        find_reference_pairs(boxes, motion_states, pairs);
        seen.reference.push_back(broad::fingerprint_of(pairs));
    }
    return seen;
}

Result<PairFigures> measure_pairs(record::TraceReader& trace, const TraceSurvey& survey, const StructureChoice& choice,
                                  TaskRunner& tasks, bool changes, std::optional<double> max_seconds,
                                  const ReportProgress& report) {
    PairFigures figures;
    figures.structure = choice.requested;
    figures.chosen = choice.chosen;
    figures.threads = tasks.threads();
    std::vector<Aabb> boxes;
    trace.rewind();
    if (const Result<bool> read = trace.next(boxes); !read) return read.error();
    const bool is_brute_force = choice.chosen == broad::BruteForce::info.name;
    if (const double estimate = is_brute_force && max_seconds ? brute_force_seconds(boxes, survey) : 0;
        estimate > max_seconds.value_or(0)) {
        figures.skipped = fmt::format("would take about {:.0f} s, more than {} s", estimate, *max_seconds);
        return figures;
    }

    const auto start = Clock::now();
    const bool automatic = choice.requested == "auto";
    Player player(choice, changes, tasks);
    const std::vector<MotionState> motion_states = trace.motion_states();
    const auto build_begin = Clock::now();
    player.build(boxes, motion_states);
    figures.build_ms = ms_since(build_begin);

    std::vector<double> times;
    Hasher hash;
    bool correct = true;
    for (std::uint64_t frame = 0; frame < survey.frames; ++frame) {
        if (!report(frame, survey.frames, choice.requested)) break;
        if (max_seconds && ms_since(start) > *max_seconds * 1000) {
            figures.skipped =
                fmt::format("took more than {} s for {} frames of {}", *max_seconds, frame, survey.frames);
            return figures;
        }
        if (frame > 0) {
            if (const Result<bool> read = trace.next(boxes); !read) return read.error();
        }
        const auto begin = Clock::now();
        if (frame > 0) player.update(boxes);
        player.find();
        if (frame > 0 || !changes) times.push_back(ms_since(begin));

        const broad::PairSetFingerprint fingerprint = player.fingerprint();
        ++figures.frames;
        figures.begun_sum += player.begun();
        figures.ended_sum += player.ended();
        hash.add(fingerprint.sum);
        figures.pairs_sum += fingerprint.count;
        figures.pairs_last = fingerprint.count;
        if (frame == 0) figures.pairs_first = fingerprint.count;
        if (frame < survey.reference.size()) correct = correct && fingerprint == survey.reference[frame];
    }
    figures.ms = bench::timing_of(times);
    if (!times.empty()) figures.min_ms = *std::min_element(times.begin(), times.end());
    figures.hash = hash.value();
    figures.stats = player.finder().stats();
    if (automatic) add_choice(player.finder(), motion_states, figures);
    if (!survey.reference.empty()) figures.correct = correct;
    return figures;
}

}  // namespace fase::cli
