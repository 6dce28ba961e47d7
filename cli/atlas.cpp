/// The command `fase atlas`: packs images into pages, or measures the packing of rectangles.
#include "cli/atlas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <new>
#include <set>

#include "cli/common/arguments.hpp"
#include "cli/common/clock.hpp"
#include "cli/common/command_registry.hpp"
#include "cli/common/output.hpp"
#include "cli/sprite_files.hpp"
#include "fase/atlas/atlas.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase::cli {
namespace {

namespace fs = std::filesystem;

/// The figures of a packing that are printed.
struct Figures {
    std::size_t count = 0, different = 0, skipped = 0;
    std::vector<atlas::Size> pages;
    double occupancy = 0, ms = 0;
    std::string rule;
};

void print(const Figures& figures, bool json) {
    atlas::Size largest;
    for (const atlas::Size page : figures.pages)
        if (area_of(page) > area_of(largest)) largest = page;
    if (json) {
        fmt::print(
            "{{\"count\": {}, \"pages\": {}, \"width\": {}, \"height\": {}, \"occupancy\": {:.6f}, \"ms\": {:.3f}, "
            "\"different\": {}, \"rule\": {}, \"skipped\": {}}}\n",
            figures.count, figures.pages.size(), largest.width, largest.height, figures.occupancy, figures.ms,
            figures.different, scene::quoted(figures.rule), figures.skipped);
        return;
    }
    const std::string shared =
        figures.different == figures.count ? "" : fmt::format(" ({} different)", figures.different);
    const std::string left_out = figures.skipped == 0 ? "" : fmt::format(", {} left out", figures.skipped);
    fmt::print("{}{}{} on {} page{}{} x {}: {:.2f} % filled, {:.2f} ms, {}\n", figures.count, shared, left_out,
               figures.pages.size(), figures.pages.size() == 1 ? " of " : "s of up to ", largest.width, largest.height,
               100 * figures.occupancy, figures.ms, figures.rule);
}

Result<atlas::PackOptions> pack_options_of(const AtlasCommand& command) {
    atlas::PackOptions options;
    options.max_side = command.max_side.value_or(command.rects.empty() ? 4096 : atlas::max_page_side);
    options.padding = command.padding;
    options.extrude = command.extrude;
    options.rotate = !command.no_rotate;
    options.power_of_two = command.power_of_two;
    options.budget_ms = command.budget_ms;
    options.tries = command.tries;
    if (command.method == "kd_tree") {
        options.method = atlas::Method::KdTree;
    } else if (command.method == "skyline") {
        options.method = atlas::Method::Skyline;
    } else if (!command.method.empty() && command.method != "best") {
        return Error{Status::BadArgument,
                     "--method",
                     fmt::format("found \"{}\"; expected best, kd_tree or skyline", printable(command.method, 40)),
                     {}};
    }
    return options;
}

Result<Figures> pack_rectangles(const AtlasCommand& command, const atlas::PackOptions& options) {
    const Result<std::vector<atlas::Size>> sizes = read_rectangles(command.rects);
    if (!sizes) return sizes.error();
    const auto start = Clock::now();
    const Result<atlas::Packing> packing = atlas::pack(*sizes, options);
    const double ms = ms_since(start);
    if (!packing) {
        Error error = packing.error();
        error.where = command.rects + ": " + error.where;
        return error;
    }
    return Figures{sizes->size(), sizes->size(), 0, packing->pages, packing->occupancy(*sizes), ms, packing->rule};
}

/// Prints a line for each image that cannot be read: as warnings if they are left out, else as errors. Returns the
/// error that ends the command, if one does.
Result<void> report_bad(const std::vector<Error>& bad, std::size_t files, bool skip) {
    if (bad.empty()) return {};
    const bool none_is_left = bad.size() == files;
    if (bad.size() == 1 && !skip) {
        Error error = bad[0];
        error.remedy += fmt::format("{}--skip-bad leaves it out", error.remedy.empty() ? "" : ", or ");
        return error;
    }
    for (const Error& error : bad) print_line(skip ? "warning" : "error", error.text());
    const std::string count = fmt::format("{} of {} images cannot be read", bad.size(), files);
    if (!skip) return Error{bad[0].status, "FILES", "found that " + count, "--skip-bad leaves them out"};
    if (none_is_left)
        return Error{bad[0].status, "FILES", "found that " + count + "; expected at least one good one", {}};
    print_line("warning", count + " and are left out");
    return {};
}

Result<Figures> make_pages(const AtlasCommand& command, const atlas::PackOptions& pack_options) {
    for (const OutputKind& kind : {output::image, output::atlas_data}) {
        if (has_extension(command.output, kind))
            return Error{
                Status::BadArgument, "--output",
                fmt::format("found \"{}\"; expected the NAME of NAME.png and NAME.json", printable(command.output, 60)),
                fmt::format("leave out {}", kind.extension)};
        if (auto checked = check_output(command.output + std::string(kind.extension), {kind}); !checked)
            return checked.error();
    }
    const Result<std::vector<SpriteFile>> files = find_sprites(command.inputs);
    if (!files) return files.error();
    const Result<SpriteImages> images = read_sprites(*files);
    if (!images) return images.error();
    if (auto usable = report_bad(images->bad, files->size(), command.skip_bad); !usable) return usable.error();
    const std::vector<atlas::Sprite>& sprites = images->sprites;
    const atlas::AtlasOptions options{pack_options, command.trim, command.array};
    const Result<atlas::Atlas> made = atlas::make_atlas(sprites, options);
    if (!made) return made.error();
    const Result<std::vector<atlas::NamedBytes>> outputs = atlas::files_of(*made, command.output, options);
    if (!outputs) return outputs.error();
    std::set<fs::path> inputs;
    std::error_code ignored;
    for (const SpriteFile& file : *files) inputs.insert(fs::weakly_canonical(file.path, ignored));
    for (const atlas::NamedBytes& file : *outputs) {
        if (auto checked = check_output(file.name, {output::image, output::atlas_data}); !checked)
            return checked.error();
        if (inputs.contains(fs::weakly_canonical(file.name, ignored)))
            return Error{Status::Io, file.name, "found an input file; expected another file to write",
                         "write the pages outside the folder of the sprites"};
    }
    if (auto folder = make_folder_of(command.output); !folder) return folder.error();
    if (auto written = atlas::write_files(*outputs); !written) return written.error();
    Figures figures{sprites.size(),  made->different, images->bad.size(), {},
                    made->occupancy, made->pack_ms,   made->rule};
    for (const atlas::Image& page : made->pages) figures.pages.push_back(page.size);
    return figures;
}

Result<Figures> pack(const AtlasCommand& command) {
    const bool measure_only = !command.rects.empty();
    if (measure_only && (!command.inputs.empty() || !command.output.empty()))
        return Error{Status::BadArgument, "--rects", "found FILES or --output with it; expected --rects alone", {}};
    if (measure_only && (command.trim || command.array || command.skip_bad))
        return Error{Status::BadArgument,
                     command.trim    ? "--trim"
                     : command.array ? "--array"
                                     : "--skip-bad",
                     "found --rects with it; expected images (FILES)",
                     {}};
    if (!measure_only && command.inputs.empty())
        return Error{Status::BadArgument, "FILES", "found none; expected PNG files or a folder of them",
                     "see 'fase atlas --help'"};
    if (!measure_only && command.output.empty())
        return Error{Status::BadArgument, "--output", "found none; expected the NAME of NAME.png and NAME.json",
                     "see 'fase atlas --help'"};
    const Result<atlas::PackOptions> options = pack_options_of(command);
    if (!options) return options.error();
    return measure_only ? pack_rectangles(command, *options) : make_pages(command, *options);
}

}  // namespace

