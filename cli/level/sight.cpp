/// Visibility in a level: from a point, and between sub-sectors.
#include "cli/level/sight.hpp"

#include <fmt/format.h>

#include "cli/common/clock.hpp"
#include "fase/core/random.hpp"
#include "fase/level/level_place.hpp"

namespace fase::cli {
namespace {

constexpr double eye_height = 41;  // map units, as in Doom

/// Casts rays from random points of the level and counts sub-sectors that they reach although the sets call them
/// hidden.
void check_with_rays(const level::Map& map, const level::LevelBsp& bsp, const level::VisibleSets& sets,
                     const SightOptions& options, SightReport& report, TaskRunner& tasks) {
    level::PlanBox box;
    for (const level::SubSector& s : bsp.sub_sectors)
        for (const level::Seg& seg : bsp.edges(s)) box.add(bsp.vertices[seg.from]);
    struct Sum {
        std::uint64_t rays = 0, passages = 0, hidden = 0;
    };
    constexpr std::size_t grain = 4096;
    std::vector<Sum> sums((options.rays + grain - 1) / grain);
    parallel_ranges(tasks, options.rays, grain, [&](std::size_t begin, std::size_t end) {
        Random random(1, begin);
        Sum& sum = sums[begin / grain];
        std::vector<level::Passage> passages;
        constexpr std::size_t tries = 1000;  // to find a point inside
        for (std::size_t left = (end - begin) * tries; left > 0 && sum.rays < end - begin; --left) {
            const level::Point from{box.lo.x + (box.hi.x - box.lo.x) * double(random.unit()),
                                    box.lo.y + (box.hi.y - box.lo.y) * double(random.unit())};
            const auto cell = level::sub_sector_at(bsp, from);
            if (!cell) continue;
            const level::Opening room = level::opening_of(map, bsp.sub_sectors[*cell].sector);
            const double z = room.floor + (room.ceiling - room.floor) * double(random.unit());
            const level::Point direction{double(random.between(-1, 1)), double(random.between(-1, 1))};
            passages.clear();
            level::passages(bsp, map, {from, z, direction, double(random.between(-0.3f, 0.3f))}, options.heights,
                            passages);
            ++sum.rays;
            sum.passages += passages.size();
            for (const level::Passage& passage : passages) sum.hidden += sets.sees(*cell, passage.sub_sector) ? 0 : 1;
        }
    });
    for (const Sum& sum : sums) {
        report.rays += sum.rays;
        report.passages += sum.passages;
        report.falsely_hidden += sum.hidden;
    }
}

double share_of(const level::VisibleStats& s) {
    return double(s.pairs) / (double(s.sub_sectors) * double(s.sub_sectors));
}

}  // namespace

Result<SightReport> look_around(const level::Map& map, const level::LevelBsp& bsp, const SightOptions& options,
                                TaskRunner& tasks) {
    SightReport report;
    std::optional<std::uint32_t> cell;
    if (options.point) {
        cell = level::sub_sector_at(bsp, *options.point);
        const double floor = cell ? level::opening_of(map, bsp.sub_sectors[*cell].sector).floor : 0;
        report.from_point = level::seen_from(bsp, map, {*options.point, floor + eye_height}, options.heights);
    }
    if (!options.sets) return report;
    const auto start = Clock::now();
    const Result<level::VisibleResult> found =
        level::find_visible(bsp, map, {.heights = options.heights, .tasks = &tasks});
    if (!found) return found.error();
    report.ms = ms_since(start);
    report.sets = found->stats;
    if (cell) found->sets.for_each_seen(*cell, [&](std::uint32_t s) { report.from_cell.push_back(s); });
    if (options.rays > 0) check_with_rays(map, bsp, found->sets, options, report, tasks);
    return report;
}

std::string to_json(const SightReport& report) {
    std::string text;
    if (const auto& seen = report.from_point) {
        text += fmt::format(", \"seen\": {{\"subsectors\": {}, \"area\": {:.9g}, \"complete\": {}}}",
                            seen->sub_sectors.size(), seen->area, seen->complete);
    }
    if (const auto& s = report.sets) {
        text += fmt::format(
            ", \"pvs\": {{\"pairs\": {}, \"share\": {:.6g}, \"bytes\": {}, \"openings\": {}, \"coarse\": {}, "
            "\"ms\": {:.3f}, \"rays\": {}, \"passages\": {}, \"false_hidden\": {}}}",
            s->pairs, share_of(*s), s->bytes, s->openings, s->coarse, report.ms, report.rays, report.passages,
            report.falsely_hidden);
    }
    return text;
}

std::string to_text(const SightReport& report) {
    std::string text;
    if (const auto& seen = report.from_point) {
        text += fmt::format("  sees parts of {} sub-sectors, {:.0f} square units of floor{}\n",
                            seen->sub_sectors.size(), seen->area, seen->complete ? "" : " at least");
    }
    if (const auto& s = report.sets) {
        text += fmt::format("  visible sets: {} of {} pairs ({:.1f} %), {} bytes, {} openings, {:.0f} ms{}\n", s->pairs,
                            s->sub_sectors * s->sub_sectors, 100 * share_of(*s), s->bytes, s->openings, report.ms,
                            s->coarse == 0 ? "" : fmt::format(", {} of them coarse", s->coarse));
        if (report.rays > 0) {
            text += fmt::format("  {} sight rays through {} sub-sectors: {} falsely hidden\n", report.rays,
                                report.passages, report.falsely_hidden);
        }
    }
    return text;
}

}  // namespace fase::cli
