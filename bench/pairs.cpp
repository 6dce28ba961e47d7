/// The benchmark behind `fase bench pairs`: alternating turns, the time limit, and the check of all pairs.
#include "bench/pairs.hpp"

#include <fmt/format.h>
#include <tuple>

#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/pair_engine.hpp"
#include "bench/split_list.hpp"
#include "fase/broad/search/pair_hash.hpp"
#include "fase/broad/search/plain_sweep.hpp"
#include "fase/core/hash.hpp"
#include "fase/record/trace.hpp"

namespace fase::bench {
namespace {

/// Frames per turn of an engine: few, so that noise affects all engines alike; several, so that an engine's own data is
/// in the caches most of the time.
constexpr std::uint64_t frames_per_turn = 6;

/// Returns the engines in a list like "row_grid,peers", in the order of THE list.
Result<std::vector<const PairEngineInfo*>> engines_named(const std::string& names) {
    const std::vector<PairEngineInfo>& all = pair_engines();
    std::vector<bool> selected(all.size(), false);
    for (const std::string& name : split_list(names)) {
        bool known = name == "all" || name == "peers" || name == "structures";
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (name != "all" && name != all[i].name && name != (all[i].peer ? "peers" : "structures")) continue;
            selected[i] = known = true;
        }
        if (!known) {
            std::string known_names = "all, structures, peers";
            for (const PairEngineInfo& info : all) known_names += ", " + info.name;
            return Error{Status::BadArgument,
                         "--engine",
                         fmt::format("found \"{}\"; expected one of {}", name, known_names),
                         {}};
        }
    }
    std::vector<const PairEngineInfo*> chosen;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (selected[i]) chosen.push_back(&all[i]);
    return chosen;
}

/// One engine on one trace.
struct Contender {
    const PairEngineInfo* info = nullptr;
    std::unique_ptr<PairEngine> engine;
    std::vector<double> times;
    double seconds = 0;
    Hasher hash;
    PairBenchRow row;
};

/// Returns the fingerprint of the pairs that a plain sweep finds.
broad::PairSetFingerprint reference_pairs(const PairScene& scene) {
    std::vector<broad::Move> moves;
    for (const Aabb& box : scene.boxes) moves.push_back({static_cast<broad::Proxy>(moves.size()), box});
    std::vector<Pair> pairs;
    broad::find_pairs_by_sweep(moves, pairs, [&](broad::Proxy p, broad::Proxy q) { return !scene.both_static(p, q); });
    return broad::fingerprint_of(pairs);
}

/// Returns the processor seconds to construct the engine and process some frames, with every `stride`-th box.
double seconds_for_subset(const PairEngineInfo& info, const PairScene& scene,
                          const std::vector<std::vector<Aabb>>& frames, std::size_t stride) {
    std::vector<std::vector<Aabb>> subset(frames.size());
    std::vector<MotionState> motion_states;
    for (std::size_t i = 0; i < scene.boxes.size(); i += stride) {
        motion_states.push_back(scene.motion_states[i]);
        for (std::size_t k = 0; k < frames.size(); ++k) subset[k].push_back(frames[k][i]);
    }
    std::vector<Pair> pairs;
    const double begin = cpu_ms();
    const auto engine = info.make({subset[0], motion_states}, info.name);
    for (const std::vector<Aabb>& frame : subset) {
        engine->update(frame);
        pairs.clear();
        engine->find_pairs(pairs);
    }
    return (cpu_ms() - begin) / 1000;
}

/// Estimates the seconds of the first turn from the growth between two subsets of the boxes. 0 for scenes that are too
/// small to matter.
double estimated_seconds(const PairEngineInfo& info, const PairScene& scene,
                         const std::vector<std::vector<Aabb>>& frames) {
    if (scene.boxes.size() < 20000) return 0;
    const double few = seconds_for_subset(info, scene, frames, 32), twice = seconds_for_subset(info, scene, frames, 16);
    return twice * std::pow(std::clamp(twice / few, 2.0, 5.0), 4);
}

/// Runs one engine through the frames of a turn. `expected` holds the fingerprints of their pairs; the first engine
/// appends the missing ones.
void run_turn(Contender& contender, const PairScene& scene, const std::vector<std::vector<Aabb>>& frames, bool first,
              std::vector<broad::PairSetFingerprint>& expected, std::vector<Pair>& pairs) {
    if (first) {
        const double begin = cpu_ms();
        contender.engine = contender.info->make(scene, contender.info->name);
        contender.row.build_ms = cpu_ms() - begin;
        contender.seconds += contender.row.build_ms / 1000;
    }
    for (std::size_t k = 0; k < frames.size(); ++k) {
        pairs.clear();
        const double begin = cpu_ms();
        contender.engine->update(frames[k]);
        contender.engine->find_pairs(pairs);
        const double ms = cpu_ms() - begin;
        contender.seconds += ms / 1000;
        if (!first || k > 0) contender.times.push_back(ms);
        const broad::PairSetFingerprint fingerprint = broad::fingerprint_of(pairs);
        if (k == expected.size()) expected.push_back(fingerprint);
        contender.row.correct = contender.row.correct && fingerprint == expected[k];
        contender.row.pairs = fingerprint.count;
        contender.hash.add(fingerprint.sum);
    }
}

/// Computes the row from the times, then destroys the engine.
void summarise(Contender& contender) {
    PairBenchRow& row = contender.row;
    row.frames = contender.times.size();
    row.ms = timing_of(contender.times);
    std::tie(row.low, row.high) = tenths_of(contender.times);
    row.hash = contender.hash.value();
    row.settings = contender.engine->settings();
    row.bytes = contender.engine->bytes();
    contender.engine.reset();
}

}  // namespace

