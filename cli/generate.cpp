/// The command `fase generate`: writes a scene made by rule.
#include "cli/generate.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <new>

#include "cli/arguments.hpp"
#include "cli/output.hpp"
#include "cli/start.hpp"
#include "fase/scene/generate.hpp"
#include "fase/scene/gltf_write.hpp"

namespace fase::cli {
namespace {

/// A line a kind: its name, what it is, how many bodies it has when not told.
std::string kinds() {
    std::string text;
    for (const scene::Generator& kind : scene::generators()) {
        text += fmt::format("  {:<14} {} ({} bodies)\n", kind.name, kind.description, kind.default_count);
    }
    return text;
}

}  // namespace

int run_generate(const GenerateOptions& options) {
    if (auto writable = check_output(options.output); !writable) return refuse(writable.error());
    const bool known_ending = options.output.ends_with(".glb") || options.output.ends_with(".gltf");
    if (!known_ending)
        return refuse({Status::BadArgument, options.output, "found another ending, need .glb or .gltf", {}});
    try {
        const Result<scene::Scene> made = scene::generate(options.kind, {options.count, options.seed});
        if (!made) {
            Error error = made.error();
            error.where = error.where == "kind" ? "KIND" : "--" + error.where;
            return refuse(error);
        }
        if (const Result<void> written = scene::write_gltf(*made, options.output); !written)
            return refuse(written.error());
        fmt::print("{}: {}, {} bodies, {} of them dynamic\n", printable(options.output), options.kind,
                   made->bodies.size(), scene::dynamic_bodies(*made));
        return exit_ok;
    } catch (const std::bad_alloc&) {
        return refuse(
            {Status::NoMemory, "--count", fmt::format("found too little memory for {} bodies", options.count), {}});
    }
}

void add_generate(CLI::App& app, Start& start) {
    auto& generate = start.options<GenerateOptions>();
    CLI::App& command = *app.add_subcommand("generate", "Write a scene made by rule");
    add_text(command, "KIND", "What to make, see below", generate.kind)->required();
    add_count(command, "Bodies, roughly", generate.count);
    add_seed(command, "Another one of the kind (default 1)", generate.seed);
    add_text(command, "-o,--output", "The .glb or .gltf file to write", generate.output)->required();
    command.footer("\nKinds:\n" + kinds() +
                   "\nExamples:\n"
                   "  fase generate castle -o castle.glb\n"
                   "  fase generate pile --count 500 --seed 7 -o pile.gltf");
    start.on(command, [&generate] { return run_generate(generate); });
}

}  // namespace fase::cli
