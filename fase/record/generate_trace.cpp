/// Generates traces: writes one frame at a time to the file.
#include "fase/record/generate_trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "fase/record/trace.hpp"
#include "fase/record/trace/trace_rules.hpp"

namespace fase::record {

std::vector<TraceKind> trace_kinds() {
    std::vector<TraceKind> kinds;
    for (const TraceRule& rule : trace_rules()) kinds.push_back(rule.kind);
    return kinds;
}

Result<GeneratedTrace> generate_trace(std::string_view kind, const TraceSettings& settings, const std::string& file,
                                      const std::function<bool()>& keep_going) {
    constexpr std::size_t max_boxes = 10'000'000;
    const auto rules = trace_rules();
    const auto rule = std::find_if(rules.begin(), rules.end(), [&](const TraceRule& r) { return r.kind.name == kind; });
    if (rule == rules.end()) {
        std::string names;
        for (const TraceRule& one : rules) names += (names.empty() ? "" : ", ") + std::string(one.kind.name);
        return Error{Status::BadArgument, "kind", fmt::format("found \"{}\"; expected one of {}", kind, names), {}};
    }
    GeneratedTrace generated;
    generated.boxes = settings.count == 0 ? rule->kind.default_count : settings.count;
    generated.frames = settings.frames == 0 ? rule->kind.default_frames : settings.frames;
    if (generated.boxes > max_boxes)
        return Error{
            Status::BadArgument, "count", fmt::format("found {}; expected at most {}", generated.boxes, max_boxes), {}};
    Result<TraceWriter> writer = TraceWriter::create(file, generated.boxes);
    if (!writer) return writer.error();

    TraceState state;
    state.walls = Aabb::everything();
    Hasher name;
    name.add_bytes(std::as_bytes(std::span(kind)));
    state.random = Random(settings.seed, name.value());
    state.bodies.reserve(generated.boxes);
    rule->begin(state, generated.boxes);
    std::vector<std::uint8_t> flags;
    for (const TraceBody& body : state.bodies) {
        flags.push_back(body.flags);
        generated.static_boxes += (body.flags & trace_static) != 0 ? 1 : 0;
        generated.asleep_boxes += (body.flags & trace_asleep) != 0 ? 1 : 0;
    }
    std::vector<Aabb> boxes;
    for (state.frame = 0; state.frame < generated.frames; ++state.frame) {
        if (keep_going && !keep_going()) {
            writer->discard();
            generated.stopped = true;
            return generated;
        }
        if (state.frame > 0) rule->move(state);
        boxes.clear();
        for (const TraceBody& body : state.bodies) boxes.push_back({body.centre - body.half, body.centre + body.half});
        if (Result<void> added = writer->add_frame(boxes); !added) {
            Error error = added.error();
            if (error.where == writer->path()) error.where = file;  // the part is gone
            writer->discard();
            return error;
        }
    }
    if (Result<void> finished = writer->finish(flags); !finished) return finished.error();
    return generated;
}

}  // namespace fase::record
