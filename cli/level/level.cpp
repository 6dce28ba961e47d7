/// The command `fase level`: compiles maps of WAD files, measures, draws and writes them.
#include "cli/level/level.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <new>
#include <optional>

#include "cli/common/arguments.hpp"
#include "cli/common/output.hpp"
#include "cli/common/start.hpp"
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

/// The options, understood.
struct Wish {
    level::CompileOptions compile;
    level::LumpOptions lumps;
    std::optional<level::BspLumps> read;
    std::optional<level::Point> point;
    SightWish sight;
};

std::optional<double> number_in(std::string_view text) {
    double number = 0;
    const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool good = !text.empty() && stop == text.data() + text.size() && code == std::errc{};
    return good ? std::optional(number) : std::nullopt;
}

Error bad_option(const char* option, const std::string& found, std::string_view need) {
    return {Status::BadArgument, option, fmt::format("found \"{}\", need {}", printable(found, 60), need), {}};
}

Result<Wish> wish_of(const LevelCommand& command) {
    Wish wish;
    wish.lumps = {command.extended, command.gl};
    if (!command.weight.empty()) {
        const auto weight = number_in(command.weight);
        if (!weight || !(*weight >= 0 && *weight <= 1000))
            return bad_option("--weight", command.weight, "a number from 0 to 1000");
        wish.compile.split_weight = *weight;
    }
    if (command.effort == "quick") {
        wish.compile.effort = level::Effort::Quick;
    } else if (command.effort == "thorough") {
        wish.compile.effort = level::Effort::Thorough;
    } else if (!command.effort.empty() && command.effort != "normal") {
        return bad_option("--effort", command.effort, "quick, normal or thorough");
    }
    if (command.lumps == "nodes" || command.lumps == "gl") {
        wish.read = command.lumps == "gl" ? level::BspLumps::Gl : level::BspLumps::Nodes;
    } else if (!command.lumps.empty()) {
        return bad_option("--lumps", command.lumps, "nodes or gl");
    }
    if (!command.point.empty()) {
        const std::size_t comma = command.point.find(',');
        const auto x = number_in(std::string_view(command.point).substr(0, comma));
        const auto y =
            comma == std::string::npos ? std::nullopt : number_in(std::string_view(command.point).substr(comma + 1));
        constexpr double most = 65536;
        if (!x || !y || !(*x >= -most && *x <= most && *y >= -most && *y <= most))
            return bad_option("--point", command.point, "X,Y, two numbers from -65536 to 65536");
        wish.point = level::Point{*x, *y};
    }
    if (command.rays > 0 && !command.pvs)
        return Error{Status::BadArgument, "--rays", "found no visible sets to hold against, need --pvs", {}};
    wish.sight = {wish.point, command.pvs, command.heights ? level::Heights::Counted : level::Heights::Ignored,
                  command.rays};
    const bool one_map = !command.svg.empty() || !command.png.empty() || !command.point.empty();
    if (command.all && !command.map.empty()) return bad_option("--all", command.map, "no MAP beside it");
    if (command.all && one_map)
        return Error{Status::BadArgument, "--all", "found a plan or a point beside it, need one MAP for these", {}};
    if (wish.read && !command.output.empty())
        return Error{Status::BadArgument, "--lumps", "found an output beside it, need one or the other", {}};
    return wish;
}

/// The maps that are asked for, by their markers.
Result<std::vector<std::size_t>> markers_of(const LevelCommand& command, const Wad& wad) {
    std::vector<std::size_t> markers = wad.map_markers();
    if (markers.empty())
        return Error{Status::Format, command.file, "found no map in it, need THINGS and LINEDEFS behind a marker", {}};
    if (command.all || (command.map.empty() && markers.size() == 1)) return markers;
    if (!command.map.empty()) {
        if (const auto marker = wad.find_map(command.map)) return std::vector{*marker};
    }
    std::string known;
    for (const std::size_t m : markers) known += (known.empty() ? "" : ", ") + printable(wad.lumps[m].name);
    return Error{Status::BadArgument, command.file,
                 command.map.empty()
                     ? fmt::format("found {} maps, need the name of one of {}", markers.size(), known)
                     : fmt::format("found no map \"{}\", need one of {}", printable(command.map, 40), known),
                 command.map.empty() ? "or --all" : ""};
}

/// One map, from its lumps to its tree.
struct Work {
    std::size_t marker = 0;
    std::optional<Map> map;
    std::optional<LevelBsp> bsp;
    LevelRow row;
    std::optional<Error> error;
};

