/// Tests `fase draw`: pictures of the cells of structures.
#include "fase/broad/any_structure.hpp"
#include "fase/broad/registry.hpp"
#include "fase/record/trace.hpp"
#include "tests/cli/fase_program.hpp"

namespace fase::cli {
namespace {

/// Rows of 60 boxes on the ground: the first 20 are static, the next 20 asleep; from frame 1 on, the last 25 rise.
std::string write_small_trace(const TemporaryFolder& folder, std::uint32_t frames = 3) {
    const std::string name = folder / "boxes.aabt";
    auto writer = record::TraceWriter::create(name, 60);
    EXPECT_TRUE(writer);
    std::vector<std::uint8_t> flags;
    for (std::uint32_t frame = 0; frame < frames; ++frame) {
        std::vector<Aabb> boxes;
        for (int i = 0; i < 60; ++i) {
            const Vec3 corner{2.0f * static_cast<float>(i % 10), i < 35 ? 0.0f : static_cast<float>(frame),
                              3.0f * static_cast<float>(i / 10)};
            boxes.push_back({corner, corner + Vec3{1.5f, 1, 2}});
            if (frame == 0)
                flags.push_back(i < 20   ? std::uint8_t{record::trace_static}
                                : i < 40 ? std::uint8_t{record::trace_asleep}
                                         : std::uint8_t{0});
        }
        EXPECT_TRUE(writer->add_frame(boxes));
    }
    EXPECT_TRUE(writer->finish(flags));
    return name;
}

std::size_t count_of(const std::string& text, const std::string& word) {
    std::size_t count = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
    return count;
}

TEST(Draw, WritesEachBoxInItsColourAndTheCells) {
    const TemporaryFolder folder;
    const std::string trace = write_small_trace(folder), file = folder / "kd.svg";
    const Outcome drawn = run_fase({"draw", trace, "--structure", "kd_tree", "-o", file});
    ASSERT_EQ(drawn.code, 0) << drawn.err;
    EXPECT_NE(drawn.out.find("kd.svg: kd_tree"), std::string::npos) << drawn.out;
    const std::string svg = read_file(file);
    EXPECT_TRUE(svg.starts_with("<svg ")) << svg;
    EXPECT_TRUE(svg.ends_with("</svg>\n"));
    EXPECT_EQ(count_of(svg, "<rect x="), 60u);
    for (const char* words : {">kd_tree</tspan>", "60 boxes, ", "plane xz, frame 0", ">20 static<", ">20 resting<",
                              ">20 awake<", ">cells, depth 0 to "})
        EXPECT_NE(svg.find(words), std::string::npos) << words;
    EXPECT_GT(count_of(svg, "<path id="), 2u);
    EXPECT_EQ(count_of(svg, "<use "), 2 * count_of(svg, "<path id="));
    EXPECT_EQ(count_of(svg, "<g"), count_of(svg, "</g>"));
    EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(Draw, UpdatesTheStructureThroughTheFramesBefore) {
    const TemporaryFolder folder;
    const std::string trace = write_small_trace(folder), file = folder / "later.svg";
    ASSERT_EQ(run_fase({"draw", trace, "--frame", "2", "--plane", "xy", "-o", file}).code, 0);
    const std::string svg = read_file(file);
    EXPECT_NE(svg.find("plane xy, frame 2"), std::string::npos);
    EXPECT_NE(svg.find(">15 resting<"), std::string::npos) << "five sleeping boxes moved";
    EXPECT_NE(svg.find(">25 awake<"), std::string::npos);
}

TEST(Draw, WritesOnePicturePerStructureIntoAFolder) {
    const TemporaryFolder folder;
    const std::string trace = write_small_trace(folder), pictures = folder / "pictures";
    std::filesystem::create_directory(pictures);
    const Outcome drawn = run_fase({"draw", trace, "--structure", "all", "-o", pictures});
    ASSERT_EQ(drawn.code, 0) << drawn.err;
    std::size_t structures = 0;
    broad::for_each_structure([&]<broad::Structure S>() {
        ++structures;
        const std::string svg = read_file(pictures + "/" + std::string(S::info.name) + ".svg");
        EXPECT_EQ(count_of(svg, "<rect x="), 60u) << S::info.name;
        EXPECT_EQ(svg.find("cells, depth") != std::string::npos || svg.find(">cells<") != std::string::npos,
                  broad::Drawable<S>)
            << S::info.name;
    });
    EXPECT_EQ(count_of(drawn.out, "\n"), structures);
    ASSERT_EQ(run_fase({"draw", trace, "--structure", "brute_force", "--plane", "yz", "-o", pictures}).code, 0);
    EXPECT_NE(read_file(pictures + "/brute_force.svg").find("plane yz"), std::string::npos);
}

TEST(Draw, ShowsInfiniteBoxesAndPoints) {
    const TemporaryFolder folder;
    const std::string name = folder / "special.aabt";
    auto writer = record::TraceWriter::create(name, 3);
    ASSERT_TRUE(writer);
    constexpr float far = Aabb::infinity;
    const std::vector<Aabb> boxes{{{-far, -far, -far}, {far, 0, far}}, {{1, 1, 1}, {1, 1, 1}}, {{3, 0, 0}, {4, 1, 0}}};
    ASSERT_TRUE(writer->add_frame(boxes));
    ASSERT_TRUE(writer->finish(std::vector<std::uint8_t>(3, 0)));
    for (const char* plane : {"xz", "xy", "yz"}) {
        const Outcome drawn = run_fase({"draw", name, "--plane", plane, "-o", folder / "special.svg"});
        EXPECT_EQ(drawn.code, 0) << drawn.err;
        const std::string svg = read_file(folder / "special.svg");
        EXPECT_EQ(count_of(svg, "<rect x="), 3u);
        EXPECT_EQ(svg.find("inf"), std::string::npos);
        EXPECT_EQ(svg.find("nan"), std::string::npos);
        EXPECT_EQ(svg.find("=\"0\"/>"), std::string::npos) << "a box without height is invisible";
    }
}

TEST(Draw, RefusesInvalidOptions) {
    const TemporaryFolder folder;
    const std::string trace = write_small_trace(folder), file = folder / "x.svg";
    const auto expect_refused = [&](std::vector<std::string> options, int code, const std::string& words) {
        options.insert(options.begin(), "draw");
        expect_error_line(run_fase(options), code, words);
        EXPECT_FALSE(std::filesystem::exists(file));
    };
    expect_refused({trace, "--structure", "oaktree", "-o", file}, 2, "--structure: found");
    expect_refused({trace, "--plane", "zx", "-o", file}, 2, "--plane: found \"zx\"; expected xz, xy or yz");
    expect_refused({trace, "--frame", "3", "-o", file}, 2, "--frame: found 3; expected 0 to 2");
    expect_refused({trace, "--frame", "-1", "-o", file}, 2, "--frame");
    expect_refused({trace, "-o", folder / "x.png"}, 2,
                   "x.png: found the extension \".png\"; expected .svg for a drawing");
    expect_refused({trace, "--structure", "all", "-o", file}, 2, "found a file; expected a folder");
    expect_refused({trace, "-o", trace + "/x.svg"}, 3, "expected a folder");
    expect_refused({folder / "none.aabt", "-o", file}, 3, "none.aabt");
    expect_refused({trace}, 2, "--output");
    write_file(folder / "text.aabt", "something else");
    expect_refused({folder / "text.aabt", "-o", file}, 2, "text.aabt");
    std::filesystem::copy_file(trace, folder / "self.svg");
    expect_error_line(run_fase({"draw", folder / "self.svg", "-o", folder / "self.svg"}), 3, "found the input file");
}

TEST(Draw, CreatesTheFolderOfThePicture) {
    const TemporaryFolder folder;
    const std::string trace = write_small_trace(folder);
    EXPECT_EQ(run_fase({"draw", trace, "-o", folder / "a/b/x.svg"}).code, 0);
    EXPECT_TRUE(std::filesystem::exists(folder / "a/b/x.svg"));
    EXPECT_EQ(run_fase({"draw", trace, "--structure", "quadtree", "-o", folder / "c/"}).code, 0);
    EXPECT_TRUE(std::filesystem::exists(folder / "c/quadtree.svg"));
    EXPECT_EQ(run_fase({"draw", trace, "--structure", "all", "-o", folder / "all"}).code, 0);
    EXPECT_TRUE(std::filesystem::exists(folder / "all/octree.svg"));
}

}  // namespace
}  // namespace fase::cli
