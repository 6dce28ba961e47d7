/// The command `fase run`: simulates a scene, prints a summary, and records the motion on request.
#include "cli/run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <thread>
#include <utility>

#include "cli/common/arguments.hpp"
#include "cli/common/command_registry.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/load_scene.hpp"
#include "cli/common/output.hpp"
#include "cli/common/progress.hpp"
#include "cli/common/structure_choice.hpp"
#include "cli/level/scene.hpp"
#include "cli/run_summary.hpp"
#include "cli/scene_look.hpp"
#include "cli/scene_physics.hpp"
#include "fase/broad/any_structure.hpp"
#include "fase/record/recorder.hpp"
#include "fase/record/world_trace.hpp"
#include "fase/world/world.hpp"

namespace fase::cli {
namespace {

constexpr double default_seconds = 10, max_seconds = 1e9;

Settings settings_of(const RunOptions& options, const scene::Scene& scene) {
    Settings settings = scene::settings_for(scene);
    if (options.time_step) settings.time_step = static_cast<float>(*options.time_step);
    if (options.sub_steps) settings.sub_steps = *options.sub_steps;
    if (options.keep_awake) settings.sleep = false;
    return settings;
}

Result<std::uint64_t> steps_of(const RunOptions& options, float time_step) {
    if (options.steps) return *options.steps;
    const double steps = std::round(options.seconds.value_or(default_seconds) / double(time_step));
    if (steps > double(max_steps)) {
        return Error{Status::BadArgument,
                     "--seconds",
                     fmt::format("found {:.0f} steps of {:.6g} s; expected at most {}", steps, time_step, max_steps),
                     {}};
    }
    return static_cast<std::uint64_t>(std::max(steps, 1.0));
}

/// A world filled from a scene, its output files and its summary.
struct Run {
    World world;
    std::vector<BodyId> bodies;
    std::optional<LevelScene> level;  ///< without its scene
    std::optional<record::Recorder> recorder;
    std::optional<record::WorldTrace> trace;
    RunSummary summary;