void compile(const LevelCommand& command, const Wish& wish, const Wad& wad, TaskRunner& tasks, Work& work) {
    const auto since = [](auto start) {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    };
    Result<Map> map = level::read_map(command.file, wad, wad.lumps[work.marker].name);
    if (!map) {
        work.error = map.error();
        return;
    }
    work.map = std::move(*map);
    const auto start = std::chrono::steady_clock::now();
    Result<LevelBsp> bsp = wish.read ? level::read_bsp(command.file, wad, work.marker, *work.map, *wish.read)
                                     : level::compile(*work.map, wish.compile);
    if (!bsp) {
        work.error = bsp.error();
        if (!wish.read) work.error->where = fmt::format("{}: {} {}", command.file, work.map->name, work.error->where);
        return;
    }
    work.row.ms = since(start);
    work.bsp = std::move(*bsp);
    work.row.map = work.map->name;
    work.row.stats = work.bsp->stats;
    work.row.nodes = work.bsp->nodes.size();
    work.row.sub_sectors = work.bsp->sub_sectors.size();
    if (command.check || command.stats) work.row.check = level::check_bsp(*work.map, *work.bsp);
    if (wish.point) work.row.place = place_of(*work.map, *work.bsp, *wish.point);
    if (wish.point || command.pvs) {
        Result<SightReport> sight = look_around(*work.map, *work.bsp, wish.sight, tasks);
        if (!sight) {
            work.error = sight.error();
            return;
        }
        work.row.sight = *std::move(sight);
    }
    if (command.all) work.map->things.clear();
}

Result<void> draw(const LevelCommand& command, const Wish& wish, const Work& work) {
    level::PlanLook look;
    look.title = work.row.map;
    look.note =
        fmt::format("{} lines, {} segs (+{:.1f} %), {} nodes, {} sub-sectors, depth {:.1f} mean, {} worst",
                    work.row.stats.lines, work.row.stats.wall_segs, 100 * share_of_splits(work.row.stats),
                    work.row.nodes, work.row.sub_sectors, work.row.stats.mean_depth, work.row.stats.worst_depth);
    look.eye = wish.point;
    if (work.row.sight) {
        look.seen = work.row.sight->from_cell;
        if (const auto& seen = work.row.sight->from_point) {
            if (!command.pvs) look.seen = seen->sub_sectors;
            for (std::size_t i = 0, first = 0; i < seen->part_ends.size(); first = seen->part_ends[i++])
                look.sight.emplace_back(seen->corners.begin() + static_cast<std::ptrdiff_t>(first),
                                        seen->corners.begin() + static_cast<std::ptrdiff_t>(seen->part_ends[i]));
        }
    }
    const level::Drawing drawing = level::draw_plan(*work.map, *work.bsp, look);
    if (!command.svg.empty()) {
        const std::string svg = level::svg_of(drawing);
        if (auto written = write_file(command.svg, std::as_bytes(std::span(svg))); !written) return written;
    }
    if (command.png.empty()) return {};
    level::Pixels pixels = level::pixels_of(drawing, 2);
    atlas::Image image;
    image.size = {pixels.width, pixels.height};
    image.pixels = std::move(pixels.rgba);
    const auto png = atlas::write_png(image);
    return png ? write_file(command.png, *png) : png.error();
}

Result<void> write_wad(const LevelCommand& command, const Wish& wish, Wad& wad, const std::vector<Work>& works) {
    for (std::size_t i = works.size(); i-- > 0;) {  // from behind, for lumps may be added
        if (!works[i].bsp) continue;
        auto written = level::write_bsp(wad, works[i].marker, command.file, *works[i].map, *works[i].bsp, wish.lumps);
        if (!written) return written;
    }
    const auto bytes = wad.packed();
    return bytes ? write_file(command.output, *bytes) : bytes.error();
}

Result<int> work_on(const LevelCommand& command) {
    const Result<Wish> wish = wish_of(command);
    if (!wish) return wish.error();
    for (const std::string* file : {&command.output, &command.svg, &command.png})
        if (!file->empty())
            if (auto writable = check_output(*file, command.file); !writable) return writable.error();
    Result<Wad> wad = Wad::read(command.file);
    if (!wad) return wad.error();
    const Result<std::vector<std::size_t>> markers = markers_of(command, *wad);
    if (!markers) return markers.error();

    const auto start = std::chrono::steady_clock::now();
    std::vector<Work> works(markers->size());
    for (std::size_t i = 0; i < works.size(); ++i) works[i].marker = (*markers)[i];
    const auto tasks = make_thread_runner(command.threads);
    tasks->run(works.size(), [&](std::size_t i) {
        const StandardFloats floats;
        compile(command, *wish, *wad, *tasks, works[i]);
    });
    const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    std::vector<LevelRow> rows;
    for (Work& work : works) {
        if (work.error && !(command.all && work.error->status == Status::Unsupported)) return *work.error;
        if (work.error) {
            work.row.map = wad->lumps[work.marker].name;
            work.row.note = work.error->problem;
        }
        rows.push_back(work.row);
    }
    if (auto drawn = command.svg.empty() && command.png.empty() ? Result<void>{} : draw(command, *wish, works[0]);
        !drawn)
        return drawn.error();
    if (!command.output.empty())
        if (auto written = write_wad(command, *wish, *wad, works); !written) return written.error();
    const std::string text = command.json ? to_json(rows, command.all) : to_text(rows, command.all, ms);
    std::fwrite(text.data(), 1, text.size(), stdout);
    const bool hidden = std::any_of(rows.begin(), rows.end(),
                                    [](const LevelRow& row) { return row.sight && row.sight->falsely_hidden > 0; });
    return hidden || (command.check && !all_good(rows)) ? exit_check_failed : exit_ok;
}

