/// The suite `determinism`: the same calls give the same bits.
#include <fmt/format.h>

#include <utility>

#include "bench/checks/check_world.hpp"
#include "bench/checks/lives.hpp"
#include "bench/checks/random_scenes.hpp"
#include "fase/broad/any_structure.hpp"
#include "fase/broad/registry.hpp"
#include "fase/scene/generate.hpp"

namespace fase::checks {
namespace {

/// A scene that is played several times. Edits follow from the step and the state alone.
struct Play {
    std::string name;
    int steps = 300, quick_steps = 150;
    void (*build)(CheckWorld& world) = nullptr;
    void (*edit)(CheckWorld& world, int step) = nullptr;
};

void build_generated(CheckWorld& world, const char* kind, std::size_t count) {
    const Context& context = world.context();
    const Result<scene::Scene> scene =
        scene::generate(kind, {.count = context.quick ? count / 8 : count, .seed = context.seed});
    if (world.succeeds(scene)) world.succeeds(scene::instantiate(*scene, *world));
}

void build_castle(CheckWorld& world) { build_generated(world, "castle", 3000); }
void build_hulls(CheckWorld& world) { build_generated(world, "hull_pile", 800); }

void build_boxes(CheckWorld& world) {
    world.add_ground();
    Random random(world.context().seed, 7);
    const int boxes = world.context().quick ? 100 : 800, side = 5;
    for (int i = 0; i < boxes; ++i) {
        const auto size = [&] { return random.between(0.2f, 0.45f); };
        const Vec3 half{size(), size(), size()};
        const int cell = i % (side * side);
        world.add({.position = {cell % side * 1.0, 1.0 + i / (side * side), cell / side * 1.0},
                   .rotation = random_rotation(random)},
                  Box{half});
    }
}

void build_mixed(CheckWorld& world) {
    world.add_ground();
    Random random(world.context().seed, 8);
    const int bodies = world.context().quick ? 80 : 500, side = 6;
    for (int i = 0; i < bodies; ++i) {
        const int cell = i % (side * side);
        BodyDef def{.position = {cell % side * 1.1, 1 + i / (side * side) * 1.1, cell / side * 1.1}};
        def.rotation = random_rotation(random);
        world.add(def, random_shape(random, 0.4f), {.material = {.restitution = random.below(4) == 0 ? 0.5f : 0.0f}});
    }
}

/// Every 20 steps: a body comes, one goes, one is struck, one is moved, one changes its kind.
void edit_mixed(CheckWorld& world, int step) {
    if (step % 20 != 10) return;
    Random random(world.context().seed, 2000 + static_cast<std::uint64_t>(step));
    const auto any = [&] {
        const std::vector<BodyId> bodies = world->bodies();
        return bodies[1 + random.below(bodies.size() - 1)];  // the ground stays
    };
    const auto place = [&] {
        const double x = double(random.between(0, 6)), y = double(random.between(1, 8));
        return Vec3d{x, y, double(random.between(0, 6))};
    };
    const Vec3d at = place();
    world.add({.position = at, .rotation = random_rotation(random)}, random_shape(random, 0.4f),
              {.sensor = random.below(5) == 0});
    world.succeeds(world->remove_body(any()));
    // Refused for a static body, which changes nothing.
    (void)world->set_velocity(any(), {random.between(-4, 4), 4, random.between(-4, 4)}, {1, 2, 3});
    world.succeeds(world->set_pose(any(), {place(), random_rotation(random)}));
    world.succeeds(world->set_kind(any(), static_cast<BodyKind>(random.below(3))));
}

const std::vector<Play>& plays() {
    static const std::vector<Play> all{
        {.name = "castle", .build = build_castle},
        {.name = "boxes", .build = build_boxes},
        {.name = "hulls", .build = build_hulls},
        {.name = "mixed_with_edits", .steps = 600, .build = build_mixed, .edit = edit_mixed}};
    return all;
}

/// The hashes of a play after every tenth step, and snapshots after some of them.
struct Played {
    std::vector<std::uint64_t> hashes;
    std::vector<std::pair<int, std::vector<std::byte>>> saved;  ///< with the step they were taken before
};

constexpr int hash_interval = 10;

/// Plays from step `first` to the end. Saves before `saves` random steps.
Played play_on(CheckWorld& world, const Play& play, int first, int saves) {
    const Context& context = world.context();
    const int steps = context.quick ? play.quick_steps : play.steps;
    Random random(context.seed, 9);
    std::vector<int> save_at;
    for (int i = 0; i < saves; ++i)
        save_at.push_back(hash_interval *
                          static_cast<int>(random.below(static_cast<std::uint64_t>(steps / hash_interval))));
    Played played;
    for (int i = first; i < steps; ++i) {
        for (const int at : save_at)
            if (at == i) played.saved.emplace_back(i, world->snapshot());
        if (play.edit != nullptr) play.edit(world, i);
        if (!world.step()) return played;
        if ((i + 1) % hash_interval == 0) played.hashes.push_back(world->hash());
    }
    return played;
}

Played play_in(Context& context, const Play& play, const Setup& setup, int saves = 0) {
    CheckWorld world(context, {}, setup);
    play.build(world);
    return play_on(world, play, 0, saves);
}

/// Counts a play whose hashes differ from the reference from step `first` on; the first one is noted.
class Comparison {
public:
    Comparison(Context& context, const std::vector<std::uint64_t>& reference)
        : context_(context), reference_(reference) {}
    double differs(const std::vector<std::uint64_t>& hashes, int first, const std::string& what) {
        const auto skipped = static_cast<std::size_t>(first / hash_interval);
        for (std::size_t i = skipped; i < reference_.size(); ++i) {
            if (i - skipped < hashes.size() && hashes[i - skipped] == reference_[i]) continue;
            if (context_.note.empty())
                context_.note = fmt::format("{}: the hash differs after step {}", what, (i + 1) * hash_interval);
            return 1;
        }
        return 0;
    }

private:
    Context& context_;
    const std::vector<std::uint64_t>& reference_;
};

Case same_bits(const Play& play, bool slow) {
    return {play.name,
            {exactly("differ_by_threads", 0), exactly("differ_by_structure", 0), exactly("differ_when_rebuilt", 0),
             exactly("differ_when_restored", 0), at_least("distinct_hashes", "", 2, 2)},
            slow,
            [play](Context& context) -> std::vector<double> {
                const Played reference = play_in(context, play, {.threads = 1}, context.quick ? 2 : 5);
                Comparison comparison(context, reference.hashes);
                double threads = 0, structures = 0, restored = 0, distinct = 1;
                for (const int count : {2, 4})
                    threads += comparison.differs(play_in(context, play, {.threads = count}).hashes, 0,
                                                  fmt::format("{} threads", count));
                broad::for_each_structure([&]<broad::Structure S>() {
                    const std::string name(broad::StructureInfo(S::info).name);
                    structures += comparison.differs(play_in(context, play, {.structure = name}).hashes, 0, name);
                });
                const double rebuilt =
                    comparison.differs(play_in(context, play, {.threads = context.threads}).hashes, 0, "rebuilt");
                for (const auto& [step, bytes] : reference.saved) {
                    CheckWorld fresh(context, {}, {.structure = "brute_force", .threads = 2});
                    if (!fresh.succeeds(fresh->restore(bytes))) return {};
                    restored += comparison.differs(play_on(fresh, play, step, 0).hashes, step,
                                                   fmt::format("restored before step {}", step + 1));
                    // The same world, played to its end, is taken back.
                    if (!fresh.succeeds(fresh->restore(bytes))) return {};
                    restored += comparison.differs(play_on(fresh, play, step, 0).hashes, step,
                                                   fmt::format("taken back to step {}", step + 1));
                }
                for (std::size_t i = 1; i < reference.hashes.size(); ++i)
                    if (reference.hashes[i] != reference.hashes[i - 1]) ++distinct;
                return {threads, structures, rebuilt, restored, distinct};
            }};
}

Case random_lives() {
    return {
        "random_lives", {exactly("lives_with_a_difference", 0)}, false, [](Context& context) -> std::vector<double> {
            double differing = 0;
            for (int run = 0; run < context.runs; ++run) {
                const Life life = random_life(context.seed, run);
                if (difference_in(life, context).empty()) continue;
                ++differing;
                if (!context.note.empty()) continue;
                const Life shorter =
                    shrunk(life, [&](const Life& some) { return !difference_in(some, context).empty(); });
                context.note = fmt::format("life {} of seed {}, with fewer calls: {}{}", run, context.seed,
                                           difference_in(shorter, context), described(shorter));
            }
            return {differing};
        }};
}

std::vector<Case> determinism_cases() {
    std::vector<Case> all;
    for (const Play& play : plays()) all.push_back(same_bits(play, play.name == "castle"));
    all.push_back(random_lives());
    return all;
}

}  // namespace

extern const Suite determinism;
const Suite determinism{"determinism",
                        "The same calls give the same bits: any threads, any structure, restored, rebuilt.",
                        determinism_cases};

}  // namespace fase::checks
