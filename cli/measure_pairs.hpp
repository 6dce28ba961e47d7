#pragma once
/// How long structures take to find the pairs of a trace, and whether they find the right ones.
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/timing.hpp"
#include "cli/common/structure_choice.hpp"
#include "fase/broad/search/pair_hash.hpp"
#include "fase/pairs/pair_finder.hpp"
#include "fase/record/trace.hpp"

namespace fase::cli {

/// How many frames are done, of how many, and what is being done; false: stop.
using Tell = std::function<bool(std::uint64_t done, std::uint64_t total, std::string_view what)>;

/// What one structure made of a trace. Nothing is measured when `skipped` says why.
struct PairFigures {
    std::string structure, chosen;
    std::string reason;  ///< of an automatic choice: which population stands in what, and why
    std::string skipped;
    int threads = 1;
    std::uint64_t frames = 0;
    double build_ms = 0;                         ///< filling it with the first frame, pairs of what rests included
    bench::Timing ms;                            ///< of a frame: taking the new boxes and finding all current pairs
    std::uint64_t begun_sum = 0, ended_sum = 0;  ///< pairs that did, all frames but the first; when changes are told
    double min_ms = 0;                           ///< of a frame: what a busy machine disturbs least
    std::uint64_t pairs_first = 0, pairs_last = 0, pairs_sum = 0;  ///< of the first frame, the last one, all
    std::uint64_t hash = 0;       ///< of the pair sets of all frames; the order of pairs within a frame does not count
    broad::StructureStats stats;  ///< of the structures, after the last frame
    std::optional<bool> right;    ///< whether each frame's pairs are the judge's; none: not asked
};

/// A look at a trace before it is measured.
struct TraceSurvey {
    std::uint64_t frames = 0;  ///< that are to be measured
    std::uint64_t static_boxes = 0, asleep_boxes = 0;
    std::vector<broad::PairSetFingerprint> judged;  ///< a frame: its right pairs; empty: not asked
};

/// Reads `frames` frames (0: all) and so judges the file; with `judge` finds their pairs by trying all (up to 1,000
/// boxes) or with a plain sweep. Format as of TraceReader; Capacity for a frame with more pairs than 2^28, guessed
/// from a sample of its boxes; without `judge` a sample of the frames too.
Result<TraceSurvey> survey(record::TraceReader& trace, std::uint64_t frames, bool judge, const Tell& tell);

/// Plays the trace to a structure. With `changes`, a frame tells which pairs began, stay and ended instead of listing
/// all, and what is checked are the sets that follow from them. With a limit, a structure that would take more seconds,
/// or has, is skipped.
Result<PairFigures> measure_pairs(record::TraceReader& trace, const TraceSurvey& survey, const StructureChoice& choice,
                                  TaskRunner& tasks, bool changes, std::optional<double> max_seconds, const Tell& tell);

}  // namespace fase::cli
