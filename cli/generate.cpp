/// The command `fase generate`: writes a scene made by rule.
#include "cli/generate.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <new>

#include "fase/scene/generate.hpp"
#include "fase/scene/gltf_write.hpp"
#include "fase/scene/json.hpp"

namespace fase::cli {
namespace {

/// Text that can do no harm on a terminal: control characters escaped as in JSON, quotes and backslashes as they are.
std::string plain(std::string_view text) {
    const std::string quoted = scene::quoted(text);
    std::string safe;
    for (std::size_t i = 1; i + 1 < quoted.size(); ++i) {
        if (quoted[i] == '\\' && (quoted[i + 1] == '"' || quoted[i + 1] == '\\')) ++i;
        safe += quoted[i];
    }
    return safe;
}

int refuse(const Error& error) {
    fmt::print(stderr, "fase: error: {}\n", error.text());
    return error.status == Status::Io ? 3 : error.status == Status::NoMemory ? 4 : 2;
}

}  // namespace

std::string generate_kinds() {
    std::string text;
    for (const scene::Generator& kind : scene::generators()) {
        text += fmt::format("  {:<14} {} ({} bodies)\n", kind.name, kind.description, kind.default_count);
    }
    return text;
}

int run_generate(const GenerateOptions& options) {
    const bool known_ending = options.output.ends_with(".glb") || options.output.ends_with(".gltf");
    if (!known_ending)
        return refuse({Status::BadArgument, plain(options.output), "found another ending, need .glb or .gltf", {}});
    try {
        const Result<scene::Scene> made = scene::generate(options.kind, {options.count, options.seed});
        if (!made) {
            Error error = made.error();
            error.where = error.where == "kind" ? "KIND" : "--" + error.where;
            return refuse(error);
        }
        if (const Result<void> written = scene::write_gltf(*made, options.output); !written) {
            Error error = written.error();
            error.where = plain(error.where);
            return refuse(error);
        }
        fmt::print("{}: {}, {} bodies, {} of them dynamic\n", plain(options.output), options.kind, made->bodies.size(),
                   scene::dynamic_bodies(*made));
        return 0;
    } catch (const std::bad_alloc&) {
        return refuse(
            {Status::NoMemory, "--count", fmt::format("found too little memory for {} bodies", options.count), {}});
    }
}

}  // namespace fase::cli