    /// Appends the current state of the world to all output files.
    Result<void> write_frame() {
        if (recorder) {
            if (auto added = recorder->add_frame(world); !added) return added;
        }
        if (trace) {
            if (auto added = trace->add_frame(world); !added) return added;
        }
        return {};
    }
};

/// Checks that the output files can be written.
Result<void> check_outputs(const RunOptions& options) {
    if (!options.record.empty())
        if (auto checked = check_output(options.record, {output::recording}, options.scene); !checked) return checked;
    if (!options.trace.empty())
        if (auto checked = check_output(options.trace, {output::trace}, options.scene); !checked) return checked;
    if (!options.trace.empty() && options.trace == options.record)
        return Error{Status::Io, options.trace, "found one file for --record and --trace; expected two", {}};
    return {};
}

/// Loads the scene of the options; for a WAD file, also fills `level`. Refuses options that the scene does not have.
Result<scene::Scene> load(const RunOptions& options, std::optional<LevelScene>& level) {
    const scene::GenerateOptions generate{options.count, options.seed.value_or(1)};
    if (!is_wad(options.scene)) {
        if (!options.map.empty())
            return Error{Status::BadArgument, "--map", "found a scene that is not a WAD; expected a WAD", {}};
        const bool is_generated = !file_exists(options.scene);
        if (!is_generated && (options.count > 0 || options.seed))
            return Error{Status::BadArgument,
                         options.count > 0 ? "--count" : "--seed",
                         "found a scene file; expected a kind of 'fase generate' or a WAD",
                         {}};
        return load_scene(options.scene, generate);
    }
    Result<LevelScene> loaded = load_level_scene(options.scene, options.map, generate);
    if (!loaded) return loaded.error();
    level = *std::move(loaded);
    return std::move(level->scene);
}

/// Checks what can be checked before the scene is read.
Result<void> check_options(const RunOptions& options) {
    if (options.structure != "auto") {
        if (auto structure = broad::AnyStructure::named(options.structure); !structure) {
            return Error{Status::BadArgument,
                         "--structure",
                         fmt::format("found \"{}\"; expected auto or one of {}", printable(options.structure, 60),
                                     broad::AnyStructure::names()),
                         {}};
        }
    }
    return check_outputs(options);
}

/// A scene, what was added to it, and the warnings about it.
struct LoadedScene {
    scene::Scene scene;
    std::optional<LevelScene> level;  ///< without its scene
    std::optional<scene::AutoColliders> made;
};

Result<LoadedScene> load_with_colliders(const RunOptions& options) {
    LoadedScene loaded;
    Result<scene::Scene> scene = load(options, loaded.level);
    if (!scene) return scene.error();
    loaded.scene = *std::move(scene);
    if (options.auto_colliders.empty()) return loaded;
    const auto made = add_auto_colliders(loaded.scene, {options.auto_colliders, options.static_nodes});
    if (!made) return made.error();
    loaded.made = *made;
    return loaded;
}

/// Describes the scene in the summary, warnings included.
void describe(const RunOptions& options, const LoadedScene& loaded, RunSummary& summary) {
    const scene::Scene& scene = loaded.scene;
    summary.scene = options.scene;
    summary.bodies = scene.bodies.size();
    summary.dynamic_bodies = scene::dynamic_bodies(scene);
    summary.shapes = scene.shapes.size();
    summary.joints = scene.joints.size();
    summary.warnings = physics_warnings(scene, loaded.made ? &*loaded.made : nullptr);
    summary.show_hash = options.hash;
    if (!loaded.made) return;
    summary.made = text_of(*loaded.made, options.auto_colliders);
    summary.made_colliders = loaded.made->colliders;
}

Result<Run> prepare(const RunOptions& options, LoadedScene& loaded) {
    const scene::Scene* const scene = &loaded.scene;
    const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    const int threads = options.threads > 0 ? options.threads : cores;
    Result<World> made =
        World::create(settings_of(options, *scene), {.structure = options.structure, .threads = threads});
    if (!made) return made.error();
    const Result<std::vector<BodyId>> ids = scene::instantiate(*scene, *made);
    if (!ids) {
        Error error = ids.error();
        error.where = options.scene + ": " + error.where;
        return error;
    }
    Run run{*std::move(made), *ids, std::move(loaded.level), {}, {}, {}};
    describe(options, loaded, run.summary);
    run.summary.threads = threads;
    const Result<std::uint64_t> steps = steps_of(options, run.world.settings().time_step);
    if (!steps) return steps.error();
    run.summary.requested_steps = *steps;
    if (!options.record.empty()) {
        SceneLook look = look_of(*scene, *ids);
        // Only the file name: recordings are passed on, and folders of this machine do not belong there.
        if (look.head.title.empty())
            look.head.title = printable(std::filesystem::path(options.scene).filename().string());
        run.summary.warnings.insert(run.summary.warnings.end(), look.warnings.begin(), look.warnings.end());
        if (auto made_folder = make_folder_of(options.record); !made_folder) return made_folder.error();
        Result<record::Recorder> recorder = record::Recorder::create(
            options.record, run.world, look.head, {.durable = options.durable, .contacts = options.record_contacts});
        if (!recorder) return recorder.error();
        run.recorder = *std::move(recorder);
        run.summary.recording = options.record;
    }
    if (!options.trace.empty()) {
        if (auto made_folder = make_folder_of(options.trace); !made_folder) return made_folder.error();
        Result<record::WorldTrace> trace = record::WorldTrace::create(options.trace, run.world);
        if (!trace) return trace.error();
        run.trace = *std::move(trace);
        run.summary.trace = options.trace;
    }
    return run;
}

/// Runs all steps, or until a signal is received.
Result<void> simulate(Run& run) {
    RunSummary& summary = run.summary;
    Progress progress("step", summary.requested_steps);
    if (auto written = run.write_frame(); !written) return written;
    for (std::uint64_t i = 0; i < summary.requested_steps && Interrupts::signal() == 0; ++i) {
        const Result<StepReport> report = run.world.step();
        if (!report) return report.error();
        summary.add(*report);
        if (auto written = run.write_frame(); !written) return written;
        if (progress.due()) progress.update(i + 1, fmt::format("{:.2f} ms  {} awake", report->total_ms, report->awake));
    }
    return {};
}

/// Completes the recording and the trace, and stores their sizes in the summary. After an error (`complete` false), the
/// trace stays a NAME.part, so that it does not replace an older one.
Result<void> finish_files(Run& run, bool complete) {
    Result<void> finished;
    if (run.recorder) {
        finished = run.recorder->finish();
        run.summary.recorded_frames = run.recorder->writer().frames();
        run.summary.recorded_bytes = run.recorder->writer().bytes();
    }
    if (run.trace) {
        const Result<void> traced = complete ? run.trace->finish() : run.trace->leave_part();
        run.summary.traced_frames = run.trace->writer().frames();
        run.summary.traced_bytes = run.trace->writer().bytes();
        if (finished) finished = traced;
    }
    return finished;
}

}  // namespace

int run_scene(const RunOptions& options) {
    const Interrupts interrupts;
    if (auto checked = check_options(options); !checked) return refuse(checked.error());
    Result<LoadedScene> loaded = load_with_colliders(options);
    if (!loaded) return refuse(loaded.error());
    if (const auto nothing = find_nothing_physical(loaded->scene, options.scene)) {
        refuse(*nothing);
        return exit_check_failed;
    }
    Result<Run> run = prepare(options, *loaded);
    if (!run) return refuse(run.error());
    const Result<void> simulated = simulate(*run);
    const Result<void> recorded = finish_files(*run, simulated.has_value());
    if (!simulated) return refuse(simulated.error());
    if (!recorded) return refuse(recorded.error());

    RunSummary& summary = run->summary;
    summary.hash = run->world.hash();
    summary.simulated_seconds = run->world.time();
    if (run->level) summary.outside = bodies_outside(*run->level, run->world, run->bodies);
    if (summary.step_ms.empty()) {
        summary.last = run->world.last_report();
    }
    summary.add_step_warnings();
    const std::string text = options.json ? to_json(summary) : to_table(summary);
    std::fwrite(text.data(), 1, text.size(), stdout);
    return Interrupts::signal() == 0 ? exit_ok : 128 + Interrupts::signal();
}

void add_run(Command& program, CommandRegistry& registry) {
    auto& run = registry.options<RunOptions>();
    Command command = program.add_command("run", "Simulate a scene, print a summary, record it");
    command.add_text("SCENE", "A .gltf, .glb or .wad file, or a kind of 'fase generate'", run.scene).required();
    command.add_text("--map", "Of a WAD: E1M1, MAP01 … (default: its first); filled with bodies", run.map);
    const Option seconds = command.add_positive_number("--seconds", "Simulated time (default 10)", max_seconds,
                                                       [&run](double value) { run.seconds = value; });
    command.add_whole_number("--steps", "Steps, instead of seconds", 0, max_steps, run.steps).excludes(seconds);
    add_structure(command, "Broad phase: auto (default), ", run.structure);
    add_threads(command, "0 (default): all cores; the result is the same for any", 0, run.threads);
    command.add_positive_number("--dt", "Seconds per step (default: the scene's, else 1/60)", 1,
                                [&run](double value) { run.time_step = value; });
    command.add_whole_number("--sub-steps", "Sub-steps of the solver per step (default: the scene's, else 4)", 1, 64,
                             run.sub_steps);
    command.add_flag("--no-sleep", "No body falls asleep", run.keep_awake);
    add_count(command, "Of a kind or a WAD: approximate number of bodies", run.count);
    add_seed(command, "Of a kind or a WAD: seed of the random numbers (default 1)", run.seed);
    const Option auto_colliders =
        command.add_text("--auto-colliders", "hull or box: give each mesh without a collider one, and make it a body",
                         run.auto_colliders);
    command
        .add_text("--static", "Of these: nodes whose names match this regular expression are static", run.static_nodes)
        .needs(auto_colliders);
    const Option record = command.add_text("--record", "Write a recording for 'fase view'", run.record);
    command.add_flag("--contacts", "Record all contact points too", run.record_contacts).needs(record);
    command.add_flag("--durable", "Force each block of the recording to the disk (power loss)", run.durable)
        .needs(record);
    command.add_text("--trace", "Write the colliders' boxes of each step for 'fase pairs' (.aabt)", run.trace);
    const Option hash = command.add_flag("--hash", "Print the hash of the world's final state", run.hash);
    add_json(command, run.json).excludes(hash);
    command.set_footer(
        "\nExamples:\n"
        "  fase run castle --seconds 12 --record castle.faserec\n"
        "  fase run scene.glb --steps 600 --threads 4 --json\n"
        "  fase run pile --count 500 --structure brute_force --trace pile.aabt\n"
        "  fase run freedoom1.wad --map E1M1 --count 300 --record e1m1.faserec\n"
        "  fase run yard.glb --auto-colliders hull --static 'ground|wall' --record yard.faserec\n"
        "\nAutomatic colliders: nodes with a mesh become dynamic bodies of 1000 kg/m³; meshes below such a node "
        "belong\n"
        "to it. Hulls fill hollows, so a room becomes solid. Flat meshes become 0.1 m thick.\n"
        "Exit code 1: nothing in the scene has physics.\n"
        "\nCtrl-C ends the run after the current step; the recording up to there is kept.");
    registry.on(command, [&run] { return run_scene(run); });
}

}  // namespace fase::cli
