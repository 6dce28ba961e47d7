/// Records the boxes of a world's colliders as a trace.
#include "fase/record/world_trace.hpp"

#include "fase/geometry/bounds.hpp"

namespace fase::record {

Result<WorldTrace> WorldTrace::create(const std::string& name, const World& world) {
    std::vector<Tracked> tracked;
    for (const BodyId body : world.bodies())
        for (const ColliderId collider : world.colliders_of(body)) tracked.push_back({body, collider});
    if (tracked.empty())
        return Error{Status::BadArgument, name, "found a world without colliders; expected at least one collider", {}};
    Result<TraceWriter> writer = TraceWriter::create(name, tracked.size());
    if (!writer) return writer.error();
    WorldTrace trace(*std::move(writer));
    trace.tracked_ = std::move(tracked);
    return trace;
}

Result<void> WorldTrace::add_frame(const World& world) {
    boxes_.clear();
    for (Tracked& one : tracked_) {
        const Result<BodyState> body = world.body(one.body);
        if (!body) return body.error();
        const Result<ColliderState> collider = world.collider(one.collider);
        if (!collider) return collider.error();
        const Pose pose = body->pose * collider->def.pose;
        boxes_.push_back(bounds(*collider->shape, pose));
        one.is_static = one.is_static && body->kind == BodyKind::Static;
        one.rests = one.rests && !body->awake;
    }
    return writer_.add_frame(boxes_);
}

std::vector<std::uint8_t> WorldTrace::flags() const {
    std::vector<std::uint8_t> flags;
    for (std::size_t i = 0; i < tracked_.size(); ++i) {
        const bool unmoved = writer_.frames() > 0 && !writer_.moved(i);
        flags.push_back(!unmoved                ? std::uint8_t{0}
                        : tracked_[i].is_static ? std::uint8_t{trace_static}
                        : tracked_[i].rests     ? std::uint8_t{trace_asleep}
                                                : std::uint8_t{0});
    }
    return flags;
}

}  // namespace fase::record
