/// Compiles maps drawn by hand, random maps, and maps of level designers.
#include "fase/level/bsp_compiler.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "fase/core/tasks.hpp"
#include "fase/level/bsp_lumps.hpp"
#include "fase/level/check_bsp.hpp"
#include "tests/level/drawn_maps.hpp"

namespace fase::level {
namespace {

constexpr std::array<Effort, 3> efforts{Effort::Quick, Effort::Normal, Effort::Thorough};

LevelBsp compiled(const Map& map, const CompileOptions& options = {}) {
    auto bsp = compile(map, options);
    EXPECT_TRUE(bsp) << bsp.error().text();
    return bsp ? *std::move(bsp) : LevelBsp{};
}

/// Checks the properties of every tree, also of malformed maps.
void expect_sound(const Map& map, const LevelBsp& bsp, const std::string& what) {
    ASSERT_FALSE(bsp.sub_sectors.empty()) << what;
    // Every seg is in exactly one sub-sector: the ranges are contiguous.
    std::uint32_t next = 0;
    for (std::uint32_t i = 0; i < bsp.sub_sectors.size(); ++i) {
        const SubSector& s = bsp.sub_sectors[i];
        EXPECT_EQ(s.first, next) << what;
        EXPECT_GE(s.edges, 3u) << what;
        EXPECT_LT(s.sector, map.sectors.size()) << what;
        next += s.edges + s.outliers;
        for (std::uint32_t k = s.first; k < next; ++k) EXPECT_EQ(bsp.segs[k].sub_sector, i) << what;
    }
    EXPECT_EQ(next, bsp.segs.size()) << what;
    // Children are before their parents, and each is a child exactly once.
    std::vector<int> nodes(bsp.nodes.size()), leaves(bsp.sub_sectors.size());
    for (std::size_t n = 0; n < bsp.nodes.size(); ++n) {
        for (const std::uint32_t child : bsp.nodes[n].children) {
            const std::uint32_t index = child & ~Node::leaf_bit;
            if ((child & Node::leaf_bit) != 0) {
                ASSERT_LT(index, leaves.size()) << what;
                ++leaves[index];
            } else {
                ASSERT_LT(index, n) << what;
                ++nodes[index];
            }
        }
    }
    for (std::size_t n = 0; n + 1 < nodes.size(); ++n) EXPECT_EQ(nodes[n], 1) << what;
    for (const int parents : leaves) EXPECT_EQ(parents, bsp.nodes.empty() ? 0 : 1) << what;
    const BspCheck check = check_bsp(map, bsp);
    EXPECT_LT(check.bulge, 1e-4) << what;
    EXPECT_LT(check.outside_node, 1e-6) << what;
    EXPECT_LE(check.outside_box, 0) << what;
    EXPECT_LT(check.gaps, 1e-6) << what;
    EXPECT_LT(check.overlaps, 1e-6) << what;
    EXPECT_EQ(check.open_loops, 0u) << what;
    EXPECT_EQ(check.wrong_partners, 0u) << what;
}

/// Checks the properties of trees of well-formed maps.
void expect_right(const Map& map, const LevelBsp& bsp, const std::string& what) {
    expect_sound(map, bsp, what);
    const BspCheck check = check_bsp(map, bsp);
    EXPECT_LT(check.area_error, 1e-9) << what << ", sector " << check.worst_sector;
    EXPECT_EQ(check.open_sectors, 0u) << what;
    EXPECT_EQ(check.openings, 0u) << what;
    for (const SubSector& s : bsp.sub_sectors) EXPECT_EQ(s.outliers, 0u) << what;
}

/// Returns the sector around a point by its winding number; nullopt if there is none.
std::optional<std::uint32_t> sector_by_winding(const Map& map, Point p) {
    std::vector<int> turns(map.sectors.size());
    for (const Line& line : map.lines) {
        const Vertex a = map.vertices[line.from], b = map.vertices[line.to];
        if ((a.y <= p.y) == (b.y <= p.y)) continue;
        const double side = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
        if ((side > 0) != (b.y > a.y)) continue;  // crosses the ray to the west only
        const int turn = b.y > a.y ? 1 : -1;
        if (line.right != no_side) turns[map.sides[line.right].sector] += turn;
        if (line.left != no_side) turns[map.sides[line.left].sector] -= turn;
    }
    for (std::uint32_t i = 0; i < turns.size(); ++i)
        if (turns[i] != 0) return i;
    return std::nullopt;
}

double distance_to_lines(const Map& map, Point p) {
    double least = 1e30;
    for (const Line& line : map.lines) {
        const Vertex a = map.vertices[line.from], b = map.vertices[line.to];
        const double dx = b.x - a.x, dy = b.y - a.y;
        const double t = std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
        least = std::min(least, std::hypot(a.x + t * dx - p.x, a.y + t * dy - p.y));
    }
    return least;
}

/// Returns the sub-sector at a point by the tree.
const SubSector& sub_sector_at(const LevelBsp& bsp, Point p) {
    std::uint32_t child = bsp.root();
    while ((child & Node::leaf_bit) == 0) child = bsp.nodes[child].children[side_of(bsp.nodes[child], p)];
    return bsp.sub_sectors[child & ~Node::leaf_bit];
}
bool is_inside(const LevelBsp& bsp, const SubSector& s, Point p) {
    for (const Seg& seg : bsp.edges(s)) {
        const Point a = bsp.vertices[seg.from], b = bsp.vertices[seg.to];
        if ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) > 1e-9) return false;
    }
    return true;
}

