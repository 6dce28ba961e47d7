#pragma once
/// Measures how long structures take to find the pairs of a trace, and checks the pairs.
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

/// Reports progress: finished frames, all frames, the current work. Returns false to stop.
using ReportProgress = std::function<bool(std::uint64_t done, std::uint64_t total, std::string_view what)>;

/// The figures of one structure for a trace. If `skipped` gives a reason, nothing was measured.
struct PairFigures {
    std::string structure, chosen;
    std::string reason;  ///< of an automatic choice: the structure of each motion state, and why
    std::string skipped;
    int threads = 1;
    std::uint64_t frames = 0;
    double build_ms = 0;                         ///< building it from the first frame, including pairs of resting boxes
    bench::Timing ms;                            ///< per frame: updating the boxes and finding all current pairs
    std::uint64_t begun_sum = 0, ended_sum = 0;  ///< pairs that begin or end after the first frame; with `changes`
    double min_ms = 0;                           ///< per frame: the figure that other load disturbs least
    std::uint64_t pairs_first = 0, pairs_last = 0, pairs_sum = 0;  ///< of the first frame, of the last one, of all
    std::uint64_t hash = 0;       ///< of the pair sets of all frames; independent of the order of pairs in a frame
    broad::StructureStats stats;  ///< of the structures, after the last frame
    std::optional<bool> correct;  ///< whether each frame's pairs match the reference; none: not checked
};

/// Facts about a trace, collected before it is measured.
struct TraceSurvey {
    std::uint64_t frames = 0;  ///< to measure
    std::uint64_t static_boxes = 0, asleep_boxes = 0;
    std::vector<broad::PairSetFingerprint> reference;  ///< per frame: its correct pairs; empty: not checked
};

/// Reads, and so validates, `frames` frames (0: all). With `check`, finds their pairs by testing all (up to 1,000
/// boxes) or with a plain sweep. Format: see TraceReader. Capacity for a frame with more than 2^28 pairs, estimated
/// from a sample of its boxes; without `check` only a sample of the frames is estimated.
Result<TraceSurvey> survey(record::TraceReader& trace, std::uint64_t frames, bool check, const ReportProgress& report);

/// Updates a structure with each frame of the trace and finds the pairs. With `changes`, a frame reports which pairs
/// begin, stay and end instead of listing all; the check then uses the sets that follow from the changes. With a limit,
/// a structure that takes more seconds, or is expected to, is skipped.
Result<PairFigures> measure_pairs(record::TraceReader& trace, const TraceSurvey& survey, const StructureChoice& choice,
                                  TaskRunner& tasks, bool changes, std::optional<double> max_seconds,
                                  const ReportProgress& report);

}  // namespace fase::cli
