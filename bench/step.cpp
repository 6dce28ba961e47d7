/// What `fase bench step` measures: whole steps of the same scenes, in Fase and in its peers.
#include "bench/step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "bench/engine.hpp"
#include "fase/scene/generate.hpp"

namespace fase::bench {
namespace {

/// Steps that an engine does before another has its turn: few, so that noise meets all; several, so that each works
/// with its own data in the caches most of the time.
constexpr std::uint64_t steps_a_turn = 10;

constexpr StepScene all_scenes[]{{"large_pyramid", 200}, {"many_pyramids", 200}, {"hull_pile", 300}, {"washer", 300}};

template <class List> Error unknown(const char* what, const std::string& found, const List& list, const char* also) {
    std::string names = also;
    for (const auto& one : list) names += (names.empty() ? "" : ", ") + std::string(one.name);
    return {Status::BadArgument, what, fmt::format("found \"{}\", need one of {}", found, names), {}};
}

/// The engines of "all" or of a list like "fase,bullet", in the order of THE list.
Result<std::vector<const EngineInfo*>> engines_named(const std::string& names) {
    std::vector<bool> wanted(engines().size(), names == "all");
    for (std::size_t begin = 0; names != "all" && begin <= names.size();) {
        const std::size_t end = std::min(names.find(',', begin), names.size());
        const std::string name = names.substr(begin, end - begin);
        const auto engine =
            std::find_if(engines().begin(), engines().end(), [&](const EngineInfo& one) { return one.name == name; });
        if (engine == engines().end()) return unknown("--engine", name, engines(), "all");
        wanted[static_cast<std::size_t>(engine - engines().begin())] = true;
        begin = end + 1;
    }
    std::vector<const EngineInfo*> chosen;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (wanted[i]) chosen.push_back(&engines()[i]);
    }
    return chosen;
}

/// One engine in the run of one scene.
struct Contender {
    const EngineInfo* info = nullptr;
    std::unique_ptr<Engine> engine;
    std::vector<std::vector<double>> ms;  ///< by round and step
    StepRow row;
};

/// Where the run of all scenes stands.
struct Course {
    const StepOptions& options;
    const StepProgress& progress;
    std::uint64_t done = 0, total = 0;
    bool stopped = false;
};

Result<void> take_turn(Course& course, Contender& contender, std::uint64_t steps) {
    using Clock = std::chrono::steady_clock;
    for (std::uint64_t i = 0; i < steps; ++i) {
        if (!course.progress(course.done++, course.total, contender.row.scene, contender.row.engine)) {
            course.stopped = true;
            return {};
        }
        const Clock::time_point begin = Clock::now();
        if (auto stepped = contender.engine->step(); !stepped) return stepped.error();
        contender.ms.back().push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
    }
    return {};
}

/// Writes down how a round ended.
void note_end(Contender& contender, const std::vector<Vec3d>& begin, int round) {
    StepRow& row = contender.row;
    std::vector<Vec3d> centres;
    contender.engine->read_centres(centres);
    double top = centres.empty() ? 0 : centres.front().y, sum = 0, way = 0;
    for (std::size_t i = 0; i < centres.size(); ++i) {
        top = std::max(top, centres[i].y);
        sum += centres[i].y;
        way += length(centres[i] - begin[i]);
    }
    const double count = static_cast<double>(std::max<std::size_t>(centres.size(), 1));
    const std::optional<std::uint64_t> hash = contender.engine->hash();
    if (round > 0 && (hash != row.hash || top != row.top_height || sum / count != row.mean_height)) row.repeats = false;
    row.hash = hash;
    row.top_height = top;
    row.mean_height = sum / count;
    row.drift = way / count;
    row.bodies = centres.size();
    row.contacts = contender.engine->contacts();
    row.threads = contender.engine->threads();
    row.settings = contender.engine->settings();
}

/// Boils the times of all rounds down to the row.
void sum_up(Contender& contender) {
    std::vector<double> means, medians, worsts;
    for (const std::vector<double>& round : contender.ms) {
        const Timing timing = timing_of(round);
        means.push_back(timing.mean);
        medians.push_back(timing.median);
        worsts.push_back(timing.worst);
    }
    StepRow& row = contender.row;
    row.ms = {median_of(means), median_of(medians), median_of(worsts)};
    const auto [low, high] = std::minmax_element(means.begin(), means.end());
    row.mean_low = *low;
    row.mean_high = *high;
    for (std::size_t i = 0; i < contender.ms.front().size(); ++i) {
        double least = contender.ms.front()[i];
        for (const std::vector<double>& round : contender.ms) least = std::min(least, round[i]);
        row.least += least / static_cast<double>(contender.ms.front().size());
    }
}

Result<void> run_round(Course& course, const scene::Scene& scene, const EngineOptions& engine_options,
                       std::vector<Contender>& contenders, std::uint64_t steps, int round) {
    std::vector<std::vector<Vec3d>> begins(contenders.size());
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        Result<std::unique_ptr<Engine>> made = contenders[i].info->make(scene, engine_options);
        if (!made) return made.error();
        contenders[i].engine = *std::move(made);
        contenders[i].ms.emplace_back();
        contenders[i].engine->read_centres(begins[i]);
    }
    for (std::uint64_t at = 0; at < steps; at += steps_a_turn) {
        for (Contender& contender : contenders) {
            const std::uint64_t turn = std::min(steps_a_turn, steps - at);
            if (auto taken = take_turn(course, contender, turn); !taken) return taken.error();
            if (course.stopped) return {};
        }
    }
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        note_end(contenders[i], begins[i], round);
        contenders[i].engine.reset();
    }
    return {};
}

