/// Converts a world to rows and frames.
#include "fase/record/recorder.hpp"

#include <algorithm>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "fase/core/no_index.hpp"
#include "fase/core/version.hpp"

namespace fase::record {
namespace {

/// Maps ids to rows. Each slot stores the row and generation of its latest id.
template <class Id> class RowMap {
public:
    /// Returns the row of an id; no_index if it has none.
    [[nodiscard]] std::uint32_t find(Id id) const {
        return id.index < slots_.size() && slots_[id.index].generation == id.generation ? slots_[id.index].row
                                                                                        : no_index;
    }
    void set(Id id, std::uint32_t row) {
        if (id.index >= slots_.size()) slots_.resize(std::size_t(id.index) + 1);
        slots_[id.index] = {row, id.generation};
    }

private:
    struct Slot {
        std::uint32_t row = no_index;
        std::uint16_t generation = 0;
    };
    std::vector<Slot> slots_;
};

struct Counter {
    const char* name;
    std::uint64_t (*read)(const StepReport&);
};
constexpr std::array counters{
    Counter{"bodies", [](const StepReport& r) -> std::uint64_t { return r.bodies; }},
    Counter{"awake", [](const StepReport& r) -> std::uint64_t { return r.awake; }},
    Counter{"asleep", [](const StepReport& r) -> std::uint64_t { return r.asleep; }},
    Counter{"boxes_moved", [](const StepReport& r) -> std::uint64_t { return r.boxes_moved; }},
    Counter{"candidates", [](const StepReport& r) -> std::uint64_t { return r.candidates; }},
    Counter{"pairs", [](const StepReport& r) -> std::uint64_t { return r.pairs; }},
    Counter{"manifolds", [](const StepReport& r) -> std::uint64_t { return r.manifolds; }},
    Counter{"manifolds_reused", [](const StepReport& r) -> std::uint64_t { return r.manifolds_reused; }},
    Counter{"contact_points", [](const StepReport& r) -> std::uint64_t { return r.contact_points; }},
    Counter{"colours", [](const StepReport& r) -> std::uint64_t { return r.colours; }},
    Counter{"overflow", [](const StepReport& r) -> std::uint64_t { return r.overflow; }},
    Counter{"islands", [](const StepReport& r) -> std::uint64_t { return r.islands; }},
    Counter{"bytes", [](const StepReport& r) -> std::uint64_t { return r.bytes; }},
    Counter{"speed_clamped", [](const StepReport& r) -> std::uint64_t { return r.speed_clamped; }},
    Counter{"pairs_dropped", [](const StepReport& r) -> std::uint64_t { return r.pairs_dropped; }},
    Counter{"quarantined", [](const StepReport& r) -> std::uint64_t { return r.quarantined; }},
};

std::uint64_t key_of(BodyId id) { return std::uint64_t(id.index) << 16 | id.generation; }

}  // namespace

struct Recorder::State {
    explicit State(RecordingWriter to) : writer(std::move(to)) {}

    Result<void> add_bodies(const World& world);
    Result<std::uint32_t> add_body(const World& world, const BodyState& body);
    Result<std::uint32_t> add_collider(const World& world, ColliderId id, std::uint32_t body_row);
    Result<std::uint32_t> shape_row(const Shape& shape);
    Result<void> refresh_colliders(const World& world);
    void read_report(const World& world);
    Result<void> read_events(const World& world);
    Result<void> read_contacts(const World& world);
    /// Returns the row of a collider; adds one for a new collider. Returns no_index for a removed collider without a
    /// row.
    Result<std::uint32_t> row_of(const World& world, ColliderId id);
    template <class Pair> Result<bool> set_pair(const World& world, ColliderId a, ColliderId b, Pair& pair);
    template <class Event>
    Result<void> read_pairs(const World& world, const std::vector<Event>& events, std::vector<ColliderPair>& pairs,
                            EventCollider Event::*a, EventCollider Event::*b);

