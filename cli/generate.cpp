/// The command `fase generate`: writes a generated scene or trace.
#include "cli/generate.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <new>

#include "cli/common/arguments.hpp"
#include "cli/common/command_registry.hpp"
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

int write_scene(const GenerateOptions& options) {
    if (options.frames != 0)
        return refuse({Status::BadArgument, "--frames", "found a scene; expected a trace (.aabt)", {}});
    const Result<scene::Scene> made = scene::generate(options.kind, {options.count, options.seed});
    if (!made) return refuse(with_option_names(made.error()));
    if (const Result<void> written = scene::write_gltf(*made, options.output); !written) return refuse(written.error());
    fmt::print("{}: {}, {} bodies, {} of them dynamic\n", printable(options.output), options.kind, made->bodies.size(),
               scene::dynamic_bodies(*made));
    return exit_ok;
}

int write_trace(const GenerateOptions& options) {
    const Result<record::GeneratedTrace> made =
        record::generate_trace(options.kind, {options.count, options.frames, options.seed}, options.output);
    if (!made) return refuse(with_option_names(made.error()));
    fmt::print("{}: {}, {} boxes, {} static, {} asleep, {} frames\n", printable(options.output), options.kind,
               made->boxes, made->static_boxes, made->asleep_boxes, made->frames);
    return exit_ok;
}

}  // namespace

int run_generate(const GenerateOptions& options) {
    if (auto writable = check_output(options.output); !writable) return refuse(writable.error());
    const bool scene = options.output.ends_with(".glb") || options.output.ends_with(".gltf");
    if (!scene && !options.output.ends_with(".aabt")) {
        return refuse({Status::BadArgument,
                       options.output,
                       "found another extension; expected .glb or .gltf for a scene, .aabt for a trace",
                       {}});
    }
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
    command.add_text("KIND", "What to generate, see below", generate.kind).required();
    add_count(command, "Approximate number of bodies; boxes of a trace", generate.count);
    command.add_whole_number("--frames", "Of a trace (default: depends on the kind)", 1, 1'000'000, generate.frames);
    add_seed(command, "Seed of the random numbers (default 1)", generate.seed);
    command.add_text("-o,--output", "The file to write: .glb or .gltf for a scene, .aabt for a trace", generate.output)
        .required();
    command.set_footer("\nScenes:\n" + lines_of(scene::generators(), "bodies") + "\nTraces:\n" +
                       lines_of(record::trace_kinds(), "boxes") +
                       "\nExamples:\n"
                       "  fase generate castle -o castle.glb\n"
                       "  fase generate pile --count 500 --seed 7 -o pile.gltf\n"
                       "  fase generate rain --count 100000 --frames 300 -o rain.aabt");
    registry.on(command, [&generate] { return run_generate(generate); });
}

}  // namespace fase::cli
