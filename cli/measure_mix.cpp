/// Measures what a mix of pairs, rays and box queries costs per frame of a trace in one structure.
#include "cli/measure_mix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/common/clock.hpp"
#include "cli/common/output.hpp"
#include "cli/query_set.hpp"
#include "fase/broad/measure.hpp"
#include "fase/broad/search/pair_hash.hpp"
#include "fase/core/hash.hpp"
#include "fase/pairs/box_sets.hpp"

namespace fase::cli {
namespace {

using broad::Move;
using broad::Proxy;

constexpr std::uint64_t max_run = 1000;  // queries of a kind that are run in a frame
constexpr std::uint64_t max_finds = 1000, max_queries = 1'000'000;
constexpr std::array all_states{MotionState::Static, MotionState::Asleep, MotionState::Awake};

Error bad_mix(const std::string& part) {
    return {Status::BadArgument, "--mix",
            fmt::format("found \"{}\"; expected numbers of pairs, rays and boxes", printable(part, 60)),
            "for example \"1 pairs, 200 rays, 50 boxes\""};
}

/// The boxes of a trace in three sets of one structure.
class MixedSets {
public:
    MixedSets(const broad::AnyStructure& kind, std::span<const Aabb> boxes, std::vector<MotionState> states)
        : sets_(kind), boxes_(boxes.begin(), boxes.end()), states_(std::move(states)) {
        for (const MotionState state : all_states) {
            std::vector<Move> moves;
            for (Proxy p = 0; p < boxes_.size(); ++p)
                if (states_[p] == state) moves.push_back({p, boxes_[p]});
            sets_.build(state, moves);
        }
    }

    /// Moves the boxes that changed; a sleeping one wakes.
    void update(TaskRunner& tasks, std::span<const Aabb> boxes) {
        moved_.clear();
        woken_.clear();
        for (Proxy p = 0; p < boxes.size(); ++p) {
            if (boxes[p] == boxes_[p]) continue;
            boxes_[p] = boxes[p];
            (states_[p] == MotionState::Asleep ? woken_ : moved_).push_back(p);
            states_[p] = MotionState::Awake;
        }
        sets_.of(MotionState::Asleep).erase(woken_);
        sets_.of(MotionState::Awake).insert(woken_, boxes_);
        sets_.of(MotionState::Awake).move(tasks, moved_, boxes_);
        sets_.commit(tasks);
    }
    void find_pairs(TaskRunner& tasks, std::vector<broad::Pair>& out) const { sets_.find_awake_pairs(tasks, out); }
    /// The distance of the nearest box on the ray.
    [[nodiscard]] float cast(const Ray& ray) const {
        float nearest = broad::infinite_distance, limit = ray.length;
        for (const MotionState state : all_states)
            sets_.of(state).nearest_first(broad::RayMeasure(ray), limit, [&](Proxy, const Aabb&, float distance) {
                nearest = std::min(nearest, distance);
                return limit = std::min(limit, distance);
            });
        return nearest;
    }
    void overlapping(const Aabb& box, std::vector<Proxy>& out) const {
        for (const MotionState state : all_states) sets_.of(state).overlapping(box, out);
    }
    [[nodiscard]] std::size_t bytes() const { return sets_.bytes(); }

private:
    pairs::BoxSets sets_;
    std::vector<Aabb> boxes_;
    std::vector<MotionState> states_;
    std::vector<Proxy> moved_, woken_;
};

/// Runs the searches of one frame and adds their times and answers.
class MixRun {
public:
    MixRun(const QueryMix& mix, TaskRunner& tasks, MixFigures& figures) : mix_(mix), tasks_(tasks), figures_(figures) {}

    void run(const MixedSets& sets, std::span<const Aabb> boxes, std::uint64_t frame) {
        const QueryCounts counts{std::min(mix_.rays, max_run), std::min(mix_.boxes, max_run), 0};
        const QuerySet queries = random_queries(boxes, counts, frame + 1);
        find_pairs(sets);
        cast_rays(sets, queries.rays);
        query_boxes(sets, queries.boxes);
        figures_.answers = answers_.value();
    }

private:
    const QueryMix& mix_;
    TaskRunner& tasks_;
    MixFigures& figures_;
    Hasher answers_;
    std::vector<broad::Pair> pairs_;
    std::vector<Proxy> proxies_;

