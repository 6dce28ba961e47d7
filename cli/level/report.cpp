/// The output of `fase level` for maps.
#include "cli/level/report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/common/output.hpp"
#include "cli/common/table.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase::cli {
namespace {

std::string json_of(const LevelRow& row) {
    const level::BspStats& s = row.stats;
    std::string text = fmt::format("{{\"map\": {}", scene::quoted(row.map));
    if (!row.note.empty()) return text + fmt::format(", \"note\": {}}}", scene::quoted(row.note));
    text += fmt::format(
        ", \"lines\": {}, \"segs\": {}, \"splits\": {}, \"nodes\": {}, \"subsectors\": {}, \"mean_depth\": {:.6g}, "
        "\"worst_depth\": {}, \"ms\": {:.3f}, \"sides\": {}, \"minisegs\": {}",
        s.lines, s.wall_segs, s.splits, row.nodes, row.sub_sectors, s.mean_depth, s.worst_depth, row.ms, s.sides,
        s.minisegs);
    if (row.check) {
        text += fmt::format(
            ", \"checked\": {}, \"bulge\": {:.3g}, \"area_error\": {:.3g}, \"gaps\": {:.3g}, \"open_sectors\": {}",
            is_good(row), row.check->bulge, row.check->area_error, row.check->gaps, row.check->open_sectors);
    }
    if (const auto& place = row.place) {
        text += fmt::format(
            ", \"point\": {{\"x\": {}, \"y\": {}, \"inside\": {}, \"subsector\": {}, \"sector\": {}, \"floor\": {}, "
            "\"ceiling\": {}}}",
            place->point.x, place->point.y, place->inside, place->sub_sector, place->sector, place->floor,
            place->ceiling);
    }
    if (row.sight) text += to_json(*row.sight);
    return text + "}";
}

std::string text_of_check(const LevelRow& row) {
    const level::BspCheck& c = *row.check;
    return fmt::format(
        "  {}: walls protrude from sub-sectors by {:.2g} units, from nodes by {:.2g}, from boxes by {:.2g}\n"
        "  lines: {:.3g} units not covered, {:.3g} covered twice; areas of sectors within {:.2g} (worst: sector {}){}\n"
        "  {} sub-sectors with walls of several sectors, {} openings to no sub-sector\n",
        is_good(row) ? "right" : "WRONG", c.bulge, c.outside_node, c.outside_box, c.gaps, c.overlaps, c.area_error,
        c.worst_sector, c.open_sectors == 0 ? "" : fmt::format(", {} sectors not closed", c.open_sectors), c.mixed,
        c.openings);
}

std::string text_of(const LevelRow& row) {
    const level::BspStats& s = row.stats;
    std::string text = fmt::format(
        "{}: {} lines, {} segs ({} splits, +{:.1f} %), {} nodes, {} sub-sectors, depth {:.2f} mean, {} worst, {:.1f} "
        "ms\n",
        printable(row.map), s.lines, s.wall_segs, s.splits, 100 * share_of_splits(s), row.nodes, row.sub_sectors,
        s.mean_depth, s.worst_depth, row.ms);
    if (row.check) text += fmt::format("  {} minisegs\n", s.minisegs) + text_of_check(row);
    if (const auto& place = row.place) {
        text += fmt::format("  ({:g}, {:g}): {} sub-sector {} of sector {}, floor {}, ceiling {}\n", place->point.x,
                            place->point.y, place->inside ? "in" : "outside, behind a wall of", place->sub_sector,
                            place->sector, place->floor, place->ceiling);
    }
    if (row.sight) text += to_text(*row.sight);
    return text;
}

}  // namespace