/// What of the command there is for meshes.
int run_mesh(const LevelCommand& command) {
    const std::pair<const char*, bool> no_mesh[] = {{"MAP", !command.map.empty()},
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
                                                    {"--check", command.check}};
    for (const auto& [option, given] : no_mesh)
        if (given) return refuse({Status::BadArgument, option, "found a mesh, need a WAD", {}});
    return run_level_mesh({command.file, command.point, command.rays, command.threads, command.json});
}

}  // namespace

int run_level(const LevelCommand& command) {
    try {
        if (is_mesh_name(command.file)) return run_mesh(command);
        const Result<int> code = work_on(command);
        return code ? *code : refuse(code.error());
    } catch (const std::bad_alloc&) {
        return refuse({Status::NoMemory, command.file, "found too little memory for its maps", {}});
    }
}

void add_level(CLI::App& app, Start& start) {
    auto& options = start.options<LevelCommand>();
    CLI::App& command = *app.add_subcommand("level", "Compile a level of a Doom WAD into a BSP tree");
    add_text(command, "FILE", "A .wad file; or a mesh (.obj, .gltf, .glb), for a tree of planes over its triangles",
             options.file)
        ->required();
    add_text(command, "MAP", "E1M1, MAP01 …; may be left out when the file has one", options.map);
    command.add_flag("--all", options.all, "Every map of the file");
    add_text(command, "-o,--output", "Write the WAD with the new trees", options.output);
    command.add_flag("--gl", options.gl, "Write GL nodes too");
    command.add_flag("--extended", options.extended, "Write nodes of 32 bits (XNOD, and with --gl XGLN)");
    add_text(command, "--weight", "Price of a cut, from 0 (even trees) on; default 1", options.weight);
    add_text(command, "--effort", "quick, normal (default) or thorough", options.effort);
    add_text(command, "--svg", "Draw the plan", options.svg);
    add_text(command, "--png", "Draw the plan as pixels", options.png);
    add_text(
        command, "--point",
        "X,Y: tell the sub-sector and sector there and what they see; lit on the plan. Of a mesh X,Y,Z: is it solid?",
        options.point);
    add_text(command, "--lumps", "nodes or gl: read the tree that is in the file instead of making one", options.lumps);
    command.add_flag("--pvs", options.pvs, "Find what sub-sectors see of each other");
    command.add_flag("--heights", options.heights, "Floors, ceilings and closed doors hide, too");
    add_whole_number(command, "--rays", "With --pvs, or of a mesh: cast rays at random, and check what they meet", 1,
                     100'000'000, options.rays);
    command.add_flag("--stats", options.stats, "Tell more: minisegs, areas, how exact all is");
    command.add_flag("--check", options.check,
                     "Hold the tree against the map: sub-sectors convex, lines covered, areas");
    add_threads(command, "Maps compiled at once (default: as many as there are cores)", 1, options.threads);
    add_json(command, options.json);
    command.footer(
        "\nExamples:\n"
        "  fase level freedoom1.wad E1M1 --svg e1m1.svg --stats\n"
        "  fase level freedoom2.wad --all -o compiled.wad --gl\n"
        "  fase level map.wad --weight 0 --effort thorough --json\n"
        "  fase level compiled.wad MAP01 --lumps gl --check\n"
        "  fase level freedoom1.wad E1M1 --pvs --rays 1000000 --point 1056,-3616 --svg seen.svg\n"
        "  fase level house.obj --rays 100000\n"
        "\nSegs are counted as in the classic lumps; splits are segs less sides of lines. Depth: nodes above a\n"
        "sub-sector. The time is that of compiling, without reading and writing.\n"
        "Exit code 1: --check found a tree that is not what it should be, or rays prove something wrong.");
    start.on(command, [&options] { return run_level(options); });
}

}  // namespace fase::cli