void expect_right_sectors(const Map& map, const LevelBsp& bsp, int count, std::uint64_t seed) {
    PlanBox plan;
    for (const Line& line : map.lines) plan.add(bsp.vertices[line.from]);
    Random random(seed);
    int found = 0;
    for (int i = 0; i < count; ++i) {
        const auto between = [&](double lo, double hi) { return lo + (hi - lo) * random.unit(); };
        const Point p{between(plan.lo.x, plan.hi.x), between(plan.lo.y, plan.hi.y)};
        if (distance_to_lines(map, p) < 1e-3) continue;
        const SubSector& s = sub_sector_at(bsp, p);
        const auto expected = sector_by_winding(map, p);
        if (expected) {
            EXPECT_TRUE(is_inside(bsp, s, p)) << p.x << ", " << p.y;
            EXPECT_EQ(s.sector, *expected) << p.x << ", " << p.y;
            ++found;
        } else {
            EXPECT_FALSE(is_inside(bsp, s, p)) << p.x << ", " << p.y;
        }
    }
    EXPECT_GT(found, count / 20);
}

TEST(BspCompiler, KeepsAConvexRoomInOnePiece) {
    const Map map = room_map();
    const LevelBsp bsp = compiled(map);
    expect_right(map, bsp, "room");
    EXPECT_TRUE(bsp.nodes.empty());
    ASSERT_EQ(bsp.sub_sectors.size(), 1u);
    EXPECT_EQ(bsp.sub_sectors[0].edges, 4u);
    EXPECT_EQ(bsp.stats.wall_segs, 4u);
    EXPECT_EQ(bsp.stats.splits, 0u);
    EXPECT_EQ(bsp.stats.mean_depth, 0);
    for (const Seg& seg : bsp.segs) EXPECT_EQ(seg.partner, no_index);
}

TEST(BspCompiler, SplitsACornerOnceAndLinksTheHalves) {
    DrawnMap drawn;
    drawn.loop({{0, 0}, {0, 256}, {128, 256}, {128, 128}, {256, 128}, {256, 0}}, drawn.sector());
    const LevelBsp bsp = compiled(drawn.map);
    expect_right(drawn.map, bsp, "corner");
    EXPECT_EQ(bsp.nodes.size(), 1u);
    ASSERT_EQ(bsp.sub_sectors.size(), 2u);
    EXPECT_EQ(bsp.stats.splits, 1u);
    EXPECT_EQ(bsp.stats.minisegs, 2u);
    for (const Seg& seg : bsp.segs) {
        if (seg.line != no_index) continue;
        ASSERT_NE(seg.partner, no_index);
        EXPECT_NE(bsp.segs[seg.partner].sub_sector, seg.sub_sector);
    }
}

TEST(BspCompiler, StoresTheOffsetOfSegsOnTheirLine) {
    DrawnMap drawn;
    drawn.loop({{0, 0}, {0, 256}, {128, 256}, {128, 128}, {256, 128}, {256, 0}}, drawn.sector());
    const LevelBsp bsp = compiled(drawn.map);
    for (const Seg& seg : bsp.segs) {
        if (seg.line == no_index) continue;
        const Vertex begin = drawn.map.vertices[drawn.map.lines[seg.line].from];
        const Point from = bsp.vertices[seg.from];
        EXPECT_EQ(seg.offset, std::abs(from.x - begin.x) + std::abs(from.y - begin.y));
    }
}

