#pragma once
/// Traces made by rule: the workloads on which broad phases differ.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fase/core/result.hpp"

namespace fase::record {

/// Of a made trace. Equal numbers give equal bytes with any compiler, on any machine.
struct TraceSettings {
    std::size_t count = 0;     ///< boxes; 0: the kind's own number
    std::uint32_t frames = 0;  ///< of 1/60 s; 0: the kind's own number
    std::uint64_t seed = 1;    ///< another one of the kind
};

/// A kind of trace, as people are told of it.
struct TraceKind {
    std::string_view name, description;
    std::size_t default_count = 0;
    std::uint32_t default_frames = 0;
};

/// All kinds, in the order in which they are told.
[[nodiscard]] std::vector<TraceKind> trace_kinds();

/// What generate_trace() wrote.
struct MadeTrace {
    std::size_t boxes = 0, static_boxes = 0, asleep_boxes = 0;
    std::uint32_t frames = 0;
};

/// Writes a trace of a kind. BadArgument ("kind", "count") for an unknown kind and for more than 10,000,000 boxes; Io
/// as of TraceWriter. Memory for one frame, however many there are.
Result<MadeTrace> generate_trace(std::string_view kind, const TraceSettings& settings, const std::string& file);

}  // namespace fase::record