    void find_pairs(const MixedSets& sets) {
        if (mix_.pairs == 0) return;
        const auto begin = Clock::now();
        for (std::uint64_t i = 0; i < mix_.pairs; ++i) {
            pairs_.clear();
            sets.find_pairs(tasks_, pairs_);
        }
        figures_.pairs_ms += ms_since(begin);
        answers_.add(broad::fingerprint_of(pairs_).sum);
    }
    void cast_rays(const MixedSets& sets, std::span<const Ray> rays) {
        if (rays.empty()) return;
        const auto begin = Clock::now();
        float sum = 0;
        for (const Ray& ray : rays) sum += sets.cast(ray);
        figures_.rays_ms += extrapolated(ms_since(begin), mix_.rays);
        answers_.add(sum);
    }
    void query_boxes(const MixedSets& sets, std::span<const Aabb> boxes) {
        if (boxes.empty()) return;
        const auto begin = Clock::now();
        std::uint64_t found = 0;
        for (const Aabb& box : boxes) {
            proxies_.clear();
            sets.overlapping(box, proxies_);
            found += proxies_.size();
        }
        figures_.boxes_ms += extrapolated(ms_since(begin), mix_.boxes);
        answers_.add(found);
    }
    static double extrapolated(double ms, std::uint64_t count) {
        return count <= max_run ? ms : ms * static_cast<double>(count) / double(max_run);
    }
};

}  // namespace

Result<QueryMix> parse_mix(const std::string& text) {
    QueryMix mix;
    std::array<bool, 3> seen{};
    std::string_view rest = text;
    if (text.ends_with(',')) return bad_mix(text);
    while (!rest.empty()) {
        const std::string_view part = rest.substr(0, rest.find(','));
        rest.remove_prefix(std::min(part.size() + 1, rest.size()));
        const std::size_t first = part.find_first_not_of(' '), last = part.find_last_not_of(' ');
        if (first == part.npos) return bad_mix(text);
        std::uint64_t number = 0;
        const char* const end = part.data() + last + 1;
        const auto [stop, code] = std::from_chars(part.data() + first, end, number);
        std::string_view word(stop, static_cast<std::size_t>(end - stop));
        word.remove_prefix(std::min(word.find_first_not_of(' '), word.size()));
        const int kind = word == "pairs" || word == "pair"  ? 0
                         : word == "rays" || word == "ray"  ? 1
                         : word == "boxes" || word == "box" ? 2
                                                            : -1;
        if (code != std::errc{} || kind < 0 || std::exchange(seen[static_cast<std::size_t>(kind)], true) ||
            number > (kind == 0 ? max_finds : max_queries))
            return bad_mix(std::string(part));
        (kind == 0 ? mix.pairs : kind == 1 ? mix.rays : mix.boxes) = number;
    }
    if (mix.pairs + mix.rays + mix.boxes == 0) return bad_mix(text);
    return mix;
}

std::string text_of(const QueryMix& mix) {
    std::string text;
    for (const auto& [count, name] :
         {std::pair{mix.pairs, "pairs"}, std::pair{mix.rays, "rays"}, std::pair{mix.boxes, "boxes"}})
        if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
    return text;
}

Result<MixFigures> measure_mix(record::TraceReader& trace, const TraceSurvey& survey, const StructureChoice& choice,
                               const QueryMix& mix, TaskRunner& tasks, double max_seconds,
                               const ReportProgress& report) {
    MixFigures figures;
    figures.structure = choice.chosen;
    std::vector<Aabb> boxes;
    trace.rewind();
    if (const Result<bool> read = trace.next(boxes); !read) return read.error();
    const auto start = Clock::now();
    MixedSets sets(choice.empty, boxes, trace.motion_states());
    figures.build_ms = ms_since(start);
    MixFigures warm_up;
    MixRun(mix, tasks, warm_up).run(sets, boxes, 0);
    MixRun run(mix, tasks, figures);
    for (std::uint64_t frame = 0; frame < survey.frames; ++frame) {
        if (!report(frame, survey.frames, choice.chosen)) return figures;
        if (ms_since(start) > max_seconds * 1000) {
            figures.skipped = fmt::format("took more than {} s for {} frames of {}", max_seconds, frame, survey.frames);
            return figures;
        }
        if (frame > 0) {
            if (const Result<bool> read = trace.next(boxes); !read) return read.error();
            const auto begin = Clock::now();
            sets.update(tasks, boxes);
            figures.update_ms += ms_since(begin);
        }
        run.run(sets, boxes, frame);
    }
    for (double* ms : {&figures.pairs_ms, &figures.rays_ms, &figures.boxes_ms}) *ms /= double(survey.frames);
    if (survey.frames > 1) figures.update_ms /= double(survey.frames - 1);
    figures.bytes = sets.bytes();
    return figures;
}

}  // namespace fase::cli