int run_atlas(const AtlasCommand& command) {
    try {
        const Result<Figures> figures = pack(command);
        if (!figures) return refuse(figures.error());
        print(*figures, command.json);
        return exit_ok;
    } catch (const std::bad_alloc&) {
        return refuse({Status::NoMemory, "atlas", "found too little memory for the images and pages", {}});
    }
}

void add_atlas(Command& program, CommandRegistry& registry) {
    auto& options = registry.options<AtlasCommand>();
    Command command = program.add_command("atlas", "Pack images into pages, for PixiJS and Phaser");
    command.add_texts("FILES", "PNG files, or folders of them", options.inputs);
    command.add_text("-o,--output", "NAME: write NAME.png and NAME.json, or NAME-0.png … for several pages",
                     options.output);
    command.add_text("--rects", "Pack the rectangles of a file instead: width and height per line", options.rects);
    command.add_whole_number("--max", "The largest side of a page (default 4096; with --rects 65536)", 1,
                             atlas::max_page_side, options.max_side);
    command.add_whole_number("--padding", "Empty pixels between sprites (default 0)", 0, 1024, options.padding);
    command.add_whole_number("--extrude", "Pixels around each sprite that repeat its edge (default 0)", 0, 1024,
                             options.extrude);
    command.add_flag("--trim", "Remove transparent edges", options.trim);
    command.add_flag("--no-rotate", "Do not rotate sprites", options.no_rotate);
    command.add_flag("--power-of-two", "Pages whose sides are powers of two", options.power_of_two);
    command.add_flag("--array", "Frames as a JSON array instead of an object by name", options.array);
    command.add_flag("--skip-bad", "Leave out images that cannot be read, with a warning for each", options.skip_bad);
    command.add_text("--method", "best (default), kd_tree or skyline", options.method);
    const Option budget = command.add_positive_number("--budget-ms", "Time for packing (default 50)", 1e7,
                                                      [&options](double value) { options.budget_ms = value; });
    command
        .add_whole_number("--tries", "Packing attempts per page instead of a time: the same pages on any machine", 1,
                          1000000000, options.tries)
        .excludes(budget);
    add_json(command, options.json);
    command.set_footer(
        "\nExamples:\n"
        "  fase atlas sprites -o game --trim --padding 2\n"
        "  fase atlas hero.png tree.png -o game --power-of-two --tries 100\n"
        "  fase atlas --rects sizes.txt --budget-ms 3 --json\n"
        "\nAll images that cannot be read are listed; nothing is written then, or with --skip-bad the others are.\n"
        "A sprite from a folder is named by its path in that folder, a single file by its file name. Identical\n"
        "sprites share one place. Occupancy is the share of the pages' pixels that sprites cover. The time is the\n"
        "time of packing.");
    registry.on(command, [&options] { return run_atlas(options); });
}

}  // namespace fase::cli