    RecordingWriter writer;
    bool contacts = false;
    std::unordered_map<std::uint64_t, BodyLook> looks;
    RowMap<BodyId> body_rows;
    RowMap<ColliderId> collider_rows;
    std::vector<std::vector<ColliderId>> colliders;             ///< by body row, as of the last refresh
    std::unordered_map<std::string, std::uint32_t> shape_rows;  ///< by their bytes
    std::vector<BodyState> bodies;
    std::vector<ContactState> contact_states;
    Frame frame;
};

Result<std::uint32_t> Recorder::State::shape_row(const Shape& shape) {
    const RecordedShape stored = recorded(shape);
    ByteWriter bytes;
    write(bytes, stored);
    const auto letters = bytes.bytes();
    const auto [found, inserted] =
        shape_rows.try_emplace(std::string(reinterpret_cast<const char*>(letters.data()), letters.size()), 0);
    if (!inserted) return found->second;
    const Result<std::uint32_t> row = writer.add(stored);
    if (row) found->second = *row;
    return row;
}

Result<std::uint32_t> Recorder::State::add_collider(const World& world, ColliderId id, std::uint32_t body_row) {
    const Result<ColliderState> state = world.collider(id);
    if (!state) return state.error();
    const Result<std::uint32_t> shape = shape_row(*(*state).shape);
    if (!shape) return shape;
    RecordedCollider collider;
    collider.index = id.index;
    collider.generation = id.generation;
    collider.sensor = (*state).def.sensor;
    collider.body = body_row;
    collider.shape = *shape;
    collider.first_frame = writer.frames();
    collider.pose = (*state).def.pose;
    collider.pose.rotation = normalized(collider.pose.rotation);
    const Result<std::uint32_t> row = writer.add(collider);
    if (row) collider_rows.set(id, *row);
    return row;
}

Result<std::uint32_t> Recorder::State::add_body(const World& world, const BodyState& body) {
    RecordedBody recorded_body;
    recorded_body.index = body.id.index;
    recorded_body.generation = body.id.generation;
    recorded_body.kind = static_cast<std::uint8_t>(body.kind);
    recorded_body.user = body.user;
    recorded_body.mass = body.mass;
    const auto look = looks.find(key_of(body.id));
    if (look != looks.end()) {
        recorded_body.name = look->second.name;
        recorded_body.colour = look->second.colour;
    }
    const Result<std::uint32_t> row = writer.add(recorded_body);
    if (!row) return row;
    body_rows.set(body.id, *row);
    colliders.resize(std::size_t(*row) + 1);
    colliders[*row] = world.colliders_of(body.id);
    for (const ColliderId id : colliders[*row]) {
        if (collider_rows.find(id) != no_index) continue;
        if (Result<std::uint32_t> added = add_collider(world, id, *row); !added) return added;
    }
    if (look != looks.end()) {
        for (const Visual& visual : look->second.visuals) {
            RecordedVisual shown{*row, visual.mesh, visual.pose, visual.colour};
            shown.pose.rotation = normalized(shown.pose.rotation);
            if (Result<std::uint32_t> added = writer.add(shown); !added) return added;
        }
    }
    return row;
}

Result<void> Recorder::State::add_bodies(const World& world) {
    bodies.clear();
    world.read_bodies(bodies);
    frame.bodies.clear();
    bool ascending = true;
    for (const BodyState& body : bodies) {
        std::uint32_t row = body_rows.find(body.id);
        if (row == no_index) {
            const Result<std::uint32_t> added = add_body(world, body);
            if (!added) return added.error();
            row = *added;
        }
        ascending = ascending && (frame.bodies.empty() || frame.bodies.back().row < row);
        frame.bodies.push_back(
            {row, static_cast<std::uint8_t>(body.kind), body.awake, body.quarantined, body.island + 1, body.pose});
    }
    if (!ascending) {
        std::sort(frame.bodies.begin(), frame.bodies.end(),
                  [](const BodyFrame& a, const BodyFrame& b) { return a.row < b.row; });
    }
    return {};
}

Result<void> Recorder::State::refresh_colliders(const World& world) {
    for (const BodyState& body : bodies) {
        const std::uint32_t row = body_rows.find(body.id);
        std::vector<ColliderId> now = world.colliders_of(body.id);
        if (now == colliders[row]) continue;
        for (const ColliderId id : colliders[row]) {
            if (std::find(now.begin(), now.end(), id) != now.end()) continue;
            if (Result<void> ended = writer.end_collider(collider_rows.find(id)); !ended) return ended;
        }
        for (const ColliderId id : now) {
            if (collider_rows.find(id) != no_index) continue;
            if (Result<std::uint32_t> added = add_collider(world, id, row); !added) return added.error();
        }
        colliders[row] = std::move(now);
    }
    return {};
}

void Recorder::State::read_report(const World& world) {
    const StepReport& report = world.last_report();
    frame.step = world.steps();
    frame.time = world.time();
    frame.total_ms = static_cast<float>(report.total_ms);
    frame.stage_ms.clear();
    for (const double ms : report.ms) frame.stage_ms.push_back(static_cast<float>(ms));
    frame.counters.clear();
    for (const Counter& counter : counters) frame.counters.push_back(counter.read(report));
}

Result<std::uint32_t> Recorder::State::row_of(const World& world, ColliderId id) {
    const std::uint32_t row = collider_rows.find(id);
    if (row != no_index) return row;
    const Result<ColliderState> state = world.collider(id);
    if (!state) return no_index;
    const std::uint32_t body_row = body_rows.find((*state).body);
    if (body_row == no_index) return no_index;
    colliders[body_row].push_back(id);
    return add_collider(world, id, body_row);
}

/// Sets the rows of a pair. Returns whether both colliders have one.
template <class Pair>
Result<bool> Recorder::State::set_pair(const World& world, ColliderId a, ColliderId b, Pair& pair) {
    const Result<std::uint32_t> row_a = row_of(world, a);
    if (!row_a) return row_a.error();
    const Result<std::uint32_t> row_b = row_of(world, b);
    if (!row_b) return row_b.error();
    pair.a = *row_a;
    pair.b = *row_b;
    return pair.a != no_index && pair.b != no_index;
}

template <class Event>
Result<void> Recorder::State::read_pairs(const World& world, const std::vector<Event>& events,
                                         std::vector<ColliderPair>& pairs, EventCollider Event::*a,
                                         EventCollider Event::*b) {
    pairs.clear();
    for (const Event& event : events) {
        ColliderPair pair;
        const Result<bool> known = set_pair(world, event.*a, event.*b, pair);
        if (!known) return known.error();
        if (*known) pairs.push_back(pair);
    }
    return {};
}

Result<void> Recorder::State::read_events(const World& world) {
    const Events& events = world.events();
    using Contact = ContactEvent;
    using Sensor = SensorEvent;
    if (auto r = read_pairs(world, events.contacts_begun, frame.contacts_begun, &Contact::a, &Contact::b); !r) return r;
    if (auto r = read_pairs(world, events.contacts_ended, frame.contacts_ended, &Contact::a, &Contact::b); !r) return r;
    if (auto r = read_pairs(world, events.sensors_begun, frame.sensors_begun, &Sensor::sensor, &Sensor::visitor); !r) {
        return r;
    }
    if (auto r = read_pairs(world, events.sensors_ended, frame.sensors_ended, &Sensor::sensor, &Sensor::visitor); !r) {
        return r;
    }
    frame.hits.clear();
    for (const HitEvent& hit : events.hits) {
        HitFrame recorded_hit{0, 0, hit.point, hit.normal, hit.speed, hit.impulse};
        const Result<bool> known = set_pair(world, hit.a, hit.b, recorded_hit);
        if (!known) return known.error();
        if (*known) frame.hits.push_back(recorded_hit);
    }
    return {};
}

Result<void> Recorder::State::read_contacts(const World& world) {
    frame.contacts.clear();
    if (!contacts) return {};
    contact_states.clear();
    world.read_contacts(contact_states);
    for (const ContactState& contact : contact_states) {
        if (contact.sensor) continue;
        ContactFrame recorded_contact;
        const Result<bool> known = set_pair(world, contact.a, contact.b, recorded_contact);
        if (!known) return known.error();
        if (!*known) continue;
        recorded_contact.normal = contact.normal;
        recorded_contact.count = std::clamp(contact.count, 0, 4);
        recorded_contact.points = contact.points;
        recorded_contact.separations = contact.separations;
        recorded_contact.impulses = contact.impulses;
        frame.contacts.push_back(recorded_contact);
    }
    return {};
}

Recorder::Recorder(std::unique_ptr<State> state) : state_(std::move(state)) {}
Recorder::Recorder(Recorder&&) noexcept = default;
Recorder& Recorder::operator=(Recorder&& other) noexcept {
    if (this != &other) {
        if (state_ != nullptr) (void)state_->writer.finish();
        state_ = std::move(other.state_);
    }
    return *this;
}
Recorder::~Recorder() {
    if (state_ != nullptr) (void)state_->writer.finish();
}
const RecordingWriter& Recorder::writer() const { return state_->writer; }

Result<Recorder> Recorder::create(const std::string& name, const World& world, const RecordingHead& head,
                                  const RecorderOptions& options) {
    for (const BodyLook& look : head.looks) {
        for (const Visual& visual : look.visuals) {
            if (visual.mesh >= head.meshes.size()) {
                return Error{Status::BadArgument,
                             "RecordingHead.looks",
                             "found a visual with mesh " + std::to_string(visual.mesh) + "; expected one below " +
                                 std::to_string(head.meshes.size()),
                             {}};
            }
        }
    }
    Head file_head;
    file_head.title = head.title;
    file_head.program = "fase " + std::string(library_version());
    file_head.time_step = world.settings().time_step;
    file_head.gravity = world.settings().gravity;
    for (const std::string_view stage : stage_names) file_head.stage_names.emplace_back(stage);
    for (const Counter& counter : counters) file_head.counter_names.emplace_back(counter.name);
    Result<RecordingWriter> writer = RecordingWriter::create(name, std::move(file_head), options);
    if (!writer) return writer.error();
    auto state = std::make_unique<State>(std::move(*writer));
    state->contacts = options.contacts;
    for (const BodyLook& look : head.looks) state->looks.insert_or_assign(key_of(look.body), look);
    for (const RecordedMesh& mesh : head.meshes) {
        if (Result<std::uint32_t> added = state->writer.add(mesh); !added) return added.error();
    }
    if (Result<void> added = state->add_bodies(world); !added) return added.error();
    if (Result<void> flushed = state->writer.flush(); !flushed) return flushed.error();
    return Recorder(std::move(state));
}

Result<void> Recorder::add_frame(const World& world) {
    State& state = *state_;
    if (Result<void> added = state.add_bodies(world); !added) return added;
    if (state.writer.at_block_begin()) {
        if (Result<void> refreshed = state.refresh_colliders(world); !refreshed) return refreshed;
    }
    state.read_report(world);
    if (Result<void> read = state.read_events(world); !read) return read;
    if (Result<void> read = state.read_contacts(world); !read) return read;
    return state.writer.add_frame(state.frame);
}

Result<void> Recorder::flush() { return state_->writer.flush(); }
Result<void> Recorder::finish() { return state_->writer.finish(); }

}  // namespace fase::record
