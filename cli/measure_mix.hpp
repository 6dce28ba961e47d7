#pragma once
/// Measures what a mix of pairs, rays and box queries costs per frame of a trace in one structure.
#include <cstdint>
#include <optional>
#include <string>

#include "cli/common/structure_choice.hpp"
#include "cli/measure_pairs.hpp"
#include "fase/core/result.hpp"
#include "fase/record/trace.hpp"

namespace fase::cli {

/// How often a program searches per frame.
struct QueryMix {
    std::uint64_t pairs = 0;  ///< finds all pairs
    std::uint64_t rays = 0;   ///< finds the nearest box on a ray
    std::uint64_t boxes = 0;  ///< finds all boxes that overlap a box
};

/// Parses "1 pairs, 200 rays, 50 boxes": any of the three, in any order, each once. BadArgument for anything else.
Result<QueryMix> parse_mix(const std::string& text);
/// "1 pairs, 200 rays, 50 boxes"; leaves out what is 0.
[[nodiscard]] std::string text_of(const QueryMix& mix);

/// The costs of one structure: means over the frames, milliseconds per frame.
struct MixFigures {
    std::string structure;
    std::string skipped;  ///< why nothing was measured; empty: it was
    double build_ms = 0;  ///< of the first frame, not part of the total
    double update_ms = 0, pairs_ms = 0, rays_ms = 0, boxes_ms = 0;
    std::size_t bytes = 0;
    std::uint64_t answers = 0;  ///< a hash of all answers: equal for all structures
    [[nodiscard]] double total_ms() const { return update_ms + pairs_ms + rays_ms + boxes_ms; }
};

/// Replays the trace: static, sleeping and awake boxes are kept in three sets of the structure, which answer all
/// searches. Rays and boxes are random, as those of `fase query`, and the same for every structure. At most 1,000 of a
/// kind are run in a frame; the time of more is extrapolated. A structure that takes more than `max_seconds` is
/// skipped.
Result<MixFigures> measure_mix(record::TraceReader& trace, const TraceSurvey& survey, const StructureChoice& choice,
                               const QueryMix& mix, TaskRunner& tasks, double max_seconds,
                               const ReportProgress& report);

}  // namespace fase::cli
