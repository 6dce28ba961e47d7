/// What `fase bench pairs` measures: how long broad phases take to find all pairs of a trace, frame by frame.
#include "bench/pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/pair_engine.hpp"
#include "fase/broad/search/pair_hash.hpp"
#include "fase/broad/search/plain_sweep.hpp"
#include "fase/core/hash.hpp"
#include "fase/record/trace.hpp"

namespace fase::bench {
namespace {

/// Frames that an engine takes before another has its turn: few, so that noise meets all; several, so that each works
/// with its own data in the caches most of the time.
constexpr std::uint64_t frames_a_turn = 6;

/// Engines of a list like "row_grid,peers", in the order of THE list.
Result<std::vector<const PairEngineInfo*>> engines_named(const std::string& names) {
    const std::vector<PairEngineInfo>& all = pair_engines();
    std::vector<bool> wanted(all.size(), false);
    for (std::size_t begin = 0; begin <= names.size();) {
        const std::size_t end = std::min(names.find(',', begin), names.size());
        const std::string name = names.substr(begin, end - begin);
        bool known = name == "all" || name == "peers" || name == "structures";
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (name != "all" && name != all[i].name && name != (all[i].peer ? "peers" : "structures")) continue;
            wanted[i] = known = true;
        }
        if (!known) {
            std::string known_names = "all, structures, peers";
            for (const PairEngineInfo& info : all) known_names += ", " + info.name;
            return Error{
                Status::BadArgument, "--engine", fmt::format("found \"{}\", need one of {}", name, known_names), {}};
        }
        begin = end + 1;
    }
    std::vector<const PairEngineInfo*> chosen;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (wanted[i]) chosen.push_back(&all[i]);
    return chosen;
}

/// One engine in the run of one trace.
struct Contender {
    const PairEngineInfo* info = nullptr;
    std::unique_ptr<PairEngine> engine;
    std::vector<double> times;
    double seconds = 0;
    Hasher hash;
    PairBenchRow row;
};

broad::PairSetFingerprint judged(const PairScene& scene) {
    std::vector<broad::Move> moves;
    for (const Aabb& box : scene.boxes) moves.push_back({static_cast<broad::Proxy>(moves.size()), box});
    std::vector<Pair> pairs;
    broad::find_pairs_by_sweep(moves, pairs, [&](broad::Proxy p, broad::Proxy q) { return !scene.both_static(p, q); });
    return broad::print_of(pairs);
}

/// What the engine works to be made and to go through some frames of a part of the boxes, each `stride`-th; seconds.
double seconds_for_part(const PairEngineInfo& info, const PairScene& scene,
                        const std::vector<std::vector<Aabb>>& frames, std::size_t stride) {
    std::vector<std::vector<Aabb>> parts(frames.size());
    std::vector<MotionState> motion_states;
    for (std::size_t i = 0; i < scene.boxes.size(); i += stride) {
        motion_states.push_back(scene.motion_states[i]);
        for (std::size_t k = 0; k < frames.size(); ++k) parts[k].push_back(frames[k][i]);
    }
    std::vector<Pair> pairs;
    const double begin = ms_worked();
    const auto engine = info.make({parts[0], motion_states}, info.name);
    for (const std::vector<Aabb>& part : parts) {
        engine->update(part);
        pairs.clear();
        engine->find_pairs(pairs);
    }
    return (ms_worked() - begin) / 1000;
}

/// How long the first turn would take, about: by how much longer twice as many boxes take. 0 for so few boxes that it
/// does not matter.
double guessed_seconds(const PairEngineInfo& info, const PairScene& scene,
                       const std::vector<std::vector<Aabb>>& frames) {
    if (scene.boxes.size() < 20000) return 0;
    const double few = seconds_for_part(info, scene, frames, 32), twice = seconds_for_part(info, scene, frames, 16);
    return twice * std::pow(std::clamp(twice / few, 2.0, 5.0), 4);
}

/// The engine goes through the frames of a turn. `right` are the prints of their pairs: the first engine to come by
/// fills in those that are not known yet.
void take_turn(Contender& contender, const PairScene& scene, const std::vector<std::vector<Aabb>>& frames, bool first,
               std::vector<broad::PairSetFingerprint>& right, std::vector<Pair>& pairs) {
    if (first) {
        const double begin = ms_worked();
        contender.engine = contender.info->make(scene, contender.info->name);
        contender.row.build_ms = ms_worked() - begin;
        contender.seconds += contender.row.build_ms / 1000;
    }
    for (std::size_t k = 0; k < frames.size(); ++k) {
        pairs.clear();
        const double begin = ms_worked();
        contender.engine->update(frames[k]);
        contender.engine->find_pairs(pairs);
        const double ms = ms_worked() - begin;
        contender.seconds += ms / 1000;
        if (!first || k > 0) contender.times.push_back(ms);
        const broad::PairSetFingerprint print = broad::print_of(pairs);
        if (k == right.size()) right.push_back(print);
        contender.row.right = contender.row.right && print == right[k];
        contender.row.pairs = print.count;
        contender.hash.add(print.sum);
    }
}

void sum_up(Contender& contender) {
    PairBenchRow& row = contender.row;
    row.frames = contender.times.size();
    row.ms = timing_of(contender.times);
    std::vector<double> sorted = contender.times;
    std::sort(sorted.begin(), sorted.end());
    if (!sorted.empty()) {
        row.low = sorted[sorted.size() / 10];
        row.high = sorted[sorted.size() - 1 - sorted.size() / 10];
    }
    row.hash = contender.hash.value();
    row.settings = contender.engine->settings();
    row.bytes = contender.engine->bytes();
    contender.engine.reset();
}

}  // namespace

