/// Snapshots and hashes, both generated from one description of the state.
#include <bit>
#include <cmath>
#include <cstring>
#include <new>

#include "fase/core/detail/file_kind.hpp"
#include "fase/core/detail/text.hpp"
#include "fase/core/hash.hpp"
#include "fase/world/detail/check_state.hpp"
#include "fase/world/detail/edit.hpp"

namespace fase {
namespace {

using dynamics::Contact;
constexpr std::uint32_t snapshot_version = 5;
constexpr char snapshot_magic[8] = {'F', 'A', 'S', 'E', 'S', 'N', 'A', 'P'};
constexpr std::size_t head_size = sizeof snapshot_magic + 4 + 8 + 8;

template <class T>
concept Number = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Feeds every number into a hash.
struct HashArchive {
    static constexpr bool reads = false, saves = false;
    Hasher hasher;
    template <Number T> void number(T& value) { hasher.add(value); }
    template <class T> void resize(std::vector<T>& v) { hasher.add(v.size()); }
};
/// Counts the bytes that WriteArchive writes.
struct SizeArchive {
    static constexpr bool reads = false, saves = true;
    std::size_t size = 0;
    template <Number T> void number(T&) { size += sizeof(T); }
    template <class T> void resize(std::vector<T>&) { size += sizeof(std::uint64_t); }
};
/// Writes every number as little-endian bytes, into memory that is large enough.
struct WriteArchive {
    static constexpr bool reads = false, saves = true;
    std::byte* to = nullptr;
    template <Number T> void number(T& value) {
        std::uint64_t word = 0;
        if constexpr (std::is_same_v<T, double>) {
            word = std::bit_cast<std::uint64_t>(value);
        } else if constexpr (std::is_same_v<T, float>) {
            word = std::bit_cast<std::uint32_t>(value);
        } else {
            word = static_cast<std::uint64_t>(value);
        }
        for (std::size_t i = 0; i < sizeof(T); ++i) *to++ = static_cast<std::byte>(word >> (8 * i));
    }
    template <class T> void resize(std::vector<T>& v) {
        std::uint64_t size = v.size();
        number(size);
    }
};
/// Returns the bytes that WriteArchive writes for the smallest value of a type.
template <class T> std::size_t smallest_size() {
    T value{};
    if constexpr (std::is_same_v<T, SharedShape>) value.shape = HalfSpace{};
    SizeArchive archive;
    describe(archive, value);
    return archive.size;
}
/// Reads what WriteArchive wrote. A read past the end, or a count of more elements than the rest of the bytes can hold,
/// sets `failed`; later reads then do nothing.
struct ReadArchive {
    static constexpr bool reads = true, saves = true;
    std::span<const std::byte> bytes;
    const ColliderTable* known = nullptr;  ///< whose meshes need not be built again
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
            if (word > 1) failed = true;
            value = word != 0;
        } else {
            value = static_cast<T>(word);
        }
    }
    template <class T> void resize(std::vector<T>& v) {
        std::uint64_t size = 0;
        number(size);
        if (failed || size > (bytes.size() - at) / smallest_size<T>()) {
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
    if constexpr (A::saves) all(a, c.generation_a, c.generation_b, c.on_mesh);
    all(a, c.collider_a, c.collider_b, c.body_a, c.body_b, c.manifolds, c.coloured, c.points, c.sensor, c.sensor_is_b,
        c.touching, c.reusable, c.nearest, c.reuse_distance, c.b_from_a, c.rotation_a, c.rotation_b);
}
template <class A> void describe(A& a, dynamics::ContactManifold& m) {
    all(a, m.key.child_a, m.key.child_b, m.key.triangle, m.count, m.a_rolls, m.b_rolls, m.colour.number, m.colour.moves,
        m.friction, m.restitution, m.normal, m.first_tangent, m.first_offset_a, m.first_offset_b, m.first_separation,
        m.tangent, m.offset_a, m.offset_b, m.separation, m.x, m.y, m.feature, m.impulse, m.total_impulse,
        m.friction_impulse, m.twist_impulse);
}
template <class A> void describe(A& a, EventCollider& c) {
    all(a, c.index, c.generation, c.owner, c.body.index, c.body.generation, c.body.owner, c.user, c.body_user);
}
template <class A> void describe(A& a, OpenHit& h) {
    if constexpr (A::saves) all(a, h.a, h.b);
    all(a, h.a.index, h.b.index, h.point, h.normal, h.speed, h.impulse, h.steps);
}
template <class A> void describe(A& a, ConvexHull::Face& f) {
    all(a, f.plane.normal, f.plane.offset, f.first, f.count);
}
template <class A> void describe(A& a, ConvexHull::Edge& e) { all(a, e.from, e.to, e.face_a, e.face_b); }
template <class A> void describe(A& a, std::array<std::uint32_t, 3>& corners) {
    all(a, corners[0], corners[1], corners[2]);
}

/// The lists of a mesh: the same for writing and for reading.
struct MeshLists {
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> corners;
    std::vector<std::uint32_t> numbers;
    std::vector<std::uint8_t> materials;
    MeshReport report;
    bool two_sided = false;
};
template <class A> void describe(A& a, MeshLists& m) {
    all(a, m.vertices, m.corners, m.numbers, m.materials, m.report.degenerate, m.report.duplicate, m.report.open_edges,
        m.report.non_manifold_edges, m.two_sided);
}
template <class A> void describe_data(A& a, const CollisionMesh& mesh) {
    MeshLists lists{{mesh.vertices().begin(), mesh.vertices().end()},
                    {},
                    {},
                    {mesh.materials().begin(), mesh.materials().end()},
                    mesh.report(),
                    mesh.two_sided()};
    for (std::size_t place = 0; place < mesh.size(); ++place) {
        lists.corners.push_back(mesh.corners(place));
        lists.numbers.push_back(mesh.number(place));
    }
    describe(a, lists);
}
void read_mesh(ReadArchive& a, Mesh& mesh, std::uint64_t hash) {
    std::uint64_t size = 0;
    a.number(size);
    if (a.failed || size > a.bytes.size() - a.at) {
        a.failed = true;
        return;
    }
    if (a.known != nullptr)
        for (const SharedShape& shared : a.known->shapes)
            if (const auto* same = std::get_if<Mesh>(&shared.shape);
                same != nullptr && same->data->content_hash() == hash)
                mesh.data = same->data;
    if (mesh.data != nullptr) {
        a.at += size;
        return;
    }
    const std::size_t end = a.at + size;
    MeshLists lists;
    describe(a, lists);
    a.failed = a.failed || a.at != end;
    if (a.failed) return;
    auto built = detail::assemble_mesh(std::move(lists.vertices), std::move(lists.corners), std::move(lists.numbers),
                                       std::move(lists.materials), lists.report, lists.two_sided);
    a.failed = !built || (*built)->content_hash() != hash;
    if (!a.failed) mesh.data = *std::move(built);
}

template <class A, SizedShape S> void describe(A& a, S& shape) {
    for (const ShapeSize<S>& size : S::sizes) a.number(size.in(shape));
}
/// A mesh is hashed by its content's hash. It is saved as its lists, after their hash and size: a world that has the
/// mesh already skips them.
template <class A> void describe(A& a, Mesh& mesh) {
    describe(a, mesh.scale);
    std::uint64_t hash = mesh.data ? mesh.data->content_hash() : 0;
    a.number(hash);
    if constexpr (A::reads) {
        read_mesh(a, mesh, hash);
    } else if constexpr (A::saves) {
        SizeArchive measure;
        describe_data(measure, *mesh.data);
        std::uint64_t size = measure.size;
        a.number(size);
        describe_data(a, *mesh.data);
    }
}

template <class A> void describe(A& a, ConvexHull& s) { all(a, s.vertices, s.faces, s.face_vertices, s.edges); }

template <class A> void describe(A& a, SharedShape& s) {
    std::uint32_t kind = static_cast<std::uint32_t>(s.shape.index());
    all(a, kind, s.users, s.outer_radius, s.inner_radius, s.key);
    if constexpr (A::reads) {
        std::uint32_t i = 0;
        bool known = false;
        for_each_shape([&]<class S>() {
            if (i++ != kind) return;
            s.shape = S{};
            known = true;
        });
        if (!known) a.failed = true;
    }
    std::visit([&](auto& shape) { describe(a, shape); }, s.shape);
}

template <class A, class T> void describe(A& a, std::vector<T>& v) {
    a.resize(v);
    for (T& value : v) describe(a, value);
}
template <class A, class... T> void all(A& a, T&... values) { (describe(a, values), ...); }

/// Generations are saved, but not hashed: a world that went back to a snapshot has issued more ids than one that did
/// not, and is equal otherwise.
template <class A, class Tag> void describe(A& a, IdPool<Tag>& pool) {
    std::vector<std::uint8_t> alive;
    std::vector<std::uint32_t> free = pool.free_list();
    for (const auto& slot : pool.slots()) alive.push_back(slot.alive ? 1 : 0);
    all(a, alive, free);
    if constexpr (A::saves) {
        std::vector<std::uint16_t> generations, newest = pool.newest();
        for (const auto& slot : pool.slots()) generations.push_back(slot.generation);
        std::uint16_t owner = pool.owner();
        all(a, generations, newest, owner);
        if constexpr (A::reads) {
            a.failed = a.failed || generations.size() != alive.size();
            if (a.failed) return;
            std::vector<typename IdPool<Tag>::Slot> slots;
            slots.reserve(alive.size());
            for (std::size_t i = 0; i < alive.size(); ++i) slots.push_back({generations[i], alive[i] != 0});
            pool = IdPool<Tag>(owner);
            a.failed = !pool.restore(std::move(slots), std::move(free), std::move(newest));
        }
    }
}

/// The manifolds of each contact, wherever they lie in the pool; the first place of a contact that exists has friction
/// and restitution even without points.
template <class A> void describe_manifolds(A& a, WorldState& s) {
    for (Contact& c : s.contacts.all) {
        if (c.body_a == c.body_b) continue;  // free
        const std::size_t count = std::max<std::size_t>({c.manifolds, c.coloured, 1});
        if constexpr (A::reads) {
            if (a.failed || count > dynamics::ManifoldPool::max_per_contact) {
                a.failed = true;
                return;
            }
            s.contacts.manifolds.reserve(c, count);
        }
        for (std::size_t i = 0; i < count; ++i) describe(a, s.contacts.manifolds.places(c)[i]);
    }
}

/// The one list of all state of a world that is hashed and saved.
template <class A> void describe(A& a, WorldState& s) {
    all(a, s.settings, s.clock.steps, s.clock.time, s.clock.last_sub_step, s.bodies.ids, s.bodies.traits,
        s.bodies.motion, s.bodies.forces, s.colliders.ids, s.colliders.all, s.broad_phase.boxes, s.broad_phase.changes,
        s.colliders.shapes, s.colliders.free_shapes, s.bodies.awake, s.bodies.awake_added, s.bodies.asleep.bodies,
        s.contacts.active.pairs, s.contacts.active.values, s.contacts.resting.pairs, s.contacts.resting.values,
        s.contacts.all, s.contacts.free, s.broad_phase.edited_colliders, s.bodies.to_wake, s.bodies.let_go,
        s.contacts.to_check, s.contacts.open_hits, s.broad_phase.removed_any, s.broad_phase.query_all_awake);
    describe_manifolds(a, s);
    if constexpr (A::saves) describe(a, s.contacts.removed);  // read by events alone
    std::vector<broad::Pair> excluded(s.bodies.exclusions.pairs().begin(), s.bodies.exclusions.pairs().end());
    describe(a, excluded);
    if constexpr (A::reads) {
        s.bodies.exclusions.clear();
        for (std::size_t i = 0; i < excluded.size(); ++i)
            if (!(excluded[i].a < excluded[i].b) || (i != 0 && !(excluded[i - 1] < excluded[i]))) a.failed = true;
        if (a.failed) return;  // unsorted pairs would take quadratic time
        for (const broad::Pair pair : excluded) s.bodies.exclusions.add(pair.a, pair.b);
    }
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
    if (state_->broken) return {};
    try {
        SizeArchive measure;
        describe(measure, *state_);
        std::vector<std::byte> bytes(head_size + measure.size);
        WriteArchive payload{bytes.data() + head_size};
        describe(payload, *state_);
        WriteArchive head{bytes.data()};
        for (char letter : snapshot_magic) head.number(letter);
        std::uint32_t version = snapshot_version;
        std::uint64_t size = measure.size, sum = checksum(std::span(bytes).subspan(head_size));
        head.number(version);
        head.number(size);
        head.number(sum);
        return bytes;
    } catch (const std::bad_alloc&) {
        return {};
    }
}

namespace {

/// Checks the head of a snapshot and returns the bytes of its state.
Result<std::span<const std::byte>> payload_of(std::span<const std::byte> snapshot) {
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
    const std::span<const std::byte> payload = snapshot.subspan(head_size);
    if (payload.size() != size)
        return not_a_snapshot(12, std::to_string(payload.size()) + " bytes of state", std::to_string(size));
    if (checksum(payload) != sum) return not_a_snapshot(20, "a wrong checksum", "unchanged bytes");
    return payload;
}

/// Builds what a snapshot does not hold: sets of boxes, links of contacts and sleepers, keys of shapes, memory for
/// edits.
void complete(WorldState& next) {
    next.broad_phase.sets = make_box_sets(next.broad_phase.structure);
    next.broad_phase.set_of.assign(next.colliders.all.size(), 0);
    for (std::uint32_t c = 0; c < next.colliders.ids.size(); ++c) {
        if (!next.colliders.ids.alive_at(c)) continue;
        const broad::Move move{c, next.broad_phase.boxes[c]};
        const MotionState motion_state = next.bodies.traits[next.colliders[c].body].motion_state;
        next.broad_phase.sets.of(motion_state).insert(std::span(&move, 1));
        next.broad_phase.set_of[c] = static_cast<std::uint8_t>(1 + static_cast<std::uint8_t>(motion_state));
    }
    next.broad_phase.sets.commit_as_they_are();
    rebuild_contact_graph(next.contacts);
    next.bodies.awake.reserve(next.bodies.traits.size());
    next.bodies.awake_added.reserve(next.bodies.traits.size());
    next.bodies.asleep.reserve(next.bodies.traits.size());
    next.bodies.asleep.relink(next.bodies.motion);
    next.broad_phase.edited_colliders.reserve(next.colliders.all.size());
    next.colliders.free_shapes.reserve(next.colliders.shapes.size());
    measure_asleep_overhang(next.bodies, next.colliders, next.broad_phase, next.query, next.bodies.asleep.bodies);
    for (std::uint32_t i = 0; i < next.colliders.shapes.size(); ++i) {
        const SharedShape& shared = next.colliders.shapes[i];
        if (shared.users == 0) continue;
        next.colliders.shape_of_key.emplace(shared.key, i);
        next.colliders.meshes += is_mesh(shared.shape) ? 1 : 0;
    }
}

/// Has the restored state issue no id that this world issued before under the same number, and remembers those that it
/// issued under other numbers.
void continue_ids(WorldState& next, const WorldState& before) {
    next.issued = before.issued;
    const std::uint16_t number = next.bodies.ids.owner();
    next.issued.push_back({before.bodies.ids.owner(), before.bodies.ids.newest(), before.colliders.ids.newest()});
    for (const IssuedIds& issued : next.issued) {
        if (issued.number != number) continue;
        next.bodies.ids.continue_after(issued.bodies);
        next.colliders.ids.continue_after(issued.colliders);
    }
    std::erase_if(next.issued, [&](const IssuedIds& issued) { return issued.number == number; });
}

}  // namespace

Result<IdMap> World::restore(std::span<const std::byte> snapshot) {
    try {
        const auto payload = payload_of(snapshot);
        if (!payload) return payload.error();
        auto next = std::make_unique<WorldState>();
        ReadArchive archive{*payload, &state_->colliders};
        describe(archive, *next);
        const std::string_view wrong =
            archive.failed || archive.at != payload->size() ? "an incomplete state" : wrong_part(*next);
        if (!wrong.empty()) return not_a_snapshot(head_size + archive.at, std::string(wrong), "a consistent state");
        if (!rebuild_colours(next->bodies, next->contacts))
            return not_a_snapshot(head_size + archive.at, "contradictory colours", "a consistent state");
        IdMap map;
        map.owner_ = next->bodies.ids.owner();
        continue_ids(*next, *state_);
        next->broad_phase.structure = state_->broad_phase.structure;
        next->solver.reference = state_->solver.reference;
        complete(*next);
        next->own_tasks = std::move(state_->own_tasks);
        next->tasks = state_->tasks;
        state_ = std::move(next);
        return map;
    } catch (const std::bad_alloc&) {
        return out_of_memory("World::restore");
    } catch (const std::length_error&) {
        return out_of_memory("World::restore");
    }
}

}  // namespace fase