TEST(BspCompiler, HandlesPillarsAndPools) {
    const Map map = pool_map();
    for (const Effort effort : efforts) {
        CompileOptions options;
        options.effort = effort;
        const LevelBsp bsp = compiled(map, options);
        expect_right(map, bsp, "pool");
        expect_right_sectors(map, bsp, 2000, 1);
    }
}

TEST(BspCompiler, FindsTheSectorOfEveryPointOfIrregularGrids) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        const Map map = grid_map(3 + static_cast<int>(seed % 5), 2 + static_cast<int>(seed), seed);
        const LevelBsp bsp = compiled(map);
        expect_right(map, bsp, "grid " + std::to_string(seed));
        expect_right_sectors(map, bsp, 500, seed);
    }
}

TEST(BspCompiler, SplitsLessIfSplitsCostMore) {
    const Map map = grid_map(24, 20, 7);
    std::size_t splits = 1u << 30;
    for (const double weight : {0.0, 1.0, 4.0}) {
        CompileOptions options;
        options.split_weight = weight;
        const LevelBsp bsp = compiled(map, options);
        expect_right(map, bsp, "weight");
        EXPECT_LT(bsp.stats.splits, splits);
        splits = bsp.stats.splits;
        EXPECT_GE(bsp.stats.mean_depth, std::log2(static_cast<double>(bsp.sub_sectors.size())) - 0.1);
    }
}

TEST(BspCompiler, ImprovesWithEffort) {
    const Map map = grid_map(24, 20, 3);
    double cost = 1e30;
    for (const Effort effort : efforts) {
        CompileOptions options;
        options.effort = effort;
        const LevelBsp bsp = compiled(map, options);
        const double now =
            bsp.stats.mean_depth * static_cast<double>(bsp.sub_sectors.size()) + static_cast<double>(bsp.stats.splits);
        EXPECT_LT(now, cost);
        cost = now;
    }
}

TEST(BspCompiler, MakesTheSameTreeOnEveryThread) {
    const Map map = grid_map(12, 12, 5);
    const auto bytes_of = [&] {
        Wad wad = wad_of(map);
        EXPECT_TRUE(write_bsp(wad, 0, "grid", map, compiled(map), {true, true}));
        return *wad.to_bytes();
    };
    const auto first = bytes_of();
    std::vector<std::vector<std::byte>> others(8);
    make_thread_runner(4)->run(others.size(), [&](std::size_t i) { others[i] = bytes_of(); });
    for (const auto& other : others) EXPECT_EQ(other, first);
}

TEST(BspCompiler, SkipsLinesOfZeroLength) {
    Map map = room_map();
    map.lines.push_back(map.lines[0]);
    map.lines.back().to = map.lines.back().from;
    const LevelBsp bsp = compiled(map);
    EXPECT_EQ(bsp.stats.lines, 4u);
    EXPECT_EQ(bsp.segs.size(), 4u);
}

TEST(BspCompiler, KeepsOverlappingLinesAsOutliers) {
    Map map = room_map();
    map.lines.push_back(map.lines[1]);  // a duplicate
    DrawnMap half;                      // and half of another line
    half.map = map;
    half.line({0, 32}, {0, 96}, 0);
    const LevelBsp bsp = compiled(half.map);
    expect_sound(half.map, bsp, "overlap");
    ASSERT_EQ(bsp.sub_sectors.size(), 1u);
    EXPECT_EQ(bsp.sub_sectors[0].edges, 4u);
    EXPECT_EQ(bsp.sub_sectors[0].outliers, 2u);
}

TEST(BspCompiler, SplitsAlongALineThatEndsInTheRoom) {
    DrawnMap drawn;
    const int room = drawn.sector();
    drawn.loop({{0, 0}, {0, 256}, {256, 256}, {256, 0}}, room);
    drawn.line({64, 64}, {160, 100}, room, room);
    const LevelBsp bsp = compiled(drawn.map);
    expect_right(drawn.map, bsp, "slat");
    expect_right_sectors(drawn.map, bsp, 500, 2);
}

TEST(BspCompiler, FindsTheSectorOfDeepWater) {
    DrawnMap drawn;  // a square of lines with the water on both sides, inside the room
    const int room = drawn.sector(), water = drawn.sector(-64);
    drawn.loop({{0, 0}, {0, 256}, {256, 256}, {256, 0}}, room);
    drawn.loop({{64, 64}, {64, 192}, {192, 192}, {192, 64}}, water, water);
    const LevelBsp bsp = compiled(drawn.map);
    expect_sound(drawn.map, bsp, "water");
    EXPECT_EQ(sub_sector_at(bsp, {128, 128}).sector, static_cast<std::uint32_t>(water));
    EXPECT_EQ(sub_sector_at(bsp, {32, 32}).sector, static_cast<std::uint32_t>(room));
    EXPECT_EQ(sub_sector_at(bsp, {230, 128}).sector, static_cast<std::uint32_t>(room));
}