std::vector<MotionState> motion_states_of(const record::TraceReader& trace) {
    std::vector<MotionState> motion_states;
    for (const std::uint8_t flag : trace.flags()) {
        motion_states.push_back((flag & record::trace_static) != 0   ? MotionState::Static
                                : (flag & record::trace_asleep) != 0 ? MotionState::Asleep
                                                                     : MotionState::Awake);
    }
    return motion_states;
}

Result<std::vector<PairBenchRow>> measure_pair_engines(const std::string& file, const PairBenchOptions& options,
                                                       const PairBenchProgress& progress) {
    const Result<std::vector<const PairEngineInfo*>> named = engines_named(options.engine);
    if (!named) return named.error();
    Result<record::TraceReader> opened = record::TraceReader::open(file);
    if (!opened) return opened.error();
    record::TraceReader& trace = *opened;
    const std::uint64_t total =
        options.frames == 0 ? trace.frames() : std::min<std::uint64_t>(options.frames, trace.frames());
    const std::vector<MotionState> motion_states = motion_states_of(trace);
    const auto count = [&](MotionState one) {
        return static_cast<std::size_t>(std::count(motion_states.begin(), motion_states.end(), one));
    };
    const std::size_t slash = file.find_last_of('/');
    std::string name = slash == std::string::npos ? file : file.substr(slash + 1);
    name = name.substr(0, name.find_last_of('.'));

    std::vector<Contender> contenders(named->size());
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        contenders[i].info = (*named)[i];
        contenders[i].row.trace = name;
        contenders[i].row.engine = contenders[i].info->name;
        contenders[i].row.boxes = motion_states.size();
        contenders[i].row.still = count(MotionState::Static);
        contenders[i].row.asleep = count(MotionState::Asleep);
    }
    std::vector<Aabb> first_frame;
    std::vector<std::vector<Aabb>> frames;
    std::vector<Pair> pairs;
    bool stopped = false;
    for (std::uint64_t at = 0; at < total && !stopped; at += frames.size()) {
        frames.resize(std::min(frames_a_turn, total - at));
        for (std::vector<Aabb>& frame : frames)
            if (const Result<bool> read = trace.next(frame); !read) return read.error();
        if (at == 0) first_frame = frames[0];
        const PairScene scene{first_frame, motion_states};
        std::vector<broad::PairSetFingerprint> right;
        if (at == 0) right.push_back(judged(scene));
        for (Contender& contender : contenders) {
            if (!progress(at, total, name, contender.row.engine)) {
                stopped = true;
                break;
            }
            if (contender.seconds > options.limit) continue;
            if (at == 0 && guessed_seconds(*contender.info, scene, frames) > options.limit) {
                contender.seconds = 2 * options.limit;
                continue;
            }
            take_turn(contender, scene, frames, at == 0, right, pairs);
        }
    }
    std::vector<PairBenchRow> rows;
    for (Contender& contender : contenders) {
        if (!contender.engine && contender.seconds == 0) continue;  // stopped before its turn
        if (contender.engine) sum_up(contender);
        rows.push_back(std::move(contender.row));
    }
    return rows;
}

}  // namespace fase::bench