Result<std::vector<StepRow>> run_scene(Course& course, const StepScene& kind, std::vector<Contender> contenders) {
    const StepOptions& options = course.options;
    const Result<scene::Scene> scene = scene::generate(kind.name, {.count = options.count});
    if (!scene) return scene.error();
    EngineOptions engine_options{scene::settings_for(*scene), options.threads};
    engine_options.settings.sleep = false;
    const std::uint64_t steps = options.steps.value_or(kind.steps);
    for (Contender& contender : contenders) {
        contender.row.scene = kind.name;
        contender.row.engine = contender.info->name;
        contender.row.steps = steps;
        contender.row.rounds = options.rounds;
    }
    for (int round = 0; round < options.rounds && !course.stopped; ++round) {
        if (auto done = run_round(course, *scene, engine_options, contenders, steps, round); !done) return done.error();
    }
    std::vector<StepRow> rows;
    if (course.stopped) return rows;
    for (Contender& contender : contenders) {
        sum_up(contender);
        rows.push_back(std::move(contender.row));
    }
    return rows;
}

}  // namespace

std::span<const StepScene> step_scenes() { return all_scenes; }

Result<std::vector<StepRow>> measure_steps(const StepOptions& options, const StepProgress& progress) {
    const Result<std::vector<const EngineInfo*>> named = engines_named(options.engine);
    if (!named) return named.error();
    const std::vector<const EngineInfo*>& chosen = *named;
    Course course{options, progress};
    std::vector<StepScene> scenes;
    for (const StepScene& scene : step_scenes()) {
        if (!options.scene.empty() && options.scene != scene.name) continue;
        scenes.push_back(scene);
        course.total +=
            options.steps.value_or(scene.steps) * chosen.size() * static_cast<std::uint64_t>(options.rounds);
    }
    if (scenes.empty()) return unknown("--scene", options.scene, step_scenes(), "");

    std::vector<StepRow> rows;
    for (const StepScene& scene : scenes) {
        std::vector<Contender> contenders(chosen.size());
        for (std::size_t i = 0; i < chosen.size(); ++i) contenders[i].info = chosen[i];
        Result<std::vector<StepRow>> measured = run_scene(course, scene, std::move(contenders));
        if (!measured) return measured.error();
        for (StepRow& row : *measured) rows.push_back(std::move(row));
        if (course.stopped) break;
    }
    return rows;
}

}  // namespace fase::bench