Result<std::vector<PairBenchRow>> measure_pair_engines(const std::string& file, const PairBenchOptions& options,
                                                       const PairBenchProgress& progress) {
    const Result<std::vector<const PairEngineInfo*>> named = engines_named(options.engine);
    if (!named) return named.error();
    Result<record::TraceReader> opened = record::TraceReader::open(file);
    if (!opened) return opened.error();
    record::TraceReader& trace = *opened;
    const std::uint64_t total =
        options.frames == 0 ? trace.frames() : std::min<std::uint64_t>(options.frames, trace.frames());
    const std::vector<MotionState> motion_states = trace.motion_states();
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
        contenders[i].row.static_count = count(MotionState::Static);
        contenders[i].row.asleep_count = count(MotionState::Asleep);
    }
    std::vector<Aabb> first_frame;
    std::vector<std::vector<Aabb>> frames;
    std::vector<Pair> pairs;
    bool stopped = false;
    for (std::uint64_t begin = 0; begin < total && !stopped; begin += frames.size()) {
        frames.resize(std::min(frames_per_turn, total - begin));
        for (std::vector<Aabb>& frame : frames)
            if (const Result<bool> read = trace.next(frame); !read) return read.error();
        if (begin == 0) first_frame = frames[0];
        const PairScene scene{first_frame, motion_states};
        std::vector<broad::PairSetFingerprint> expected;
        if (begin == 0) expected.push_back(reference_pairs(scene));
        for (Contender& contender : contenders) {
            if (!progress(begin, total, name, contender.row.engine)) {
                stopped = true;
                break;
            }
            if (contender.seconds > options.limit) continue;
            if (begin == 0 && estimated_seconds(*contender.info, scene, frames) > options.limit) {
                contender.seconds = 2 * options.limit;
                continue;
            }
            run_turn(contender, scene, frames, begin == 0, expected, pairs);
        }
    }
    std::vector<PairBenchRow> rows;
    for (Contender& contender : contenders) {
        if (!contender.engine && contender.seconds == 0) continue;  // stopped before its first turn
        if (contender.engine) summarise(contender);
        rows.push_back(std::move(contender.row));
    }
    return rows;
}

}  // namespace fase::bench
