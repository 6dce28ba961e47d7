#pragma once
/// Generates traces: workloads that show the differences between broad phases.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "fase/core/result.hpp"

namespace fase::record {

/// The settings of a generated trace. Equal settings give equal bytes with any compiler, on any machine.
struct TraceSettings {
    std::size_t count = 0;     ///< number of boxes; 0: the default of the kind
    std::uint32_t frames = 0;  ///< frames of 1/60 s; 0: the default of the kind
    std::uint64_t seed = 1;    ///< selects a variant of the kind
};

/// The description of a kind of trace.
struct TraceKind {
    std::string_view name, description;
    std::size_t default_count = 0;
    std::uint32_t default_frames = 0;
};

/// Returns all kinds, in display order.
[[nodiscard]] std::vector<TraceKind> trace_kinds();

/// The counts of a trace that generate_trace() wrote.
struct GeneratedTrace {
    std::size_t boxes = 0, static_boxes = 0, asleep_boxes = 0;
    std::uint32_t frames = 0;
    bool stopped = false;  ///< `keep_going` returned false: no file was written
};

/// Writes a trace of a kind. Errors: BadArgument (where: "kind", "count") for an unknown kind and for more than
/// 10,000,000 boxes; Io as in TraceWriter. Needs memory for one frame, regardless of the number of frames.
/// @param keep_going called before each frame, when `file` has a `.part`; false stops and removes that
Result<GeneratedTrace> generate_trace(std::string_view kind, const TraceSettings& settings, const std::string& file,
                                      const std::function<bool()>& keep_going = {});

}  // namespace fase::record
