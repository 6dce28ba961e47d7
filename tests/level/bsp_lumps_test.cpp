/// Writes trees to WADs, reads them back, and rejects damaged ones.
#include "fase/level/bsp_lumps.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fase/level/bsp_compiler.hpp"
#include "fase/level/check_bsp.hpp"
#include "tests/level/drawn_maps.hpp"

namespace fase::level {
namespace {

struct Form {
    LumpOptions options;
    BspLumps lumps;
    const char* name;
};
constexpr std::array<Form, 5> forms{{{{false, false}, BspLumps::Nodes, "classic"},
                                     {{false, true}, BspLumps::Nodes, "classic beside GL"},
                                     {{false, true}, BspLumps::Gl, "GL"},
                                     {{true, false}, BspLumps::Nodes, "XNOD"},
                                     {{true, true}, BspLumps::Gl, "XGLN"}}};

/// A WAD with a tree in it, packed and parsed again.
Wad written(const Map& map, const LevelBsp& bsp, const LumpOptions& options) {
    Wad wad = wad_of(map);
    const auto done = write_bsp(wad, 0, "test.wad", map, bsp, options);
    EXPECT_TRUE(done) << done.error().text();
    const auto bytes = wad.to_bytes();
    EXPECT_TRUE(bytes);
    auto parsed = Wad::parse("test.wad", *bytes);
    EXPECT_TRUE(parsed);
    return *std::move(parsed);
}

TEST(BspLumps, RoundTrip) {
    const Map map = pool_map();
    const LevelBsp bsp = *compile(map);
    for (const Form& form : forms) {
        const Wad wad = written(map, bsp, form.options);
        const auto map_again = read_map("test.wad", wad, "MAP01");
        ASSERT_TRUE(map_again) << map_again.error().text();
        EXPECT_EQ(map_again->lines.size(), map.lines.size());
        const auto again = read_bsp("test.wad", wad, 0, *map_again, form.lumps);
        ASSERT_TRUE(again) << form.name << ": " << again.error().text();
        ASSERT_EQ(again->nodes.size(), bsp.nodes.size()) << form.name;
        ASSERT_EQ(again->sub_sectors.size(), bsp.sub_sectors.size()) << form.name;
        for (std::size_t n = 0; n < bsp.nodes.size(); ++n) {
            EXPECT_EQ(again->nodes[n].children[0], bsp.nodes[n].children[0]);
            EXPECT_EQ(again->nodes[n].children[1], bsp.nodes[n].children[1]);
            EXPECT_EQ(again->nodes[n].dx, bsp.nodes[n].dx);
            EXPECT_EQ(again->nodes[n].y, bsp.nodes[n].y);
            EXPECT_TRUE(again->nodes[n].boxes[1].contains(bsp.nodes[n].boxes[1].lo));
            EXPECT_TRUE(again->nodes[n].boxes[1].contains(bsp.nodes[n].boxes[1].hi));
        }
        for (std::size_t s = 0; s < bsp.sub_sectors.size(); ++s)
            EXPECT_EQ(again->sub_sectors[s].sector, bsp.sub_sectors[s].sector) << form.name;
        EXPECT_EQ(again->stats.mean_depth, bsp.stats.mean_depth);
        if (form.lumps == BspLumps::Gl) {
            ASSERT_EQ(again->segs.size(), bsp.segs.size()) << form.name;
            for (std::size_t i = 0; i < bsp.segs.size(); ++i) {
                const Seg &a = again->segs[i], &b = bsp.segs[i];
                EXPECT_EQ(a.line, b.line);
                EXPECT_EQ(a.left, b.left);
                EXPECT_EQ(a.partner, b.partner);
                EXPECT_NEAR(again->vertices[a.from].x, bsp.vertices[b.from].x, 1.0 / 65536);
                EXPECT_NEAR(again->vertices[a.to].y, bsp.vertices[b.to].y, 1.0 / 65536);
            }
        } else {
            EXPECT_EQ(again->stats.wall_segs, bsp.stats.wall_segs) << form.name;
        }
        const BspCheck check = check_bsp(*map_again, *again);
        const bool whole = !form.options.extended && form.lumps == BspLumps::Nodes;
        EXPECT_LT(check.bulge, whole ? 1.5 : 1e-3) << form.name;
        EXPECT_LT(check.area_error, 1e-4) << form.name;
        EXPECT_LE(check.outside_box, whole ? 0.5 : 1e-4) << form.name;
        EXPECT_LT(check.gaps, 1e-2) << form.name;
        EXPECT_EQ(check.open_loops + check.wrong_partners, 0u) << form.name;
    }
}

TEST(BspLumps, AreInTheOrderOfTheFormat) {
    const Map map = pool_map();
    const Wad wad = written(map, *compile(map), {false, true});
    std::vector<std::string> names;
    for (const Lump& lump : wad.lumps) names.push_back(lump.name);
    EXPECT_EQ(names, (std::vector<std::string>{"MAP01", "THINGS", "LINEDEFS", "SIDEDEFS", "VERTEXES", "SEGS",
                                               "SSECTORS", "NODES", "SECTORS", "REJECT", "BLOCKMAP", "GL_MAP01",
                                               "GL_VERT", "GL_SEGS", "GL_SSECT", "GL_NODES"}));
}

TEST(BspLumps, ReplaceOldOnes) {
    const Map map = pool_map();
    const LevelBsp bsp = *compile(map);
    Wad wad = written(map, bsp, {false, true});
    wad.set_in_map(0, "REJECT", {std::byte{1}, std::byte{2}});
    wad.lumps.push_back({"DEMO1", {std::byte{7}}});
    const auto count = wad.lumps.size();
    ASSERT_TRUE(write_bsp(wad, 0, "test.wad", map, bsp, {false, true}));
    EXPECT_EQ(wad.lumps.size(), count);
    EXPECT_EQ(wad.lumps[*wad.find_in_map(0, "REJECT")].bytes.size(), 2u);  // an existing one is kept
    ASSERT_TRUE(write_bsp(wad, 0, "test.wad", map, bsp, {}));
    EXPECT_EQ(wad.lumps.size(), count - 5);  // the outdated GL lumps are removed
    EXPECT_EQ(wad.lumps.back().name, "DEMO1");
}

TEST(BspLumps, HaveASegInEverySubSectorHoweverSmall) {
    // A corner so sharp that pieces near its tip round to points.
    DrawnMap drawn;
    const int room = drawn.sector();
    drawn.loop({{0, 0}, {1000, 3}, {1000, 0}}, room);
    for (int x = 50; x < 1000; x += 50) drawn.line({x, -1}, {x + 3, 4}, room, room);
    const LevelBsp bsp = *compile(drawn.map);
    const Wad wad = written(drawn.map, bsp, {});
    const auto map = read_map("test.wad", wad, "MAP01");
    ASSERT_TRUE(map);
    const auto again = read_bsp("test.wad", wad, 0, *map, BspLumps::Nodes);
    ASSERT_TRUE(again) << again.error().text();
    EXPECT_EQ(again->sub_sectors.size(), bsp.sub_sectors.size());
    EXPECT_EQ(again->segs.size(), bsp.stats.wall_segs);
}

/// The first node of a classic tree lies at x = "XN", y = "OD": numbers that any map may have.
TEST(BspLumps, ClassicNodesMayBeginLikeExtendedOnes) {
    const Map map = pool_map();
    const LevelBsp bsp = *compile(map);
    Wad wad = written(map, bsp, {});
    for (const std::string_view magic : {"XNOD", "ZNOD", "XGLN"}) {
        auto& nodes = wad.lumps[*wad.find_in_map(0, "NODES")].bytes;
        for (std::size_t i = 0; i < 4; ++i) nodes[i] = static_cast<std::byte>(magic[i]);
        const auto again = read_bsp("test.wad", wad, 0, *read_map("test.wad", wad, "MAP01"), BspLumps::Nodes);
        ASSERT_TRUE(again) << again.error().text();
        EXPECT_EQ(again->nodes.size(), bsp.nodes.size());
        EXPECT_EQ(again->nodes[0].x, magic[0] | magic[1] << 8);
    }
}

TEST(BspLumps, AreRejectedIfTheyDoNotFit) {
    const Map map = room_map();
    LevelBsp bsp = *compile(map);
    bsp.vertices.resize(70000);
    Wad wad = wad_of(map);
    const auto before = *wad.to_bytes();
    const auto refused = write_bsp(wad, 0, "big.wad", map, bsp, {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(
        refused.error().text(),
        "big.wad: MAP01: found 70000 vertices; expected at most 65536 in the classic format; write extended nodes");
    EXPECT_EQ(*wad.to_bytes(), before);
    EXPECT_TRUE(write_bsp(wad, 0, "big.wad", map, bsp, {true, true}));
}

TEST(BspLumps, UseWideGlNodesIfNarrowOnesDoNotFit) {
    const Map map = pool_map();
    LevelBsp bsp = *compile(map);
    bsp.vertices.resize(bsp.vertices.size() + 40000);
    const Wad wad = written(map, bsp, {false, true});
    const auto& magic = wad.lumps[wad.lumps.size() - 4].bytes;
    ASSERT_EQ(wad.lumps[wad.lumps.size() - 4].name, "GL_VERT");
    EXPECT_EQ(static_cast<char>(magic[3]), '5');
    const auto again = read_bsp("test.wad", wad, 0, *read_map("test.wad", wad, "MAP01"), BspLumps::Gl);
    ASSERT_TRUE(again) << again.error().text();
    EXPECT_EQ(again->segs.size(), bsp.segs.size());
}

TEST(BspLumps, AreRejectedIfTruncated) {
    const Map map = pool_map();
    const LevelBsp bsp = *compile(map);
    for (const Form& form : forms) {
        const Wad whole = written(map, bsp, form.options);
        const Map again = *read_map("test.wad", whole, "MAP01");
        for (std::size_t i = 1; i < whole.lumps.size(); ++i) {
            const std::string& name = whole.lumps[i].name;
            const bool of_tree = form.lumps == BspLumps::Gl
                                     ? (form.options.extended ? name == "SSECTORS" : name.starts_with("GL_"))
                                     : name == "SEGS" || name == "SSECTORS" || name == "NODES";
            if (!of_tree) continue;
            for (std::size_t size = 0; size < whole.lumps[i].bytes.size(); ++size) {
                Wad wad = whole;
                wad.lumps[i].bytes.resize(size);
                const auto read = read_bsp("test.wad", wad, 0, again, form.lumps);
                const bool may_be_valid =
                    name == "GL_VERT" || (form.options.extended && name != "NODES" && form.lumps == BspLumps::Nodes);
                EXPECT_TRUE(!read || may_be_valid) << form.name << " " << name << " " << size;
            }
        }
    }
}

TEST(BspLumps, SurviveEveryFlippedBit) {
    DrawnMap drawn;
    drawn.loop({{0, 0}, {0, 256}, {128, 256}, {128, 128}, {256, 128}, {256, 0}}, drawn.sector());
    const LevelBsp bsp = *compile(drawn.map);
    for (const Form& form : forms) {
        const Wad whole = written(drawn.map, bsp, form.options);
        const Map again = *read_map("test.wad", whole, "MAP01");
        for (std::size_t i = 5; i < whole.lumps.size(); ++i) {
            for (std::size_t bit = 0; bit < whole.lumps[i].bytes.size() * 8; ++bit) {
                Wad wad = whole;
                wad.lumps[i].bytes[bit / 8] ^= static_cast<std::byte>(1 << bit % 8);
                const auto read = read_bsp("test.wad", wad, 0, again, form.lumps);
                if (read) {
                    EXPECT_GE(check_bsp(again, *read).gaps, 0);  // the check terminates
                }
            }
        }
    }
}

TEST(BspLumps, ReportTheInvalidEntry) {
    const Map map = pool_map();
    const Wad whole = written(map, *compile(map), {});
    const Map again = *read_map("test.wad", whole, "MAP01");
    const auto message = [&](std::string_view lump, std::size_t byte, int value) {
        Wad wad = whole;
        auto& bytes = wad.lumps[*wad.find_in_map(0, lump)].bytes;
        bytes[byte] = static_cast<std::byte>(value & 0xff);
        bytes[byte + 1] = static_cast<std::byte>(value >> 8 & 0xff);
        const auto read = read_bsp("a.wad", wad, 0, again, BspLumps::Nodes);
        return read ? std::string() : read.error().text();
    };
    EXPECT_EQ(message("SEGS", 12, 9999).substr(0, 42), "a.wad: MAP01 segs[1]: found vertex 9999; e");
    EXPECT_EQ(message("SEGS", 6, 500).substr(0, 37), "a.wad: MAP01 segs[0]: found line 500;");
    EXPECT_NE(message("SSECTORS", 2, 3).find("which another sub-sector contains too"), std::string::npos);
    const std::size_t last = (whole.lumps[*whole.find_in_map(0, "NODES")].bytes.size() / 28 - 1) * 28;
    EXPECT_NE(message("NODES", last + 24, static_cast<int>(last / 28)).find("twice"),
              std::string::npos);  // its own child
    EXPECT_NE(message("NODES", 24, 0x9999).find("that does not exist"), std::string::npos);
}

TEST(BspLumps, IncludeABlockmapOfAllLines) {
    const Map map = pool_map();
    const auto bytes = make_blockmap(map);
    ASSERT_GE(bytes.size(), 8u);
    const int west = read_i16(bytes, 0), south = read_i16(bytes, 2), columns = read_i16(bytes, 4),
              rows = read_i16(bytes, 6);
    EXPECT_EQ(west, 0);
    EXPECT_EQ(south, 0);
    std::vector<std::vector<std::uint16_t>> cells;
    for (int i = 0; i < columns * rows; ++i) {
        std::size_t at = 2 * std::size_t{read_u16(bytes, 8 + 2 * static_cast<std::size_t>(i))};
        ASSERT_EQ(read_u16(bytes, at), 0);
        auto& cell = cells.emplace_back();
        for (at += 2; read_u16(bytes, at) != 0xffff; at += 2) cell.push_back(read_u16(bytes, at));
    }
    for (std::uint16_t i = 0; i < map.lines.size(); ++i) {
        const Vertex a = map.vertices[map.lines[i].from], b = map.vertices[map.lines[i].to];
        for (int k = 0; k <= 1000; ++k) {
            const double x = a.x + (b.x - a.x) * k / 1000.0, y = a.y + (b.y - a.y) * k / 1000.0;
            const auto cell = static_cast<std::size_t>(static_cast<int>(y) / 128 * columns + static_cast<int>(x) / 128);
            EXPECT_EQ(std::count(cells[cell].begin(), cells[cell].end(), i), 1) << i << " at " << x << ", " << y;
        }
    }
}

TEST(BspLumps, ReadTreesOfOtherCompilers) {
    const auto maps = freedoom_maps();
    if (maps.empty()) GTEST_SKIP() << "skipped: no levels in " << FASE_SHARED_DATA;
    for (const GivenMap& given : maps) {
        const auto bsp = read_bsp(given.file, given.wad, given.marker, given.map, BspLumps::Nodes);
        ASSERT_TRUE(bsp) << bsp.error().text();
        EXPECT_GT(bsp->nodes.size(), 50u);
        const BspCheck check = check_bsp(given.map, *bsp);
        EXPECT_LT(check.bulge, 3) << given.file;
        EXPECT_LT(check.outside_node, 3) << given.file;
        EXPECT_LT(check.gaps, 100) << given.file;
        const auto none = read_bsp(given.file, given.wad, given.marker, given.map, BspLumps::Gl);
        EXPECT_FALSE(none);
    }
}

TEST(BinaryAngle, AgreesWithAtan2) {
    EXPECT_EQ(binary_angle(1, 0), 0);
    EXPECT_EQ(binary_angle(0, 1), 16384);
    EXPECT_EQ(binary_angle(-5, 0), 32768);
    EXPECT_EQ(binary_angle(0, -3), 49152);
    EXPECT_EQ(binary_angle(7, 7), 8192);
    EXPECT_EQ(binary_angle(0, 0), 0);
    Random random(3);
    for (int i = 0; i < 10000; ++i) {
        const double dx = random.between(-30000, 30000), dy = random.between(-30000, 30000);
        const double turn = std::atan2(dy, dx) / 6.283185307179586 * 65536;
        const auto expected = static_cast<std::uint16_t>(static_cast<std::int32_t>(std::floor(turn + 0.5)));
        EXPECT_LE(static_cast<std::uint16_t>(binary_angle(dx, dy) - expected + 1), 2) << dx << ", " << dy;
    }
}

}  // namespace
}  // namespace fase::level