PlanPlace place_of(const level::Map& map, const level::LevelBsp& bsp, level::Point point) {
    std::uint32_t child = bsp.root();
    while ((child & level::Node::leaf_bit) == 0) {
        const level::Node& node = bsp.nodes[child];
        child = node.children[level::side_of(node, point)];
    }
    PlanPlace place{point, child & ~level::Node::leaf_bit, 0, 0, 0, true};
    const level::SubSector& s = bsp.sub_sectors[place.sub_sector];
    place.sector = s.sector;
    place.floor = map.sectors[s.sector].floor;
    place.ceiling = map.sectors[s.sector].ceiling;
    for (std::uint32_t i = s.first; i < s.first + s.edges + s.outliers; ++i) {
        const level::Point a = bsp.vertices[bsp.segs[i].from], b = bsp.vertices[bsp.segs[i].to];
        if ((b.x - a.x) * (point.y - a.y) - (b.y - a.y) * (point.x - a.x) > 1e-6) place.inside = false;
    }
    return place;
}

double share_of_splits(const level::BspStats& stats) {
    return stats.sides == 0 ? 0 : static_cast<double>(stats.splits) / static_cast<double>(stats.sides);
}

bool is_good(const LevelRow& row) {
    if (!row.check) return true;
    const level::BspCheck& c = *row.check;
    const bool rounded = c.bulge > 1e-3;  // split points in the file are integers
    return c.bulge <= 2 && c.outside_node <= 2 && c.outside_box <= 2 && c.open_loops == 0 && c.wrong_partners == 0 &&
           (rounded || c.area_error <= 1e-4);
}

bool all_good(const std::vector<LevelRow>& rows) { return std::all_of(rows.begin(), rows.end(), is_good); }

std::string to_json(const std::vector<LevelRow>& rows, bool all) {
    if (!all) return json_of(rows.front()) + "\n";
    std::string text = "[";
    for (const LevelRow& row : rows) text += (text.size() == 1 ? "\n" : ",\n") + json_of(row);
    return text + "\n]\n";
}

std::string to_text(const std::vector<LevelRow>& rows, bool all, double ms) {
    if (!all) return text_of(rows.front());
    Table table({"map", "lines", "segs", "splits", "%", "nodes", "sub-sectors", "mean depth", "worst", "ms", "check"});
    LevelRow sum;
    double depth = 0;
    const auto add = [&](const LevelRow& row, std::string_view check) {
        const level::BspStats& s = row.stats;
        table.add({printable(row.map), std::to_string(s.lines), std::to_string(s.wall_segs), std::to_string(s.splits),
                   fmt::format("{:.1f}", 100 * share_of_splits(s)), std::to_string(row.nodes),
                   std::to_string(row.sub_sectors), fmt::format("{:.2f}", s.mean_depth), std::to_string(s.worst_depth),
                   fmt::format("{:.1f}", row.ms), std::string(check)});
    };
    for (const LevelRow& row : rows) {
        if (!row.note.empty()) {
            table.add_note(printable(row.map), row.note);
            continue;
        }
        add(row, !row.check ? "-" : is_good(row) ? "ok" : "WRONG");
        sum.stats.lines += row.stats.lines;
        sum.stats.sides += row.stats.sides;
        sum.stats.wall_segs += row.stats.wall_segs;
        sum.stats.splits += row.stats.splits;
        sum.stats.worst_depth = std::max(sum.stats.worst_depth, row.stats.worst_depth);
        sum.nodes += row.nodes;
        sum.sub_sectors += row.sub_sectors;
        sum.ms += row.ms;
        depth += row.stats.mean_depth * static_cast<double>(row.sub_sectors);
    }
    sum.map = "all";
    sum.stats.mean_depth = sum.sub_sectors == 0 ? 0 : depth / static_cast<double>(sum.sub_sectors);
    add(sum, "");
    std::string visibility;
    for (const LevelRow& row : rows)
        if (row.sight) visibility += printable(row.map) + "\n" + to_text(*row.sight);
    return table.text() + visibility +
           fmt::format("{} map{} in {:.0f} ms\n", rows.size(), rows.size() == 1 ? "" : "s", ms);
}

}  // namespace fase::cli
