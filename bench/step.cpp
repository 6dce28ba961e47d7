/// The benchmark behind `fase bench step`: alternating turns of the engines, rounds, and the end state.
#include "bench/step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "bench/engine.hpp"
#include "bench/split_list.hpp"
#include "fase/scene/generate.hpp"

namespace fase::bench {
namespace {

/// Steps per turn of an engine: few, so that noise affects all engines alike; several, so that an engine's own data is
/// in the caches most of the time.
constexpr std::uint64_t steps_per_turn = 10;

constexpr StepScene all_scenes[]{
    {"large_pyramid", 200}, {"many_pyramids", 200}, {"hull_pile", 300}, {"washer", 300}, {"hills", 300}};

/// Returns the error for an unknown name. `special`: a name that is valid but not in the list, or "".
template <class List>
Error unknown_name(const char* option, const std::string& found, const List& list, const char* special) {
    std::string names = special;
    for (const auto& one : list) names += (names.empty() ? "" : ", ") + std::string(one.name);
    return {Status::BadArgument, option, fmt::format("found \"{}\"; expected one of {}", found, names), {}};
}

/// Returns the engines for "all" or a list like "fase,bullet", in the order of THE list.
Result<std::vector<const EngineInfo*>> engines_named(const std::string& names) {
    std::vector<bool> selected(engines().size(), names == "all");
    for (const std::string& name : names == "all" ? std::vector<std::string>() : split_list(names)) {
        const auto engine =
            std::find_if(engines().begin(), engines().end(), [&](const EngineInfo& one) { return one.name == name; });
        if (engine == engines().end()) return unknown_name("--engine", name, engines(), "all");
        selected[static_cast<std::size_t>(engine - engines().begin())] = true;
    }
    std::vector<const EngineInfo*> chosen;
    for (std::size_t i = 0; i < selected.size(); ++i) {
        if (selected[i]) chosen.push_back(&engines()[i]);
    }
    return chosen;
}

/// One engine on one scene.
struct Contender {
    const EngineInfo* info = nullptr;
    std::unique_ptr<Engine> engine;
    std::vector<std::vector<double>> ms;  ///< by round and step
    StepRow row;
};

/// Progress of the run over all scenes.
struct Run {
    const StepOptions& options;
    const StepProgress& progress;
    std::uint64_t done = 0, total = 0;
    bool stopped = false;
};

Result<void> run_turn(Run& run, Contender& contender, std::uint64_t steps) {
    for (std::uint64_t i = 0; i < steps; ++i) {
        if (!run.progress(run.done++, run.total, contender.row.scene, contender.row.engine)) {
            run.stopped = true;
            return {};
        }
        const double begin = wall_ms();
        if (auto stepped = contender.engine->step(); !stepped) return stepped.error();
        contender.ms.back().push_back(wall_ms() - begin);
    }
    return {};
}

/// Records the state of an engine at the end of a round.
void record_end(Contender& contender, const std::vector<Vec3d>& start, int round) {
    StepRow& row = contender.row;
    std::vector<Vec3d> centres;
    contender.engine->read_centres(centres);
    double top = centres.empty() ? 0 : centres.front().y, sum = 0, drift = 0;
    for (std::size_t i = 0; i < centres.size(); ++i) {
        top = std::max(top, centres[i].y);
        sum += centres[i].y;
        drift += length(centres[i] - start[i]);
    }
    const double count = static_cast<double>(std::max<std::size_t>(centres.size(), 1));
    const std::optional<std::uint64_t> hash = contender.engine->hash();
    if (round > 0 && (hash != row.hash || top != row.top_height || sum / count != row.mean_height)) row.repeats = false;
    row.hash = hash;
    row.top_height = top;
    row.mean_height = sum / count;
    row.drift = drift / count;
    row.bodies = centres.size();
    row.contacts = contender.engine->contacts();
    row.threads = contender.engine->threads();
    row.settings = contender.engine->settings();
}

/// Computes the row's times from those of all rounds.
void summarise(Contender& contender) {
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
        double fastest = contender.ms.front()[i];
        for (const std::vector<double>& round : contender.ms) fastest = std::min(fastest, round[i]);
        row.min_ms += fastest / static_cast<double>(contender.ms.front().size());
    }
}

Result<void> run_round(Run& run, const scene::Scene& scene, const EngineOptions& engine_options,
                       std::vector<Contender>& contenders, std::uint64_t steps, int round) {
    std::vector<std::vector<Vec3d>> starts(contenders.size());
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        Result<std::unique_ptr<Engine>> made = contenders[i].info->make(scene, engine_options);
        if (!made) return made.error();
        contenders[i].engine = *std::move(made);
        contenders[i].ms.emplace_back();
        contenders[i].engine->read_centres(starts[i]);
    }
    for (std::uint64_t step = 0; step < steps; step += steps_per_turn) {
        for (Contender& contender : contenders) {
            const std::uint64_t turn = std::min(steps_per_turn, steps - step);
            if (auto done = run_turn(run, contender, turn); !done) return done.error();
            if (run.stopped) return {};
        }
    }
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        record_end(contenders[i], starts[i], round);
        contenders[i].engine.reset();
    }
    return {};
}

Result<std::vector<StepRow>> run_scene(Run& run, const StepScene& kind, std::vector<Contender> contenders) {
    const StepOptions& options = run.options;
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
    for (int round = 0; round < options.rounds && !run.stopped; ++round) {
        if (auto done = run_round(run, *scene, engine_options, contenders, steps, round); !done) return done.error();
    }
    std::vector<StepRow> rows;
    if (run.stopped) return rows;
    for (Contender& contender : contenders) {
        summarise(contender);
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
    Run run{options, progress};
    std::vector<StepScene> scenes;
    for (const StepScene& scene : step_scenes()) {
        if (!options.scene.empty() && options.scene != scene.name) continue;
        scenes.push_back(scene);
        run.total += options.steps.value_or(scene.steps) * chosen.size() * static_cast<std::uint64_t>(options.rounds);
    }
    if (scenes.empty()) return unknown_name("--scene", options.scene, step_scenes(), "");

    std::vector<StepRow> rows;
    for (const StepScene& scene : scenes) {
        std::vector<Contender> contenders(chosen.size());
        for (std::size_t i = 0; i < chosen.size(); ++i) contenders[i].info = chosen[i];
        Result<std::vector<StepRow>> measured = run_scene(run, scene, std::move(contenders));
        if (!measured) return measured.error();
        for (StepRow& row : *measured) rows.push_back(std::move(row));
        if (run.stopped) break;
    }
    return rows;
}

}  // namespace fase::bench
