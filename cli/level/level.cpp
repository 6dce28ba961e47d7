/// The command `fase level`: compiles maps of WAD files; measures, draws and writes them.
#include "cli/level/level.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <new>
#include <optional>

#include "cli/common/arguments.hpp"
#include "cli/common/clock.hpp"
#include "cli/common/command_registry.hpp"
#include "cli/common/input.hpp"
#include "cli/common/output.hpp"
#include "cli/level/mesh.hpp"
#include "cli/level/report.hpp"
#include "cli/level/sight.hpp"
#include "fase/atlas/png.hpp"
#include "fase/core/detail/files.hpp"
#include "fase/core/tasks.hpp"
#include "fase/level/bsp_compiler.hpp"
#include "fase/level/bsp_lumps.hpp"
#include "fase/level/plan_drawing.hpp"

namespace fase::cli {
namespace {

using level::LevelBsp;
using level::Map;
using level::Wad;

/// The options after parsing and checking.
struct ParsedOptions {
    level::CompileOptions compile;
    level::LumpOptions lumps;
    std::optional<level::BspLumps> read;
    std::optional<level::Point> point;
    SightOptions sight;
};

std::optional<double> number_in(std::string_view text) {
    double number = 0;
    const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool good = !text.empty() && stop == text.data() + text.size() && code == std::errc{};
    return good ? std::optional(number) : std::nullopt;
}

Error bad_option(const char* option, const std::string& found, std::string_view need) {
    return {Status::BadArgument, option, fmt::format("found \"{}\"; expected {}", printable(found, 60), need), {}};
}

Result<ParsedOptions> parse_options(const LevelCommand& command) {
    ParsedOptions options;
    options.lumps = {command.extended, command.gl};
    if (!command.weight.empty()) {
        const auto weight = number_in(command.weight);
        if (!weight || !(*weight >= 0 && *weight <= 1000))
            return bad_option("--weight", command.weight, "a number from 0 to 1000");
        options.compile.split_weight = *weight;
    }
    if (command.effort == "quick") {
        options.compile.effort = level::Effort::Quick;
    } else if (command.effort == "thorough") {
        options.compile.effort = level::Effort::Thorough;
    } else if (!command.effort.empty() && command.effort != "normal") {
        return bad_option("--effort", command.effort, "quick, normal or thorough");
    }
    if (command.lumps == "nodes" || command.lumps == "gl") {
        options.read = command.lumps == "gl" ? level::BspLumps::Gl : level::BspLumps::Nodes;
    } else if (!command.lumps.empty()) {
        return bad_option("--lumps", command.lumps, "nodes or gl");
    }
    if (!command.point.empty()) {
        const std::size_t comma = command.point.find(',');
        const auto x = number_in(std::string_view(command.point).substr(0, comma));
        const auto y = number_in(comma == std::string::npos ? std::string_view()
                                                            : std::string_view(command.point).substr(comma + 1));
        constexpr double limit = 65536;
        if (!x || !y || !(*x >= -limit && *x <= limit && *y >= -limit && *y <= limit))
            return bad_option("--point", command.point, "X,Y, two numbers from -65536 to 65536");
        options.point = level::Point{*x, *y};
    }
    if (command.rays > 0 && !command.pvs)
        return Error{
            Status::BadArgument, "--rays", "found no --pvs; expected it with --rays, which check the visible sets", {}};
    if (command.heights && !command.pvs && command.point.empty())
        return Error{
            Status::BadArgument, "--heights", "found no --pvs and no --point; expected one of them with it", {}};
    if (command.output.empty() && (command.gl || command.extended))
        return Error{Status::BadArgument,
                     command.gl ? "--gl" : "--extended",
                     "found no --output; expected it with the kind of nodes to write",
                     {}};
    if (options.read && (!command.weight.empty() || !command.effort.empty()))
        return Error{Status::BadArgument,
                     command.weight.empty() ? "--effort" : "--weight",
                     "found --lumps with it; expected a tree to compile",
                     {}};
    options.sight = {options.point, command.pvs, command.heights ? level::Heights::Counted : level::Heights::Ignored,
                     command.rays};
    const bool one_map = !command.svg.empty() || !command.png.empty() || !command.point.empty();
    if (command.all && !command.map.empty()) return bad_option("--all", command.map, "no MAP with it");
    if (command.all && one_map)
        return Error{
            Status::BadArgument, "--all", "found --svg, --png or --point with it; expected a single MAP for these", {}};
    if (options.read && !command.output.empty())
        return Error{Status::BadArgument, "--lumps", "found --output with it; expected one of the two", {}};
    return options;
}

/// The markers of the requested maps.
Result<std::vector<std::size_t>> markers_of(const LevelCommand& command, const Wad& wad) {
    std::vector<std::size_t> markers = wad.map_markers();
    if (markers.empty())
        return Error{Status::Format, command.file, "found no map; expected THINGS and LINEDEFS after a marker", {}};
    if (command.all || (command.map.empty() && markers.size() == 1)) return markers;
    if (!command.map.empty()) {
        if (const auto marker = wad.find_map(command.map)) return std::vector{*marker};
    }
    std::string known;
    for (const std::size_t m : markers) known += (known.empty() ? "" : ", ") + printable(wad.lumps[m].name);
    return Error{Status::BadArgument, command.file,
                 command.map.empty()
                     ? fmt::format("found {} maps; expected the name of one of {}", markers.size(), known)
                     : fmt::format("no map \"{}\"; expected one of {}", printable(command.map, 40), known),
                 command.map.empty() ? "or --all" : ""};
}

/// One map: its marker, its compiled tree, its figures.
struct MapJob {
    std::size_t marker = 0;
    std::optional<Map> map;
    std::optional<LevelBsp> bsp;
    LevelRow row;
    std::optional<Error> error;
};

void compile(const LevelCommand& command, const ParsedOptions& options, const Wad& wad, TaskRunner& tasks,
             MapJob& job) {
    Result<Map> map = level::read_map(command.file, wad, wad.lumps[job.marker].name);
    if (!map) {
        job.error = map.error();
        return;
    }
    job.map = std::move(*map);
    for (const std::string& what : job.map->left_out)
        print_line("warning", fmt::format("{}: {}: left out {}", command.file, job.map->name, what));
    const auto start = Clock::now();
    Result<LevelBsp> bsp = options.read ? level::read_bsp(command.file, wad, job.marker, *job.map, *options.read)
                                        : level::compile(*job.map, options.compile);
    if (!bsp) {
        job.error = bsp.error();
        if (!options.read) job.error->where = fmt::format("{}: {} {}", command.file, job.map->name, job.error->where);
        return;
    }
    job.row.ms = ms_since(start);
    job.bsp = std::move(*bsp);
    job.row.map = job.map->name;
    job.row.stats = job.bsp->stats;
    job.row.nodes = job.bsp->nodes.size();
    job.row.sub_sectors = job.bsp->sub_sectors.size();
    if (command.check || command.stats) job.row.check = level::check_bsp(*job.map, *job.bsp);
    if (options.point) job.row.place = place_of(*job.map, *job.bsp, *options.point);
    if (options.point || command.pvs) {
        Result<SightReport> sight = look_around(*job.map, *job.bsp, options.sight, tasks);
        if (!sight) {
            job.error = sight.error();
            return;
        }
        job.row.sight = *std::move(sight);
    }
    if (command.all) job.map->things.clear();
}

Result<void> draw(const LevelCommand& command, const ParsedOptions& options, const MapJob& job) {
    level::PlanOptions look;
    look.title = job.row.map;
    look.note = fmt::format("{} lines, {} segs (+{:.1f} %), {} nodes, {} sub-sectors, depth {:.1f} mean, {} worst",
                            job.row.stats.lines, job.row.stats.wall_segs, 100 * share_of_splits(job.row.stats),
                            job.row.nodes, job.row.sub_sectors, job.row.stats.mean_depth, job.row.stats.worst_depth);
    look.eye = options.point;
    if (job.row.sight) {
        look.seen = job.row.sight->from_cell;
        if (const auto& seen = job.row.sight->from_point) {
            if (!command.pvs) look.seen = seen->sub_sectors;
            for (std::size_t i = 0, first = 0; i < seen->part_ends.size(); first = seen->part_ends[i++])
                look.sight.emplace_back(seen->corners.begin() + static_cast<std::ptrdiff_t>(first),
                                        seen->corners.begin() + static_cast<std::ptrdiff_t>(seen->part_ends[i]));
        }
    }
    const level::Drawing drawing = level::draw_plan(*job.map, *job.bsp, look);
    if (!command.svg.empty()) {
        const std::string svg = level::svg_of(drawing);
        if (auto made = make_folder_of(command.svg); !made) return made;
        if (auto written = write_file(command.svg, std::as_bytes(std::span(svg))); !written) return written;
    }
    if (command.png.empty()) return {};
    level::Pixels pixels = level::pixels_of(drawing, 2);
    atlas::Image image;
    image.size = {pixels.width, pixels.height};
    image.pixels = std::move(pixels.rgba);
    const auto png = atlas::write_png(image);
    if (auto made = make_folder_of(command.png); !made) return made;
    return png ? write_file(command.png, *png) : png.error();
}

Result<void> write_wad(const LevelCommand& command, const ParsedOptions& options, Wad& wad,
                       const std::vector<MapJob>& jobs) {
    for (std::size_t i = jobs.size(); i-- > 0;) {  // last map first: lumps may be added
        if (!jobs[i].bsp) continue;
        auto written = level::write_bsp(wad, jobs[i].marker, command.file, *jobs[i].map, *jobs[i].bsp, options.lumps);
        if (!written) return written;
    }
    const auto bytes = wad.to_bytes();
    if (auto made = make_folder_of(command.output); !made) return made;
    return bytes ? write_file(command.output, *bytes) : bytes.error();
}

Result<int> compile_maps(const LevelCommand& command) {
    const Result<ParsedOptions> options = parse_options(command);
    if (!options) return options.error();
    const std::pair<const std::string*, OutputKind> outputs[] = {
        {&command.output, output::wad}, {&command.svg, output::drawing}, {&command.png, output::image}};
    for (const auto& [file, kind] : outputs)
        if (!file->empty())
            if (auto checked = check_output(*file, {kind}, command.file); !checked) return checked.error();
    static constexpr FileKind kinds[]{FileKind::Wad};
    if (auto checked = check_input(command.file, {"level", "levels (.wad) and meshes (.obj, .gltf, .glb)", kinds});
        !checked)
        return checked.error();
    Result<Wad> wad = Wad::read(command.file);
    if (!wad) return wad.error();
    const Result<std::vector<std::size_t>> markers = markers_of(command, *wad);
    if (!markers) return markers.error();

    const auto start = Clock::now();
    std::vector<MapJob> jobs(markers->size());
    for (std::size_t i = 0; i < jobs.size(); ++i) jobs[i].marker = (*markers)[i];
    const auto tasks = make_thread_runner(command.threads);
    tasks->run(jobs.size(), [&](std::size_t i) {
        const StandardFloats floats;
        compile(command, *options, *wad, *tasks, jobs[i]);
    });
    const double ms = ms_since(start);
    std::vector<LevelRow> rows;
    for (MapJob& job : jobs) {
        if (job.error && !(command.all && job.error->status == Status::Unsupported)) return *job.error;
        if (job.error) {
            job.row.map = wad->lumps[job.marker].name;
            job.row.note = job.error->problem;
        }
        rows.push_back(job.row);
    }
    if (auto drawn = command.svg.empty() && command.png.empty() ? Result<void>{} : draw(command, *options, jobs[0]);
        !drawn)
        return drawn.error();
    if (!command.output.empty())
        if (auto written = write_wad(command, *options, *wad, jobs); !written) return written.error();
    const std::string text = command.json ? to_json(rows, command.all) : to_text(rows, command.all, ms);
    std::fwrite(text.data(), 1, text.size(), stdout);
    const bool hidden = std::any_of(rows.begin(), rows.end(),
                                    [](const LevelRow& row) { return row.sight && row.sight->falsely_hidden > 0; });
    return hidden || (command.check && !all_good(rows)) ? exit_check_failed : exit_ok;
}

bool is_mesh(FileKind kind) { return kind == FileKind::Obj || kind == FileKind::Glb || kind == FileKind::Gltf; }

/// The command for a mesh; refuses options that only maps have.
int run_mesh(const LevelCommand& command, FileKind kind) {
    const std::pair<const char*, bool> wad_only[] = {{"MAP", !command.map.empty()},
                                                     {"--all", command.all},
                                                     {"--output", !command.output.empty()},
                                                     {"--svg", !command.svg.empty()},
                                                     {"--png", !command.png.empty()},
                                                     {"--weight", !command.weight.empty()},
                                                     {"--effort", !command.effort.empty()},
                                                     {"--lumps", !command.lumps.empty()},
                                                     {"--gl", command.gl},
                                                     {"--extended", command.extended},
                                                     {"--pvs", command.pvs},
                                                     {"--heights", command.heights},
                                                     {"--stats", command.stats},
                                                     {"--check", command.check}};
    for (const auto& [option, given] : wad_only)
        if (given) return refuse({Status::BadArgument, option, "found a mesh; expected a WAD", {}});
    return run_level_mesh(
        {command.file, kind == FileKind::Obj, command.point, command.rays, command.threads, command.json});
}

}  // namespace

int run_level(const LevelCommand& command) {
    try {
        // A file of another kind is refused with the options of maps, which are checked first.
        if (const auto kind = kind_of_file(command.file); kind && is_mesh(*kind)) return run_mesh(command, *kind);
        const Result<int> code = compile_maps(command);
        return code ? *code : refuse(code.error());
    } catch (const std::bad_alloc&) {
        return refuse({Status::NoMemory, command.file, "found too little memory for the maps", {}});
    }
}

void add_level(Command& program, CommandRegistry& registry) {
    auto& options = registry.options<LevelCommand>();
    Command command = program.add_command("level", "Compile a level of a Doom WAD into a BSP tree");
    command
        .add_text("FILE", "A .wad file; or a mesh (.obj, .gltf, .glb), for a BSP tree of its triangles", options.file)
        .required();
    command.add_text("MAP", "E1M1, MAP01 …; optional if the file has one map", options.map);
    command.add_flag("--all", "Every map of the file", options.all);
    command.add_text("-o,--output", "Write the WAD with the new trees", options.output);
    command.add_flag("--gl", "Write GL nodes too", options.gl);
    command.add_flag("--extended", "Write 32-bit nodes (XNOD, and with --gl XGLN)", options.extended);
    command.add_text("--weight", "Cost of a split, from 0 (balanced trees); default 1", options.weight);
    command.add_text("--effort", "quick, normal (default) or thorough", options.effort);
    command.add_text("--svg", "Draw the plan", options.svg);
    command.add_text("--png", "Draw the plan as an image", options.png);
    command.add_text("--point",
                     "X,Y: print the sub-sector and sector there and what is visible, also on the plan. For a mesh "
                     "X,Y,Z: is it solid?",
                     options.point);
    command.add_text("--lumps", "nodes or gl: read the tree of the file instead of compiling one", options.lumps);
    command.add_flag("--pvs", "Compute which sub-sectors are visible from each other", options.pvs);
    command.add_flag("--heights", "Floors, ceilings and closed doors occlude, too", options.heights);
    command.add_whole_number("--rays", "With --pvs, or for a mesh: cast random rays and check what they hit", 1,
                             100'000'000, options.rays);
    command.add_flag("--stats", "Print more: minisegs, areas, accuracy", options.stats);
    command.add_flag("--check", "Check the tree against the map: convex sub-sectors, covered lines, areas",
                     options.check);
    add_threads(command, "Maps compiled in parallel (default: all cores)", 1, options.threads);
    add_json(command, options.json);
    command.set_footer(
        "\nExamples:\n"
        "  fase level freedoom1.wad E1M1 --svg e1m1.svg --stats\n"
        "  fase level freedoom2.wad --all -o compiled.wad --gl\n"
        "  fase level map.wad --weight 0 --effort thorough --json\n"
        "  fase level compiled.wad MAP01 --lumps gl --check\n"
        "  fase level freedoom1.wad E1M1 --pvs --rays 1000000 --point 1056,-3616 --svg seen.svg\n"
        "  fase level house.obj --rays 100000\n"
        "\nSegs are counted as in the classic lumps; splits are segs minus sides of lines. Depth is the number of "
        "nodes\n"
        "above a sub-sector. The time is the compile time, without reading and writing.\n"
        "Exit code 1: --check found a wrong tree, or rays show an error.");
    registry.on(command, [&options] { return run_level(options); });
}

}  // namespace fase::cli
