/// How long structures take to find the pairs of a trace, and whether they find the right ones.
#include "cli/measure_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "bench/pairs.hpp"
#include "fase/broad/search/plain_sweep.hpp"
#include "fase/core/random.hpp"
#include "fase/pairs/pair_tracker.hpp"

namespace fase::cli {
namespace {

using broad::Move;
using broad::Pair;
using broad::Proxy;
using Clock = std::chrono::steady_clock;

constexpr std::uint64_t max_pairs = std::uint64_t{1} << 28;  // 2 GiB
constexpr std::size_t max_tried = 1000;                      // boxes for which the judge tries all
constexpr std::uint64_t looks = 16;                          // frames whose pairs are guessed, where none is judged

double ms_since(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

/// How many pairs there are, about: some boxes are tried against all.
double guessed_pairs(std::span<const Aabb> boxes) {
    constexpr std::size_t max_samples = 128;
    const std::size_t samples = std::min(max_samples, boxes.size());
    Random random(1);
    std::uint64_t hits = 0;
    for (std::size_t i = 0; i < samples; ++i) {
        const Aabb mine = boxes[samples == boxes.size() ? i : random.below(boxes.size())];
        std::uint64_t own = 0;
        for (const Aabb& other : boxes) own += overlaps(mine, other) ? 1 : 0;
        hits += own - 1;  // but itself
    }
    return static_cast<double>(hits) / static_cast<double>(samples) * static_cast<double>(boxes.size()) / 2;
}

/// All pairs but those of two static boxes, found in the plainest way that is fast enough.
void judge_pairs(std::span<const Aabb> boxes, std::span<const MotionState> motion_states, std::vector<Pair>& out) {
    const auto wanted = [&](Proxy p, Proxy q) {
        return motion_states[p] != MotionState::Static || motion_states[q] != MotionState::Static;
    };
    if (boxes.size() > max_tried) {
        std::vector<Move> moves;
        moves.reserve(boxes.size());
        for (const Aabb& box : boxes) moves.push_back({static_cast<Proxy>(moves.size()), box});
        return broad::find_pairs_by_sweep(moves, out, wanted);
    }
    for (Proxy p = 0; p < boxes.size(); ++p)
        for (Proxy q = p + 1; q < boxes.size(); ++q)
            if (overlaps(boxes[p], boxes[q]) && wanted(p, q)) out.push_back({p, q});
}

/// How long brute force takes for the survey's frames, about: one box against all others is timed.
double brute_force_seconds(std::span<const Aabb> boxes, const TraceSurvey& survey) {
    constexpr std::size_t most = 1500;
    broad::AnyStructure some = *broad::AnyStructure::named(broad::BruteForce::info.name);
    std::vector<Move> moves;
    for (std::size_t i = 0; i < std::min(most, boxes.size()); ++i) moves.push_back({static_cast<Proxy>(i), boxes[i]});
    some.build(moves);
    std::vector<Pair> pairs;
    some.find_pairs(pairs);  // warms up
    pairs.clear();
    const auto begin = Clock::now();
    some.find_pairs(pairs);
    const auto tests = [](double movers, double rest) { return movers * movers / 2 + movers * rest; };
    const double a_test = ms_since(begin) / 1000 / std::max(tests(static_cast<double>(moves.size()), 0), 1.0);
    const auto all = static_cast<double>(boxes.size());
    const auto fixed = static_cast<double>(survey.static_boxes), asleep = static_cast<double>(survey.asleep_boxes);
    const double frame = tests(all - fixed - asleep, fixed + asleep), build = tests(asleep, fixed);
    return a_test * (build + frame * static_cast<double>(survey.frames + 1));
}

/// What is measured of a structure, frame by frame.
class Player {
public:
    Player(const StructureChoice& choice, bool changes, TaskRunner& tasks) : tasks_(tasks), changes_(changes) {
        pairs::PairFinder empty =
            choice.asked == "auto" ? pairs::PairFinder::automatic() : pairs::PairFinder(choice.empty);
        if (changes) {
            tracker_ = pairs::PairTracker(std::move(empty));
        } else {
            finder_ = std::move(empty);
        }
    }
    void build(std::span<const Aabb> boxes, std::span<const MotionState> motion_states) {
        if (changes_) {
            print_ = broad::print_of(tracker_.build(tasks_, boxes, motion_states).begun);
        } else {
            finder_.build(tasks_, boxes, motion_states);
            find();  // so that memory is at hand
        }
    }
    /// Takes the next frame's boxes, and tells of its pairs.
    void update(std::span<const Aabb> boxes) {
        if (changes_) {
            told_ = tracker_.update(tasks_, boxes);
        } else {
            finder_.update(tasks_, boxes);
        }
    }
    void find() {
        if (changes_) return;
        pairs_.clear();
        finder_.find_pairs(tasks_, pairs_);
    }
    /// Of the pairs of this frame; to be asked for once after each update().
    broad::PairSetFingerprint print() {
        if (!changes_) return broad::print_of(pairs_);
        print_ += broad::print_of(told_.begun);
        print_ -= broad::print_of(told_.ended);
        return print_;
    }
    [[nodiscard]] std::uint64_t begun() const { return told_.begun.size(); }
    [[nodiscard]] std::uint64_t ended() const { return told_.ended.size(); }
    [[nodiscard]] const pairs::PairFinder& finder() const { return changes_ ? tracker_.finder() : finder_; }

private:
    TaskRunner& tasks_;
    bool changes_;
    pairs::PairTracker tracker_;  // of changes
    pairs::PairFinder finder_;    // of all pairs
    std::vector<Pair> pairs_;
    pairs::PairChanges told_;
    broad::PairSetFingerprint print_;
};

/// Which structures an automatic choice ended with: that of most boxes is named first.
void tell_choice(const pairs::PairFinder& finder, std::span<const MotionState> motion_states, PairFigures& figures) {
    std::array<std::size_t, 4> counts{};  // absent boxes stand nowhere
    for (Proxy p = 0; p < motion_states.size(); ++p) ++counts[static_cast<std::size_t>(finder.motion_state(p))];
    constexpr std::array<std::pair<MotionState, std::string_view>, 3> states{
        {{MotionState::Awake, "awake"}, {MotionState::Asleep, "asleep"}, {MotionState::Static, "static"}}};
    std::size_t max_count = 0;
    for (const auto& [state, name] : states) {
        const std::size_t count = counts[static_cast<std::size_t>(state)];
        if (count == 0) continue;
        const broad::AutoStructure chosen = finder.chosen(state);
        figures.reason += fmt::format("{}{} {}: {} ({})", figures.reason.empty() ? "" : "; ", count, name,
                                      chosen.structure, chosen.reason);
        if (count >= max_count) figures.chosen = chosen.structure;
        max_count = std::max(max_count, count);
    }
}

}  // namespace

Result<TraceSurvey> survey(record::TraceReader& trace, std::uint64_t frames, bool judge, const Tell& tell) {
    TraceSurvey seen;
    seen.frames = frames == 0 ? trace.frames() : std::min<std::uint64_t>(frames, trace.frames());
    const std::vector<MotionState> motion_states = bench::motion_states_of(trace);
    const auto count = [&](MotionState one) {
        return static_cast<std::uint64_t>(std::count(motion_states.begin(), motion_states.end(), one));
    };
    seen.static_boxes = count(MotionState::Static);
    seen.asleep_boxes = count(MotionState::Asleep);
    trace.rewind();
    std::vector<Aabb> boxes;
    std::vector<Pair> pairs;
    for (std::uint64_t frame = 0; frame < seen.frames; ++frame) {
        if (!tell(frame, seen.frames, judge ? "the right pairs" : "a look at all boxes")) break;
        if (const Result<bool> read = trace.next(boxes); !read) return read.error();
        const double guess = judge || frame % (seen.frames / looks + 1) == 0 ? guessed_pairs(boxes) : 0;
        if (guess > static_cast<double>(max_pairs)) {
            return Error{Status::Capacity,
                         trace.path(),
                         fmt::format("frame {}: found about {:.1e} pairs, need at most {}", frame, guess, max_pairs),
                         {}};
        }
        if (!judge) continue;
        pairs.clear();
        judge_pairs(boxes, motion_states, pairs);
        seen.judged.push_back(broad::print_of(pairs));
    }
    return seen;
}

Result<PairFigures> measure_pairs(record::TraceReader& trace, const TraceSurvey& survey, const StructureChoice& choice,
                                  TaskRunner& tasks, bool changes, std::optional<double> max_seconds,
                                  const Tell& tell) {
    PairFigures figures;
    figures.structure = choice.asked;
    figures.chosen = choice.chosen;
    figures.threads = tasks.threads();
    std::vector<Aabb> boxes;
    trace.rewind();
    if (const Result<bool> read = trace.next(boxes); !read) return read.error();
    const bool tries_all = choice.chosen == broad::BruteForce::info.name;
    if (const double guess = tries_all && max_seconds ? brute_force_seconds(boxes, survey) : 0;
        guess > max_seconds.value_or(0)) {
        figures.skipped = fmt::format("would take about {:.0f} s, more than {} s", guess, *max_seconds);
        return figures;
    }

    const auto start = Clock::now();
    const bool automatic = choice.asked == "auto";
    Player player(choice, changes, tasks);
    const std::vector<MotionState> motion_states = bench::motion_states_of(trace);
    const auto begin_of_build = Clock::now();
    player.build(boxes, motion_states);
    figures.build_ms = ms_since(begin_of_build);

    std::vector<double> times;
    Hasher hash;
    bool right = true;
    for (std::uint64_t frame = 0; frame < survey.frames; ++frame) {
        if (!tell(frame, survey.frames, choice.asked)) break;
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

        const broad::PairSetFingerprint print = player.print();
        ++figures.frames;
        figures.begun_sum += player.begun();
        figures.ended_sum += player.ended();
        hash.add(print.sum);
        figures.pairs_sum += print.count;
        figures.pairs_last = print.count;
        if (frame == 0) figures.pairs_first = print.count;
        if (frame < survey.judged.size()) right = right && print == survey.judged[frame];
    }
    figures.ms = bench::timing_of(times);
    if (!times.empty()) figures.min_ms = *std::min_element(times.begin(), times.end());
    figures.hash = hash.value();
    figures.stats = player.finder().stats();
    if (automatic) tell_choice(player.finder(), motion_states, figures);
    if (!survey.judged.empty()) figures.right = right;
    return figures;
}

}  // namespace fase::cli
