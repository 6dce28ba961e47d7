/// The command `fase draw`: draws the cells in which structures keep the boxes of a trace.
#include "cli/draw.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <new>
#include <optional>
#include <vector>

#include "cli/common/arguments.hpp"
#include "cli/common/command_registry.hpp"
#include "cli/common/input.hpp"
#include "cli/common/output.hpp"
#include "cli/common/structure_choice.hpp"
#include "fase/broad/any_structure.hpp"
#include "fase/broad/registry.hpp"
#include "fase/core/detail/files.hpp"
#include "fase/record/box_picture.hpp"
#include "fase/record/trace.hpp"

namespace fase::cli {
namespace {

using broad::AnyStructure;
using broad::Move;
using broad::Proxy;
using record::BoxKind;
using record::View;

/// A picture to draw.
struct Job {
    std::string structure, file;
};

/// A structure that is updated through the frames of a trace.
struct Replay {
    AnyStructure structure;
    std::vector<Aabb> boxes;
    std::vector<std::uint8_t> moved;  ///< by box: 1 if it moved since the first frame
};

Result<View> plane_named(const std::string& name) {
    if (name.empty() || name == "xz") return View::FromAbove;
    if (name == "xy") return View::FromFront;
    if (name == "yz") return View::FromSide;
    return Error{
        Status::BadArgument, "--plane", fmt::format("found \"{}\"; expected xz, xy or yz", printable(name, 40)), {}};
}

Result<std::vector<Job>> jobs_of(const DrawOptions& options) {
    std::error_code ignored;
    const bool all = options.structure == "all", is_file_name = has_extension(options.output, output::drawing);
    const bool into_folder = std::filesystem::is_directory(options.output, ignored) || options.output.ends_with('/') ||
                             (all && !is_file_name);
    std::vector<std::string> names;
    if (all) {
        broad::for_each_structure([&]<broad::Structure S>() { names.emplace_back(S::info.name); });
    } else {
        const bool use_default = options.structure.empty() || options.structure == "auto";
        const std::string name = use_default ? std::string(broad::default_structure) : options.structure;
        if (const auto known = AnyStructure::named(name); !known) {
            Error error = known.error();
            error.where = "--structure";
            return error;
        }
        names.push_back(name);
    }
    if (all && !into_folder)
        return Error{Status::BadArgument, options.output, "found a file; expected a folder for all structures", {}};
    std::vector<Job> jobs;
    for (const std::string& name : names) {
        const std::string file =
            into_folder ? (std::filesystem::path(options.output) / (name + ".svg")).string() : options.output;
        if (auto checked = check_output(file, {output::drawing}, options.trace); !checked) return checked.error();
        jobs.push_back({name, file});
    }
    return jobs;
}

/// Updates the structure from the first frame of the trace to `last_frame`.
Result<void> play(Replay& replay, record::TraceReader& trace, std::uint32_t last_frame) {
    trace.rewind();
    if (auto read = trace.next(replay.boxes); !read) return read.error();
    std::vector<Move> moves;
    std::vector<Proxy> resting;
    for (Proxy p = 0; p < replay.boxes.size(); ++p) {
        moves.push_back({p, replay.boxes[p]});
        if (trace.flags()[p] != 0) resting.push_back(p);
    }
    replay.moved.assign(replay.boxes.size(), 0);
    replay.structure.build(moves);
    replay.structure.set_awake(resting, false);
    replay.structure.commit();
    std::vector<Aabb> boxes;
    std::vector<Proxy>& woken = resting;  // reuses the memory
    for (std::uint32_t frame = 1; frame <= last_frame; ++frame) {
        if (auto read = trace.next(boxes); !read) return read.error();
        moves.clear();
        woken.clear();
        for (Proxy p = 0; p < boxes.size(); ++p) {
            if (boxes[p] == replay.boxes[p]) continue;
            moves.push_back({p, boxes[p]});
            if (replay.moved[p] == 0) woken.push_back(p);
            replay.moved[p] = 1;
        }
        replay.structure.set_awake(woken, true);
        replay.structure.move(moves);
        replay.structure.commit();
        replay.boxes.swap(boxes);
    }
    return {};
}

std::string picture_of(const Replay& replay, std::span<const std::uint8_t> flags, View view,
                       const std::string& subtitle) {
    std::vector<record::PicturedBox> boxes;
    for (std::size_t i = 0; i < replay.boxes.size(); ++i) {
        const bool rests = (flags[i] & record::trace_asleep) != 0 && replay.moved[i] == 0;
        boxes.push_back({replay.boxes[i], (flags[i] & record::trace_static) != 0 ? BoxKind::Static
                                          : rests                                ? BoxKind::Resting
                                                                                 : BoxKind::Awake});
    }
    std::vector<broad::DrawnCell> cells;
    replay.structure.cells(cells);
    const broad::StructureStats stats = replay.structure.stats();
    const std::string note = fmt::format("{} boxes, {} node{}, {} lea{}, depth {}, {:.1f} boxes per leaf; {}",
                                         stats.boxes, stats.nodes, stats.nodes == 1 ? "" : "s", stats.leaves,
                                         stats.leaves == 1 ? "f" : "ves", stats.depth, stats.occupancy(), subtitle);
    return record::svg_of({std::string(replay.structure.info().name), note, view, boxes, cells});
}

Result<void> write_text(const std::string& file, const std::string& text) {
    if (auto made = make_folder_of(file); !made) return made;
    return write_file(file, std::as_bytes(std::span(text)));
}

Result<void> draw(const DrawOptions& options) {
    const Result<View> view = plane_named(options.plane);
    if (!view) return view.error();
    const Result<std::vector<Job>> jobs = jobs_of(options);
    if (!jobs) return jobs.error();
    if (auto checked = check_input(options.trace, {"draw", input::traces, input::trace_kinds}); !checked)
        return checked.error();
    auto trace = record::TraceReader::open(options.trace);
    if (!trace) return trace.error();
    if (options.frame >= trace->frames())
        return Error{Status::BadArgument, "--frame",
                     fmt::format("found {}; expected 0 to {}", options.frame, trace->frames() - 1),
                     fmt::format("{} has {} frames", printable(options.trace), trace->frames())};
    const std::string subtitle =
        fmt::format("plane {}, frame {}", options.plane.empty() ? "xz" : options.plane, options.frame);
    for (const Job& job : *jobs) {
        Replay replay{*AnyStructure::named(job.structure), {}, {}};
        if (auto played = play(replay, *trace, options.frame); !played) return played;
        const std::string svg = picture_of(replay, trace->flags(), *view, subtitle);
        if (auto written = write_text(job.file, svg); !written) return written;
        fmt::print("{}: {}, {} bytes\n", printable(job.file), job.structure, svg.size());
    }
    return {};
}

}  // namespace

int run_draw(const DrawOptions& options) {
    try {
        const Result<void> drawn = draw(options);
        return drawn ? exit_ok : refuse(drawn.error());
    } catch (const std::bad_alloc&) {
        return refuse({Status::NoMemory, options.trace, "found too little memory for the boxes", {}});
    }
}

void add_draw(Command& program, CommandRegistry& registry) {
    auto& options = registry.options<DrawOptions>();
    Command command = program.add_command("draw", "Draw the cells in which a structure keeps the boxes of a trace");
    command.add_text("TRACE", "An .aabt file", options.trace).required();
    add_structure(command, "auto (default), all (into a folder), ", options.structure);
    command.add_text("--plane", "xz (default: seen from above), xy or yz", options.plane);
    command.add_whole_number("--frame",
                             "Which frame, from 0 (default); the structure is updated through all frames before it", 0,
                             0xffffffff, options.frame);
    command.add_text("-o,--output", "The .svg file to write, or a folder (FOLDER/) for NAME.svg", options.output)
        .required();
    command.set_footer(
        "\nExamples:\n"
        "  fase draw boxes.aabt --structure kd_tree -o kd_tree.svg\n"
        "  fase draw boxes.aabt --structure all --plane xy --frame 30 -o pictures\n"
        "\nThe colour of a box shows whether it is awake, resting or static. Lines are cells; deeper cells are paler.\n"
        "A structure without cells shows only its boxes. A box takes about 80 bytes; pictures of up to a few\n"
        "thousand boxes are readable.");
    registry.on(command, [&options] { return run_draw(options); });
}

}  // namespace fase::cli
