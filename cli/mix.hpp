#pragma once
/// `fase pairs --mix`: which structure suits a program that finds pairs, casts rays and queries boxes.
#include "cli/measure_pairs.hpp"
#include "cli/pairs.hpp"

namespace fase::cli {

/// Measures the mix in all structures and prints them, the cheapest first. Returns the exit code: 0; 1 structures gave
/// different answers; 2 the mix or the trace is invalid; 130 or 143 when a signal ended the run.
int run_mix(const PairsOptions& options, record::TraceReader& trace, const TraceSurvey& survey, TaskRunner& tasks,
            const ReportProgress& report);

}  // namespace fase::cli
