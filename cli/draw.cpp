/// The command `fase draw`: pictures of the cells in which structures keep the boxes of a trace.
#include "cli/draw.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <new>
#include <optional>
#include <vector>

#include "cli/common/arguments.hpp"
#include "cli/common/output.hpp"
#include "cli/common/start.hpp"
#include "fase/broad/any_structure.hpp"
#include "fase/record/box_picture.hpp"
#include "fase/record/recording/output_file.hpp"
#include "fase/record/trace.hpp"

namespace fase::cli {
namespace {

using broad::AnyStructure;
using broad::Move;
using broad::Proxy;
using record::BoxKind;
using record::Seen;

/// A picture to be made.
struct Job {
    std::string structure, file;
};

/// A structure that lives through the frames of a trace.
struct Life {
    AnyStructure structure;
    std::vector<Aabb> boxes;
    std::vector<std::uint8_t> moved;  ///< by body: since the first frame
};

Result<Seen> plane_named(const std::string& name) {
    if (name.empty() || name == "xz") return Seen::FromAbove;
    if (name == "xy") return Seen::FromFront;
    if (name == "yz") return Seen::FromSide;
    return Error{
        Status::BadArgument, "--plane", fmt::format("found \"{}\", need xz, xy or yz", printable(name, 40)), {}};
}

Result<std::vector<Job>> jobs_of(const DrawOptions& options) {
    std::error_code no_matter;
    const bool into_folder = std::filesystem::is_directory(options.output, no_matter);
    const bool all = options.structure == "all";
    std::vector<std::string> names;
    if (all) {
        broad::for_each_structure([&]<broad::Structure S>() { names.emplace_back(S::info.name); });
    } else {
        const bool by_default = options.structure.empty() || options.structure == "auto";
        const std::string name = by_default ? std::string(broad::default_structure) : options.structure;
        if (const auto known = AnyStructure::named(name); !known) {
            Error error = known.error();
            error.where = "--structure";
            return error;
        }
        names.push_back(name);
    }
    if (all && !into_folder)
        return Error{
            Status::BadArgument, options.output, "found no folder, need one that exists for all structures", {}};
    std::vector<Job> jobs;
    for (const std::string& name : names) {
        const std::string file =
            into_folder ? (std::filesystem::path(options.output) / (name + ".svg")).string() : options.output;
        if (!file.ends_with(".svg"))
            return Error{Status::BadArgument, file, "found another ending, need .svg or a folder", {}};
        if (auto writable = check_output(file, options.trace); !writable) return writable.error();
        jobs.push_back({name, file});
    }
    return jobs;
}

/// Goes through the frames of the trace from the first to the wanted one.
Result<void> live(Life& life, record::TraceReader& trace, std::uint32_t last_frame) {
    trace.rewind();
    if (auto read = trace.next(life.boxes); !read) return read.error();
    std::vector<Move> moves;
    std::vector<Proxy> resting;
    for (Proxy p = 0; p < life.boxes.size(); ++p) {
        moves.push_back({p, life.boxes[p]});
        if (trace.flags()[p] != 0) resting.push_back(p);
    }
    life.moved.assign(life.boxes.size(), 0);
    life.structure.build(moves);
    life.structure.set_awake(resting, false);
    life.structure.commit();
    std::vector<Aabb> boxes;
    std::vector<Proxy>& roused = resting;
    for (std::uint32_t frame = 1; frame <= last_frame; ++frame) {
        if (auto read = trace.next(boxes); !read) return read.error();
        moves.clear();
        roused.clear();
        for (Proxy p = 0; p < boxes.size(); ++p) {
            if (boxes[p] == life.boxes[p]) continue;
            moves.push_back({p, boxes[p]});
            if (life.moved[p] == 0) roused.push_back(p);
            life.moved[p] = 1;
        }
        life.structure.set_awake(roused, true);
        life.structure.move(moves);
        life.structure.commit();
        life.boxes.swap(boxes);
    }
    return {};
}

std::string picture_of(const Life& life, std::span<const std::uint8_t> flags, Seen seen, const std::string& view) {
    std::vector<record::PicturedBox> boxes;
    for (std::size_t i = 0; i < life.boxes.size(); ++i) {
        const bool rests = (flags[i] & record::trace_asleep) != 0 && life.moved[i] == 0;
        boxes.push_back({life.boxes[i], (flags[i] & record::trace_static) != 0 ? BoxKind::Static
                                        : rests                                ? BoxKind::Resting
                                                                               : BoxKind::Awake});
    }
    std::vector<broad::DrawnCell> cells;
    life.structure.cells(cells);
    const broad::StructureStats stats = life.structure.stats();
    const std::string note = fmt::format("{} boxes, {} node{}, {} lea{}, depth {}, {:.1f} boxes a leaf; {}",
                                         stats.boxes, stats.nodes, stats.nodes == 1 ? "" : "s", stats.leaves,
                                         stats.leaves == 1 ? "f" : "ves", stats.depth, stats.occupancy(), view);
    return record::svg_of({std::string(life.structure.info().name), note, seen, boxes, cells});
}

Result<void> write_text(const std::string& file, const std::string& text) {
    auto out = record::OutputFile::create(file);
    if (!out) return out.error();
    if (auto written = out->append(std::as_bytes(std::span(text))); !written) return written;
    return out->complete(false);
}

Result<void> draw(const DrawOptions& options) {
    const Result<Seen> seen = plane_named(options.plane);
    if (!seen) return seen.error();
    const Result<std::vector<Job>> jobs = jobs_of(options);
    if (!jobs) return jobs.error();
    auto trace = record::TraceReader::open(options.trace);
    if (!trace) return trace.error();
    if (options.frame >= trace->frames())
        return Error{Status::BadArgument, "--frame",
                     fmt::format("found {}, need 0 to {}", options.frame, trace->frames() - 1),
                     fmt::format("{} has {} frames", printable(options.trace), trace->frames())};
    const std::string view =
        fmt::format("plane {}, frame {}", options.plane.empty() ? "xz" : options.plane, options.frame);
    for (const Job& job : *jobs) {
        Life life{*AnyStructure::named(job.structure), {}, {}};
        if (auto lived = live(life, *trace, options.frame); !lived) return lived;
        const std::string svg = picture_of(life, trace->flags(), *seen, view);
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
        return refuse({Status::NoMemory, options.trace, "found too little memory for its boxes", {}});
    }
}

void add_draw(CLI::App& app, Start& start) {
    auto& options = start.options<DrawOptions>();
    CLI::App& command = *app.add_subcommand("draw", "Draw the cells in which a structure keeps the boxes of a trace");
    add_text(command, "TRACE", "An .aabt file", options.trace)->required();
    add_structure(command, "auto (default), all (into a folder), ", options.structure);
    add_text(command, "--plane", "xz (default: seen from above), xy or yz", options.plane);
    add_whole_number(command, "--frame", "Which frame, from 0 (default); the structure lives through those before", 0,
                     0xffffffff, options.frame);
    add_text(command, "-o,--output", "The .svg file to write, or a folder for NAME.svg", options.output)->required();
    command.footer(
        "\nExamples:\n"
        "  fase draw boxes.aabt --structure kd_tree -o kd_tree.svg\n"
        "  fase draw boxes.aabt --structure all --plane xy --frame 30 -o pictures\n"
        "\nBoxes: awake, resting or static, by their colour. Lines: cells, the deeper the paler.\n"
        "Structures that have no cells show their boxes. Some 80 bytes a box: pictures of up to a few thousand are "
        "clear.");
    start.on(command, [&options] { return run_draw(options); });
}

}  // namespace fase::cli
