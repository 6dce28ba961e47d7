/// The command `fase generate`: writes a generated scene or trace.
#include "cli/generate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <new>

#include "cli/common/arguments.hpp"
#include "cli/common/command_registry.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/output.hpp"
#include "fase/record/generate_trace.hpp"
#include "fase/scene/generate.hpp"
#include "fase/scene/gltf_write.hpp"

namespace fase::cli {
namespace {

/// One line per kind: name, description, default count.
template <class Kinds> std::string lines_of(const Kinds& kinds, const char* unit) {
    std::string text;
    for (const auto& kind : kinds)
        text += fmt::format("  {:<14} {} ({} {})\n", kind.name, kind.description, kind.default_count, unit);
    return text;
}

/// Renames the fields of a library error to the options of the command line.
Error with_option_names(Error error) {
    if (error.where == "kind") error.where = "KIND";
    if (error.where == "count") error.where = "--count";
    return error;
}

template <class Kinds> bool has_kind(const Kinds& kinds, const std::string& name) {
    return std::any_of(kinds.begin(), kinds.end(), [&](const auto& kind) { return kind.name == name; });
}

template <class Kinds> std::string names_of(const Kinds& kinds) {
    std::string names;
    for (const auto& kind : kinds) names += fmt::format("{}{}", names.empty() ? "" : ", ", kind.name);
    return names;
}

/// Checks the kind, and that the output fits it. Some kinds are both scenes and traces.
Result<void> check(const GenerateOptions& options) {
    const bool is_scene = has_kind(scene::generators(), options.kind),
               is_trace = has_kind(record::trace_kinds(), options.kind);
    if (!is_scene && !is_trace)
        return Error{Status::BadArgument,
                     "KIND",
                     fmt::format("found \"{}\"; expected a scene ({}) or a trace ({})", printable(options.kind, 60),
                                 names_of(scene::generators()), names_of(record::trace_kinds())),
                     {}};
    if (!is_scene && has_extension(options.output, output::scene))
        return Error{Status::BadArgument,
                     options.output,
                     fmt::format("found a scene's extension; {} is a trace, which needs .aabt", options.kind),
                     {}};
    if (!is_trace && has_extension(options.output, output::trace))
        return Error{Status::BadArgument, options.output,
                     fmt::format("found a trace's extension; {} is a scene, which needs .glb or .gltf", options.kind),
                     fmt::format("'fase run {} --trace FILE.aabt' simulates it and writes a trace", options.kind)};
    if (is_scene && is_trace) return check_output(options.output, {output::scene, output::trace});
    return is_scene ? check_output(options.output, {output::scene}) : check_output(options.output, {output::trace});
}

/// Printed when a signal ends the command during a long computation.
constexpr const char* stopped_late = "interrupted: nothing is written";

int write_scene(const GenerateOptions& options) {
    if (options.frames != 0)
        return refuse({Status::BadArgument, "--frames", "found a scene; expected a trace (.aabt)", {}});
    const Interrupts interrupts(stopped_late);
    const Result<scene::Scene> made = scene::generate(options.kind, {options.count, options.seed});
    if (!made) return refuse(with_option_names(made.error()));
    if (Interrupts::signal() != 0) return refuse_interrupted(options.output);
    if (auto folder = make_folder_of(options.output); !folder) return refuse(folder.error());
    if (const Result<void> written = scene::write_gltf(*made, options.output); !written)
        return Interrupts::signal() != 0 ? refuse_interrupted(options.output) : refuse(written.error());
    fmt::print("{}: {}, {} bodies, {} of them dynamic\n", printable(options.output), options.kind, made->bodies.size(),
               scene::dynamic_bodies(*made));
    return Interrupts::signal() == 0 ? exit_ok : 128 + Interrupts::signal();
}

int write_trace(const GenerateOptions& options) {
    if (auto folder = make_folder_of(options.output); !folder) return refuse(folder.error());
    Interrupts interrupts(stopped_late);
    bool has_part = false;
    const auto keep_going = [&] {
        if (!has_part) interrupts.remove_at_exit(options.output + ".part");
        has_part = true;
        return Interrupts::signal() == 0;
    };
    const Result<record::GeneratedTrace> made =
        record::generate_trace(options.kind, {options.count, options.frames, options.seed}, options.output, keep_going);
    if (!made) return refuse(with_option_names(made.error()));
    if (made->stopped) return refuse_interrupted(options.output);
    fmt::print("{}: {}, {} boxes, {} static, {} asleep, {} frames\n", printable(options.output), options.kind,
               made->boxes, made->static_boxes, made->asleep_boxes, made->frames);
    return Interrupts::signal() == 0 ? exit_ok : 128 + Interrupts::signal();
}

}  // namespace

int run_generate(const GenerateOptions& options) {
    if (auto checked = check(options); !checked) return refuse(checked.error());
    // A device has any name: then the kind decides.
    const bool scene = has_kind(scene::generators(), options.kind) && !has_extension(options.output, output::trace);
    try {
        return scene ? write_scene(options) : write_trace(options);
    } catch (const std::bad_alloc&) {
        return refuse(
            {Status::NoMemory, "--count", fmt::format("found too little memory for {} bodies", options.count), {}});
    }
}

void add_generate(Command& program, CommandRegistry& registry) {
    auto& generate = registry.options<GenerateOptions>();
    Command command = program.add_command("generate", "Generate a scene, or a trace of boxes");
    command.add_text("KIND", "What to generate: a scene or a trace, listed below", generate.kind).required();
    add_count(command, "Approximate number of bodies; boxes of a trace", generate.count);
    command.add_whole_number("--frames", "Of a trace (default: depends on the kind)", 1, 1'000'000, generate.frames);
    add_seed(command, "Seed of the random numbers (default 1)", generate.seed);
    command.add_text("-o,--output", "The file to write: .glb or .gltf for a scene, .aabt for a trace", generate.output)
        .required();
    command.set_footer("\nScenes (.glb, .gltf), bodies with shapes, for 'fase run':\n" +
                       lines_of(scene::generators(), "bodies") +
                       "\nTraces (.aabt), boxes frame by frame, for 'fase pairs', 'query' and 'draw':\n" +
                       lines_of(record::trace_kinds(), "boxes") +
                       "\nExamples:\n"
                       "  fase generate castle -o castle.glb\n"
                       "  fase generate pile --count 500 --seed 7 -o pile.gltf\n"
                       "  fase generate rain --count 100000 --frames 300 -o rain.aabt");
    registry.on(command, [&generate] { return run_generate(generate); });
}

}  // namespace fase::cli
