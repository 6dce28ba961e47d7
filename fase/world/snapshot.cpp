/// Snapshots and hashes, both generated from one description of the state.
#include <bit>
#include <cstring>
#include <new>

#include "fase/core/detail/file_kind.hpp"
#include "fase/core/detail/text.hpp"
#include "fase/core/hash.hpp"
#include "fase/world/detail/edit.hpp"

namespace fase {
namespace {

using dynamics::Contact;
constexpr std::uint32_t snapshot_version = 1;
constexpr char snapshot_magic[8] = {'F', 'A', 'S', 'E', 'S', 'N', 'A', 'P'};

template <class T>
concept Number = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Feeds every number into a hash.
struct HashArchive {
    static constexpr bool reads = false;
    Hasher hasher;
    template <Number T> void number(T& value) { hasher.add(value); }
    template <class T> void resize(std::vector<T>& v) { hasher.add(v.size()); }
};
/// Writes every number as little-endian bytes.
struct WriteArchive {
    static constexpr bool reads = false;
    std::vector<std::byte> bytes;
    template <Number T> void number(T& value) {
        std::uint64_t word = 0;
        if constexpr (std::is_same_v<T, double>) {
            word = std::bit_cast<std::uint64_t>(value);
        } else if constexpr (std::is_same_v<T, float>) {
            word = std::bit_cast<std::uint32_t>(value);
        } else {
            word = static_cast<std::uint64_t>(value);
        }
        for (std::size_t i = 0; i < sizeof(T); ++i) bytes.push_back(static_cast<std::byte>(word >> (8 * i)));
    }
    template <class T> void resize(std::vector<T>& v) {
        std::uint64_t size = v.size();
        number(size);
    }
};
/// Reads what WriteArchive wrote. A read past the end, or a count larger than the rest of the bytes, sets `failed`;
/// later reads then do nothing.
struct ReadArchive {
    static constexpr bool reads = true;
    std::span<const std::byte> bytes;
    std::size_t at = 0;
    bool failed = false;
    template <Number T> void number(T& value) {
        if (failed || bytes.size() - at < sizeof(T)) {
            failed = true;
            return;
        }
        std::uint64_t word = 0;
        for (std::size_t i = 0; i < sizeof(T); ++i)
            word |= std::uint64_t(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
        at += sizeof(T);
        if constexpr (std::is_same_v<T, double>) {
            value = std::bit_cast<double>(word);
        } else if constexpr (std::is_same_v<T, float>) {
            value = std::bit_cast<float>(static_cast<std::uint32_t>(word));
        } else if constexpr (std::is_same_v<T, bool>) {
            value = word != 0;
        } else {
            value = static_cast<T>(word);
        }
    }
    template <class T> void resize(std::vector<T>& v) {
        std::uint64_t size = 0;
        number(size);
        if (failed || size > bytes.size() - at) {  // every element takes at least one byte
            failed = true;
            return;
        }
        v.resize(size);
    }
};

template <class A, Number T> void describe(A& a, T& value) { a.number(value); }
template <class A, class T> void describe(A& a, Vec3Of<T>& v) {
    a.number(v.x);
    a.number(v.y);
    a.number(v.z);
}
template <class A> void describe(A& a, Quat& q) {
    a.number(q.x);
    a.number(q.y);
    a.number(q.z);
    a.number(q.w);
}
template <class A, class... T> void all(A& a, T&... values);
template <class A, class T> void describe(A& a, std::vector<T>& v);
template <class A, class T, std::size_t n> void describe(A& a, T (&values)[n]) {
    for (T& value : values) describe(a, value);
}

template <class A> void describe(A& a, LocalPose& p) { all(a, p.position, p.rotation); }
template <class A> void describe(A& a, Aabb& box) { all(a, box.lo, box.hi); }
template <class A> void describe(A& a, broad::Pair& pair) { all(a, pair.a, pair.b); }
template <class A> void describe(A& a, MassProperties& m) {
    all(a, m.mass, m.centre, m.inertia.x, m.inertia.y, m.inertia.z);
}
template <class A> void describe(A& a, Material& m) {
    all(a, m.friction, m.restitution, m.friction_combine, m.restitution_combine);
}
template <class A, class Tag> void describe(A& a, Id<Tag>& id) {
    all(a, id.index, id.generation);
    if constexpr (!std::is_same_v<A, HashArchive>) a.number(id.owner);
}
template <class A> void describe(A& a, Settings& s) {
    all(a, s.gravity, s.time_step, s.sub_steps, s.contact_frequency, s.contact_damping_ratio, s.push_out_speed,
        s.restitution_threshold, s.speculative_distance, s.linear_slop, s.contact_reuse_distance, s.box_margin, s.sleep,
        s.sleep_linear_speed, s.sleep_angular_speed, s.sleep_distance, s.sleep_tolerance, s.time_to_sleep,
        s.max_linear_speed, s.max_angular_speed, s.max_pairs);
}
template <class A> void describe(A& a, dynamics::BodyTraits& t) {
    all(a, t.kind, t.motion_state, t.locks, t.can_sleep, t.quarantined, t.mass_given, t.linear_damping,
        t.angular_damping, t.gravity_scale, t.inverse_mass, t.inverse_moments, t.reach, t.inner_radius, t.principal,
        t.first_collider, t.user, t.mass);
}
template <class A> void describe(A& a, dynamics::BodyMotion& m) {
    all(a, m.position, m.rotation, m.linear_velocity, m.angular_velocity, m.sleep_time, m.drift, m.turn, m.island);
}
template <class A> void describe(A& a, dynamics::BodyForces& f) { all(a, f.force, f.torque); }
template <class A> void describe(A& a, Collider& c) {
    all(a, c.body, c.next, c.shape, c.sensor, c.in_principal, c.in_body, c.material, c.density, c.filter.category,
        c.filter.mask, c.filter.group, c.user);
}
template <class A> void describe(A& a, Contact& c) {
    all(a, c.collider_a, c.collider_b, c.body_a, c.body_b, c.generation_a, c.generation_b, c.count, c.sensor,
        c.touching, c.reusable, c.pushes, c.a_rolls, c.b_rolls, c.friction, c.restitution, c.position_a, c.position_b,
        c.rotation_a, c.rotation_b, c.first_normal, c.first_tangent, c.first_offset_a, c.first_offset_b,
        c.first_separation, c.normal, c.tangent, c.offset_a, c.offset_b, c.separation, c.x, c.y, c.feature, c.impulse,
        c.total_impulse, c.friction_impulse, c.twist_impulse, c.nearest, c.approach, c.hit_offset_a);
}
template <class A> void describe(A& a, ConvexHull::Face& f) {
    all(a, f.plane.normal, f.plane.offset, f.first, f.count);
}
template <class A> void describe(A& a, ConvexHull::Edge& e) { all(a, e.from, e.to, e.face_a, e.face_b); }
template <class A, SizedShape S> void describe(A& a, S& shape) {
    for (const ShapeSize<S>& size : S::sizes) a.number(size.in(shape));
}
template <class A> void describe(A& a, ConvexHull& s) { all(a, s.vertices, s.faces, s.face_vertices, s.edges); }

template <class A> void describe(A& a, SharedShape& s) {
    std::uint32_t kind = static_cast<std::uint32_t>(s.shape.index());
    all(a, kind, s.users, s.outer_radius, s.inner_radius, s.key);
    if constexpr (A::reads) {
        std::uint32_t i = 0;
        for_each_shape([&]<class S>() {
            if (i++ == kind) s.shape = S{};
        });
    }
    std::visit([&](auto& shape) { describe(a, shape); }, s.shape);
}

template <class A, class T> void describe(A& a, std::vector<T>& v) {
    a.resize(v);
    for (T& value : v) describe(a, value);
}
template <class A, class... T> void all(A& a, T&... values) { (describe(a, values), ...); }

template <class A, class Tag> void describe(A& a, IdPool<Tag>& pool) {
    std::vector<std::uint16_t> generations;
    std::vector<std::uint8_t> alive;
    std::vector<std::uint32_t> free = pool.free_list();
    for (const auto& slot : pool.slots()) {
        generations.push_back(slot.generation);
        alive.push_back(slot.alive ? 1 : 0);
    }
    all(a, generations, alive, free);
    if constexpr (A::reads) {
        std::vector<typename IdPool<Tag>::Slot> slots;
        for (std::size_t i = 0; i < generations.size() && i < alive.size(); ++i)
            slots.push_back({generations[i], alive[i] != 0});
        pool.restore(std::move(slots), std::move(free));
    }
}

/// The one list of all state of a world that is hashed and saved.
template <class A> void describe(A& a, WorldState& s) {
    all(a, s.settings, s.steps, s.time, s.last_sub_step, s.body_ids, s.bodies.traits, s.bodies.motion, s.bodies.forces,
        s.collider_ids, s.colliders, s.boxes, s.changes, s.shapes, s.free_shapes, s.awake, s.asleep.bodies,
        s.active.pairs, s.active.values, s.resting.pairs, s.resting.values, s.contacts, s.free_contacts,
        s.edited_colliders, s.bodies_to_wake, s.removed_any, s.query_all_awake);
    std::vector<broad::Pair> excluded(s.exclusions.pairs().begin(), s.exclusions.pairs().end());
    describe(a, excluded);
    if constexpr (A::reads) {
        s.exclusions.clear();
        for (const broad::Pair pair : excluded) s.exclusions.add(pair.a, pair.b);
    }
}

/// Whether all indices and lists are valid: the bytes may come from any source.
bool is_consistent(const WorldState& s) {
    const std::size_t bodies = s.body_ids.size(), colliders = s.collider_ids.size();
    if (s.bodies.traits.size() != bodies || s.bodies.motion.size() != bodies || s.bodies.forces.size() != bodies ||
        s.colliders.size() != colliders || s.boxes.size() != colliders || s.changes.size() != colliders)
        return false;
    const auto body_lists_good = [&](const std::vector<std::uint32_t>& list) {
        for (std::size_t i = 0; i < list.size(); ++i)
            if (!s.body_ids.alive_at(list[i]) || (i != 0 && list[i - 1] >= list[i])) return false;
        return true;
    };
    if (!body_lists_good(s.awake) || !body_lists_good(s.asleep.bodies)) return false;
    std::vector<std::uint32_t> chained(colliders, 0);
    for (std::uint32_t body = 0; body < bodies; ++body) {
        const dynamics::BodyTraits& traits = s.bodies.traits[body];
        if (traits.kind > BodyKind::Dynamic || traits.motion_state > MotionState::Awake) return false;
        const std::uint32_t island = s.bodies.motion[body].island;
        if (island != no_index && island >= bodies) return false;
        if (!s.body_ids.alive_at(body)) continue;
        for (std::uint32_t c = traits.first_collider; c != no_index; c = s.colliders[c].next) {
            if (!s.collider_ids.alive_at(c) || s.colliders[c].body != body || chained[c]++ != 0) return false;
        }
    }
    for (std::uint32_t c = 0; c < colliders; ++c)
        if (s.collider_ids.alive_at(c) && (s.colliders[c].shape >= s.shapes.size() || chained[c] != 1)) return false;
    for (const SharedShape& shared : s.shapes)
        if (shared.users != 0 && !check(shared.shape)) return false;
    for (const pairs::PairList* list : {&s.active, &s.resting}) {
        if (list->pairs.size() != list->values.size()) return false;
        for (std::size_t i = 0; i < list->size(); ++i) {
            if (list->pairs[i].a >= colliders || list->pairs[i].b >= colliders || list->values[i] >= s.contacts.size())
                return false;
            const Contact& c = s.contacts[list->values[i]];
            if (c.collider_a != list->pairs[i].a || c.collider_b != list->pairs[i].b || c.body_a >= bodies ||
                c.body_b >= bodies || c.count > 4)
                return false;
        }
    }
    const auto all_below = [](const std::vector<std::uint32_t>& list, std::size_t size) {
        for (const std::uint32_t i : list)
            if (i >= size) return false;
        return true;
    };
    return all_below(s.free_shapes, s.shapes.size()) && all_below(s.free_contacts, s.contacts.size()) &&
           all_below(s.edited_colliders, colliders) && all_below(s.bodies_to_wake, bodies) &&
           all_below(s.body_ids.free_list(), bodies) && all_below(s.collider_ids.free_list(), colliders);
}

Error not_a_snapshot(std::size_t at, std::string found, std::string expected) {
    return {Status::Format, detail::at_byte("snapshot", at),
            "found " + std::move(found) + "; expected " + std::move(expected),
            "pass the bytes that snapshot() of this version returned"};
}

std::uint64_t checksum(std::span<const std::byte> bytes) {
    Hasher hasher;
    hasher.add_bytes(bytes);
    return hasher.value();
}

}  // namespace

std::uint64_t World::hash() const {
    HashArchive archive;
    describe(archive, *state_);
    return archive.hasher.value();
}

std::vector<std::byte> World::snapshot() const {
    WriteArchive payload;
    describe(payload, *state_);
    WriteArchive out;
    for (char letter : snapshot_magic) out.number(letter);
    std::uint32_t version = snapshot_version;
    std::uint64_t size = payload.bytes.size(), sum = checksum(payload.bytes);
    out.number(version);
    out.number(size);
    out.number(sum);
    out.bytes.insert(out.bytes.end(), payload.bytes.begin(), payload.bytes.end());
    return std::move(out.bytes);
}

Result<void> World::restore(std::span<const std::byte> snapshot) {
    ReadArchive head{snapshot};
    char magic[8] = {};
    for (char& letter : magic) head.number(letter);
    std::uint32_t version = 0;
    std::uint64_t size = 0, sum = 0;
    head.number(version);
    head.number(size);
    head.number(sum);
    if (std::memcmp(magic, snapshot_magic, sizeof magic) != 0)
        return not_a_snapshot(0, std::string(name_of(kind_of(snapshot))), "a snapshot, which begins with FASESNAP");
    if (head.failed) return not_a_snapshot(snapshot.size(), "an incomplete head", "a complete snapshot");
    if (version != snapshot_version)
        return not_a_snapshot(8, "version " + std::to_string(version), "version " + std::to_string(snapshot_version));
    const std::span<const std::byte> payload = snapshot.subspan(head.at);
    if (payload.size() != size)
        return not_a_snapshot(12, std::to_string(payload.size()) + " bytes of state", std::to_string(size));
    if (checksum(payload) != sum) return not_a_snapshot(20, "a wrong checksum", "unchanged bytes");
    try {
        auto next = std::make_unique<WorldState>();
        next->body_ids = IdPool<BodyTag>(state_->body_ids.owner());
        next->collider_ids = IdPool<ColliderTag>(state_->collider_ids.owner());
        ReadArchive archive{payload};
        describe(archive, *next);
        if (archive.failed || archive.at != payload.size() || !check(next->settings) || !is_consistent(*next))
            return not_a_snapshot(28 + archive.at, "an inconsistent state", "a consistent one");
        next->own_tasks = std::move(state_->own_tasks);
        next->tasks = state_->tasks;
        next->solver.reference = state_->solver.reference;
        next->box_sets = std::move(state_->box_sets);
        next->box_sets.clear();
        for (std::uint32_t c = 0; c < next->collider_ids.size(); ++c) {
            if (!next->collider_ids.alive_at(c)) continue;
            const broad::Move move{c, next->boxes[c]};
            next->box_sets.of(next->bodies.traits[next->colliders[c].body].motion_state).insert(std::span(&move, 1));
        }
        next->box_sets.commit_as_they_are();
        next->asleep.relink(next->bodies.motion);
        measure_asleep_overhang(*next, next->asleep.bodies);
        for (std::uint32_t i = 0; i < next->shapes.size(); ++i)
            if (next->shapes[i].users != 0) next->shape_of_key.emplace(next->shapes[i].key, i);
        state_ = std::move(next);
        return {};
    } catch (const std::bad_alloc&) {
        return Error{Status::NoMemory, "World::restore", "out of memory for the snapshot", ""};
    }
}

}  // namespace fase