TEST(BspCompiler, ExtendsSectorsThatAreNotClosedToTheEdge) {
    Map map = room_map();
    map.lines.pop_back();
    const LevelBsp bsp = compiled(map);
    expect_sound(map, bsp, "three walls");
    const BspCheck check = check_bsp(map, bsp);
    EXPECT_EQ(check.open_sectors, 1u);
    EXPECT_GT(check.openings, 0u);
}

TEST(BspCompiler, CompilesASingleLine) {
    DrawnMap drawn;
    drawn.line({-32768, -32768}, {32767, 32767}, drawn.sector(), 0);
    expect_sound(drawn.map, compiled(drawn.map), "line");
}

TEST(BspCompiler, CompilesRandomLines) {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        const int lines = 1 + static_cast<int>(seed % 40);
        const int reach = seed % 3 == 0 ? 4 : seed % 3 == 1 ? 300 : 32767;
        const Map map = soup_map(lines, reach, seed);
        CompileOptions options;
        options.effort = efforts[seed % 3];
        const auto bsp = compile(map, options);
        if (!bsp) {
            EXPECT_EQ(bsp.status(), Status::BadArgument) << bsp.error().text();  // no line had a length
            continue;
        }
        expect_sound(map, *bsp, "soup " + std::to_string(seed));
        if (::testing::Test::HasFailure()) return;
    }
}

TEST(BspCompiler, LosesNoAreaInSlivers) {
    // Two fans of nearly parallel lines cross: pieces become as thin as integer coordinates allow.
    DrawnMap drawn;
    const int room = drawn.sector();
    drawn.loop({{-30000, -30000}, {-30000, 30000}, {30000, 30000}, {30000, -30000}}, room);
    for (int i = -6; i <= 6; ++i) {
        drawn.line({-29000, i}, {29000, -3 * i + 1}, room, room);
        drawn.line({-29000 + i, -28000}, {29000, 28000 + i}, room, room);
    }
    const LevelBsp bsp = compiled(drawn.map);
    expect_right(drawn.map, bsp, "fans");
    EXPECT_GT(bsp.sub_sectors.size(), 100u);
}

TEST(BspCompiler, RejectsTooManyPieces) {
    CompileOptions options;
    options.max_pieces = 500;
    const auto bsp = compile(soup_map(200, 1000, 1), options);
    ASSERT_FALSE(bsp);
    EXPECT_EQ(bsp.status(), Status::Capacity);
}

TEST(BspCompiler, RejectsInvalidReferences) {
    const auto refused = [](auto&& change) {
        Map map = room_map();
        change(map);
        return compile(map).status() == Status::BadArgument;
    };
    EXPECT_FALSE(refused([](Map&) {}));
    EXPECT_TRUE(refused([](Map& map) { map.lines[2].to = 99; }));
    EXPECT_TRUE(refused([](Map& map) { map.lines[2].right = 99; }));
    EXPECT_TRUE(refused([](Map& map) { map.sides[1].sector = 7; }));
    EXPECT_TRUE(refused([](Map& map) { map.lines.clear(); }));
    EXPECT_TRUE(refused([](Map& map) {
        for (Line& line : map.lines) line.right = no_side;
    }));
}

TEST(BspCompiler, CompilesFreedoomMaps) {
    const auto maps = freedoom_maps();
    if (maps.empty()) GTEST_SKIP() << "skipped: no levels in " << FASE_SHARED_DATA;
    for (const GivenMap& given : maps) {
        const LevelBsp bsp = compiled(given.map);
        expect_sound(given.map, bsp, given.file);
        const BspCheck check = check_bsp(given.map, bsp);
        EXPECT_LT(check.area_error, 1e-4) << given.file;
        EXPECT_EQ(check.open_sectors, 0u) << given.file;
        EXPECT_EQ(check.openings, 0u) << given.file;
        EXPECT_LT(static_cast<double>(bsp.stats.splits), 0.25 * static_cast<double>(bsp.stats.sides)) << given.file;
        EXPECT_LT(bsp.stats.mean_depth, std::log2(static_cast<double>(bsp.sub_sectors.size())) + 0.6) << given.file;
        if (check.mixed == 0) expect_right_sectors(given.map, bsp, 300, 4);
    }
}

}  // namespace
}  // namespace fase::level
