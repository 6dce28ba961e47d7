/// The events of `fase bench sudden` and the measurement of the frames around them.
#include "bench/sudden.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/split_list.hpp"
#include "fase/broad/search/pair_hash.hpp"
#include "fase/broad/search/plain_sweep.hpp"
#include "fase/core/random.hpp"
#include "fase/pairs/pair_finder.hpp"

namespace fase::bench {
namespace {

/// A cube of boxes about 1 m in size, one per 2 m³. The first `movers` boxes move; an empty box is absent.
struct BoxWorld {
    std::vector<Aabb> boxes;
    std::vector<MotionState> motion_states;
    std::vector<Vec3> velocities;  // of the movers
    float side = 0;
    Random random{7};

    Aabb random_box() {
        const Vec3 lo{random.between(0, side), random.between(0, side), random.between(0, side)};
        return {lo, lo + Vec3{random.between(0.6f, 1.2f), random.between(0.6f, 1.2f), random.between(0.6f, 1.2f)}};
    }
};

struct Event {
    std::string_view name, about;
    MotionState rest;  // of the boxes that do not move
    void (*apply)(BoxWorld& world, std::uint64_t frame, std::uint64_t frames);
};

constexpr std::size_t movers = 2000;

void no_event(BoxWorld&, std::uint64_t, std::uint64_t) {}

void remove_wall(BoxWorld& world, std::uint64_t frame, std::uint64_t frames) {
    if (frame != frames / 2) return;
    const float low = 0.495f * world.side, high = 0.505f * world.side;
    for (std::size_t i = movers; i < world.boxes.size(); ++i)
        if (world.boxes[i].lo.x >= low && world.boxes[i].lo.x < high) world.boxes[i] = {};
}

void add_box(BoxWorld& world, std::uint64_t, std::uint64_t) {
    for (std::size_t i = movers; i < world.boxes.size(); ++i) {
        if (!(world.boxes[i] == Aabb{})) continue;
        world.boxes[i] = world.random_box();
        return;
    }
}

void replace_boxes(BoxWorld& world, std::uint64_t, std::uint64_t) {
    constexpr std::size_t count = 1000;
    std::size_t added = 0;
    for (std::size_t i = movers; i < world.boxes.size() && added < count; ++i)
        if (world.boxes[i] == Aabb{}) {
            world.boxes[i] = world.random_box();
            ++added;
        }
    for (std::size_t removed = 0; removed < count;) {
        Aabb& box = world.boxes[movers + world.random.below(world.boxes.size() - movers)];
        removed += box == Aabb{} ? 0 : 1;
        box = {};
    }
}

void wake_all(BoxWorld& world, std::uint64_t frame, std::uint64_t frames) {
    if (frame < frames / 2) return;
    for (std::size_t i = movers; i < world.boxes.size(); ++i) {
        world.boxes[i].lo.y += 0.01f;
        world.boxes[i].hi.y += 0.01f;
    }
}

void wake_some(BoxWorld& world, std::uint64_t frame, std::uint64_t) {
    constexpr std::size_t count = 500;
    for (std::size_t i = movers; i < movers + count * frame && i < world.boxes.size(); ++i) {
        world.boxes[i].lo.y += 0.01f;
        world.boxes[i].hi.y += 0.01f;
    }
}

constexpr std::array events{
    Event{"nothing", "2,000 boxes move among static ones", MotionState::Static, no_event},
    Event{"wall", "a wall, one box in a hundred, disappears in one frame", MotionState::Static, remove_wall},
    Event{"comes", "one box is added in each frame", MotionState::Static, add_box},
    Event{"rain", "1,000 boxes are added and 1,000 removed in each frame", MotionState::Static, replace_boxes},
    Event{"wake", "all sleep, then all wake in one frame and move from then on", MotionState::Asleep, wake_all},
    Event{"rouse", "500 sleeping boxes wake in each frame", MotionState::Asleep, wake_some}};

BoxWorld make_world(const Event& event, std::size_t count) {
    BoxWorld world;
    world.side = static_cast<float>(std::cbrt(2.0 * static_cast<double>(count)));
    for (std::size_t i = 0; i < count; ++i) {
        world.boxes.push_back(world.random_box());
        world.motion_states.push_back(i < movers ? MotionState::Awake : event.rest);
    }
    for (std::size_t i = 0; i < movers; ++i)
        world.velocities.push_back(
            {world.random.between(-5, 5), world.random.between(-5, 5), world.random.between(-5, 5)});
    // Absent boxes, which the event adds.
    const std::size_t spare = event.apply == replace_boxes ? 1000 : event.apply == add_box ? 1000 : 0;
    for (std::size_t i = 0; i < spare; ++i) {
        world.boxes.push_back({});
        world.motion_states.push_back(event.rest);
    }
    return world;
}

void move_boxes(BoxWorld& world) {
    for (std::size_t i = 0; i < movers; ++i) {
        const Vec3 motion = world.velocities[i] * (1.0f / 60);
        world.boxes[i] = {world.boxes[i].lo + motion, world.boxes[i].hi + motion};
        for (int axis = 0; axis < 3; ++axis)
            if (world.boxes[i].lo[axis] < 0 || world.boxes[i].lo[axis] > world.side)
                world.velocities[i][axis] = -world.velocities[i][axis];
    }
}

/// Returns the fingerprint of the pairs that a plain sweep finds.
broad::PairSetFingerprint reference_pairs(const BoxWorld& world) {
    std::vector<broad::Move> moves;
    for (std::size_t i = 0; i < world.boxes.size(); ++i)
        if (!(world.boxes[i] == Aabb{})) moves.push_back({static_cast<broad::Proxy>(i), world.boxes[i]});
    std::vector<broad::Pair> pairs;
    broad::find_pairs_by_sweep(moves, pairs, [&](broad::Proxy p, broad::Proxy q) {
        return world.motion_states[p] != MotionState::Static || world.motion_states[q] != MotionState::Static;
    });
    return broad::fingerprint_of(pairs);
}

/// Measures one structure on one event. Returns false when stopped.
bool measure(const SuddenOptions& options, const Event& event, SuddenRow& row, const SuddenProgress& progress) {
    BoxWorld world = make_world(event, options.boxes);
    const auto tasks = make_serial_runner();
    pairs::PairFinder finder = row.structure == "auto" ? pairs::PairFinder::automatic()
                                                       : pairs::PairFinder(*broad::AnyStructure::named(row.structure));
    const double build_begin = cpu_ms();
    finder.build(*tasks, world.boxes, world.motion_states);
    row.build_ms = cpu_ms() - build_begin;
    std::vector<broad::Pair> pairs;
    std::vector<double> times;
    std::vector<std::pair<BoxWorld, broad::PairSetFingerprint>> checks;  // after the timing, to keep the caches
    const std::string what = fmt::format("{} {}", event.name, row.structure);
    for (std::uint64_t frame = 0; frame < options.frames + 5; ++frame) {
        if (!progress(frame, options.frames + 5, what)) return false;
        move_boxes(world);
        const bool warm = frame >= 5;  // after 5 frames memory is allocated and the sets are settled
        if (warm) event.apply(world, frame - 5, options.frames);
        pairs.clear();
        const double frame_begin = cpu_ms();
        finder.update(*tasks, world.boxes);
        finder.find_pairs(*tasks, pairs);
        const double ms = cpu_ms() - frame_begin;
        if (!warm) continue;
        const std::uint64_t measured = frame - 5;
        if (times.empty() || ms > row.ms.worst) {
            row.worst_frame = measured;
            row.ms.worst = ms;
        }
        times.push_back(ms);
        if (measured == options.frames / 2 || measured + 1 == options.frames)
            checks.emplace_back(world, broad::fingerprint_of(pairs));
    }
    for (const auto& [then, fingerprint] : checks) row.correct = row.correct && fingerprint == reference_pairs(then);
    row.ms = timing_of(times);
    row.frames = times.size();
    row.pairs = pairs.size();
    return true;
}

}  // namespace

Result<std::vector<SuddenRow>> measure_sudden(const SuddenOptions& options, const SuddenProgress& progress) {
    if (options.boxes < 2 * movers)
        return Error{Status::BadArgument, "--count",
                     fmt::format("found {}; expected at least {}", options.boxes, 2 * movers), ""};
    const std::vector<std::string> names = split_list(options.structures);
    for (const std::string& name : names) {
        if (name == "auto") continue;
        if (const auto known = broad::AnyStructure::named(name); !known) {
            Error error = known.error();
            error.where = "--structure";
            return error;
        }
    }
    std::vector<SuddenRow> rows;
    for (const Event& event : events) {
        for (const std::string& name : names) {
            SuddenRow row;
            row.event = event.name;
            row.about = event.about;
            row.structure = name;
            row.boxes = options.boxes;
            if (!measure(options, event, row, progress)) return rows;
            rows.push_back(row);
        }
    }
    return rows;
}

}  // namespace fase::bench
