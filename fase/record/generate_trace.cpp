/// Traces made by rule: one frame at a time, straight into the file.
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

Result<MadeTrace> generate_trace(std::string_view kind, const TraceSettings& settings, const std::string& file) {
    constexpr std::size_t max_boxes = 10'000'000;
    const auto rules = trace_rules();
    const auto rule = std::find_if(rules.begin(), rules.end(), [&](const TraceRule& r) { return r.kind.name == kind; });
    if (rule == rules.end()) {
        std::string names;
        for (const TraceRule& one : rules) names += (names.empty() ? "" : ", ") + std::string(one.kind.name);
        return Error{Status::BadArgument, "kind", fmt::format("found \"{}\", need one of {}", kind, names), {}};
    }
    MadeTrace made;
    made.boxes = settings.count == 0 ? rule->kind.default_count : settings.count;
    made.frames = settings.frames == 0 ? rule->kind.default_frames : settings.frames;
    if (made.boxes > max_boxes)
        return Error{Status::BadArgument, "count", fmt::format("found {}, need at most {}", made.boxes, max_boxes), {}};
    Result<TraceWriter> writer = TraceWriter::create(file, made.boxes);
    if (!writer) return writer.error();

    TraceStage stage;
    stage.room = Aabb::everything();
    Hasher name;
    name.add_bytes(std::as_bytes(std::span(kind)));
    stage.random = Random(settings.seed, name.value());
    stage.bodies.reserve(made.boxes);
    rule->begin(stage, made.boxes);
    std::vector<std::uint8_t> flags;
    for (const TraceBody& body : stage.bodies) {
        flags.push_back(body.flags);
        made.static_boxes += (body.flags & trace_static) != 0 ? 1 : 0;
        made.asleep_boxes += (body.flags & trace_asleep) != 0 ? 1 : 0;
    }
    std::vector<Aabb> boxes;
    for (stage.frame = 0; stage.frame < made.frames; ++stage.frame) {
        if (stage.frame > 0) rule->move(stage);
        boxes.clear();
        for (const TraceBody& body : stage.bodies) boxes.push_back({body.at - body.half, body.at + body.half});
        if (Result<void> added = writer->add_frame(boxes); !added) {
            writer->discard();
            return added.error();
        }
    }
    if (Result<void> finished = writer->finish(flags); !finished) return finished.error();
    return made;
}

}  // namespace fase::record
