/// Events made by rule, and the frames around them.
#include "bench/sudden.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "fase/broad/search/pair_hash.hpp"
#include "fase/broad/search/plain_sweep.hpp"
#include "fase/core/random.hpp"
#include "fase/pairs/pair_finder.hpp"

namespace fase::bench {
namespace {

/// Boxes of about a metre, two cubic metres for each; the first few move.
struct Stage {
    std::vector<Aabb> boxes;
    std::vector<MotionState> motion_states;
    std::vector<Vec3> velocities;  // of those that move
    float side = 0;
    Random random{7};

    Aabb any_box() {
        const Vec3 lo{random.between(0, side), random.between(0, side), random.between(0, side)};
        return {lo, lo + Vec3{random.between(0.6f, 1.2f), random.between(0.6f, 1.2f), random.between(0.6f, 1.2f)}};
    }
};

struct Event {
    std::string_view name, about;
    MotionState rest;  // of all but those that move
    void (*happen)(Stage& stage, std::uint64_t frame, std::uint64_t frames);
};

constexpr std::size_t movers = 2000;

void nothing(Stage&, std::uint64_t, std::uint64_t) {}

void wall_vanishes(Stage& stage, std::uint64_t frame, std::uint64_t frames) {
    if (frame != frames / 2) return;
    const float low = 0.495f * stage.side, high = 0.505f * stage.side;
    for (std::size_t i = movers; i < stage.boxes.size(); ++i)
        if (stage.boxes[i].lo.x >= low && stage.boxes[i].lo.x < high) stage.boxes[i] = {};
}

void one_comes(Stage& stage, std::uint64_t, std::uint64_t) {
    for (std::size_t i = movers; i < stage.boxes.size(); ++i) {
        if (!(stage.boxes[i] == Aabb{})) continue;
        stage.boxes[i] = stage.any_box();
        return;
    }
}

void rain(Stage& stage, std::uint64_t, std::uint64_t) {
    constexpr std::size_t many = 1000;
    std::size_t come = 0;
    for (std::size_t i = movers; i < stage.boxes.size() && come < many; ++i)
        if (stage.boxes[i] == Aabb{}) {
            stage.boxes[i] = stage.any_box();
            ++come;
        }
    for (std::size_t gone = 0; gone < many;) {
        Aabb& box = stage.boxes[movers + stage.random.below(stage.boxes.size() - movers)];
        gone += box == Aabb{} ? 0 : 1;
        box = {};
    }
}

void all_wake(Stage& stage, std::uint64_t frame, std::uint64_t frames) {
    if (frame < frames / 2) return;
    for (std::size_t i = movers; i < stage.boxes.size(); ++i) {
        stage.boxes[i].lo.y += 0.01f;
        stage.boxes[i].hi.y += 0.01f;
    }
}

void some_wake(Stage& stage, std::uint64_t frame, std::uint64_t) {
    constexpr std::size_t many = 500;
    for (std::size_t i = movers; i < movers + many * frame && i < stage.boxes.size(); ++i) {
        stage.boxes[i].lo.y += 0.01f;
        stage.boxes[i].hi.y += 0.01f;
    }
}

constexpr std::array events{
    Event{"nothing", "2,000 boxes move among those that stand", MotionState::Static, nothing},
    Event{"wall", "a wall, one box in a hundred, vanishes in one frame", MotionState::Static, wall_vanishes},
    Event{"comes", "one box more in each frame", MotionState::Static, one_comes},
    Event{"rain", "1,000 boxes come and 1,000 go in each frame", MotionState::Static, rain},
    Event{"wake", "all sleep, then all wake in one frame and move from then on", MotionState::Asleep, all_wake},
    Event{"rouse", "500 of those that sleep wake in each frame", MotionState::Asleep, some_wake}};

Stage begin(const Event& event, std::size_t count) {
    Stage stage;
    stage.side = static_cast<float>(std::cbrt(2.0 * static_cast<double>(count)));
    for (std::size_t i = 0; i < count; ++i) {
        stage.boxes.push_back(stage.any_box());
        stage.motion_states.push_back(i < movers ? MotionState::Awake : event.rest);
    }
    for (std::size_t i = 0; i < movers; ++i)
        stage.velocities.push_back(
            {stage.random.between(-5, 5), stage.random.between(-5, 5), stage.random.between(-5, 5)});
    // Room for those that come.
    const std::size_t spare = event.happen == rain ? 1000 : event.happen == one_comes ? 1000 : 0;
    for (std::size_t i = 0; i < spare; ++i) {
        stage.boxes.push_back({});
        stage.motion_states.push_back(event.rest);
    }
    return stage;
}

void move_about(Stage& stage) {
    for (std::size_t i = 0; i < movers; ++i) {
        const Vec3 way = stage.velocities[i] * (1.0f / 60);
        stage.boxes[i] = {stage.boxes[i].lo + way, stage.boxes[i].hi + way};
        for (int axis = 0; axis < 3; ++axis)
            if (stage.boxes[i].lo[axis] < 0 || stage.boxes[i].lo[axis] > stage.side)
                stage.velocities[i][axis] = -stage.velocities[i][axis];
    }
}

broad::PairSetFingerprint judged(const Stage& stage) {
    std::vector<broad::Move> moves;
    for (std::size_t i = 0; i < stage.boxes.size(); ++i)
        if (!(stage.boxes[i] == Aabb{})) moves.push_back({static_cast<broad::Proxy>(i), stage.boxes[i]});
    std::vector<broad::Pair> pairs;
    broad::find_pairs_by_sweep(moves, pairs, [&](broad::Proxy p, broad::Proxy q) {
        return stage.motion_states[p] != MotionState::Static || stage.motion_states[q] != MotionState::Static;
    });
    return broad::print_of(pairs);
}

/// False when stopped.
bool measure(const SuddenOptions& options, const Event& event, SuddenRow& row, const SuddenProgress& progress) {
    Stage stage = begin(event, options.boxes);
    const auto tasks = make_serial_runner();
    pairs::PairFinder finder = row.structure == "auto" ? pairs::PairFinder::automatic()
                                                       : pairs::PairFinder(*broad::AnyStructure::named(row.structure));
    const double build_begin = ms_worked();
    finder.build(*tasks, stage.boxes, stage.motion_states);
    row.build_ms = ms_worked() - build_begin;
    std::vector<broad::Pair> pairs;
    std::vector<double> times;
    std::vector<std::pair<Stage, broad::PairSetFingerprint>> looked_at;  // judged at the end, to leave the caches alone
    const std::string what = fmt::format("{} {}", event.name, row.structure);
    for (std::uint64_t frame = 0; frame < options.frames + 5; ++frame) {
        if (!progress(frame, options.frames + 5, what)) return false;
        move_about(stage);
        const bool warm = frame >= 5;  // memory is at hand, and the sets are as they stay
        if (warm) event.happen(stage, frame - 5, options.frames);
        pairs.clear();
        const double begin_of_frame = ms_worked();
        finder.update(*tasks, stage.boxes);
        finder.find_pairs(*tasks, pairs);
        const double ms = ms_worked() - begin_of_frame;
        if (!warm) continue;
        if (times.empty() || ms > row.ms.worst) {
            row.worst_frame = frame - 5;
            row.ms.worst = ms;
        }
        times.push_back(ms);
        const std::uint64_t at = frame - 5;
        if (at == options.frames / 2 || at + 1 == options.frames) looked_at.emplace_back(stage, broad::print_of(pairs));
    }
    for (const auto& [then, print] : looked_at) row.right = row.right && print == judged(then);
    row.ms = timing_of(times);
    row.frames = times.size();
    row.pairs = pairs.size();
    return true;
}

}  // namespace

Result<std::vector<SuddenRow>> measure_sudden(const SuddenOptions& options, const SuddenProgress& progress) {
    if (options.boxes < 2 * movers)
        return Error{Status::BadArgument, "--count",
                     fmt::format("found {}, need at least {}", options.boxes, 2 * movers), ""};
    std::vector<std::string> names;
    for (std::size_t begin = 0; begin <= options.structures.size();) {
        const std::size_t end = std::min(options.structures.find(',', begin), options.structures.size());
        names.push_back(options.structures.substr(begin, end - begin));
        begin = end + 1;
        if (names.back() == "auto") continue;
        if (const auto known = broad::AnyStructure::named(names.back()); !known) {
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
