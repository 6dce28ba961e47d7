/// Tests properties of packings, and the occupancy for published sets of sizes.
#include "fase/atlas/packer.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <filesystem>

#include "fase/core/random.hpp"
#include "tests/atlas/packed.hpp"

namespace fase::atlas {
namespace {

std::vector<Size> any_sizes(int max_side) {
    return *rc::gen::container<std::vector<Size>>(rc::gen::apply(
        [](int width, int height) {
            return Size{width, height};
        },
        rc::gen::inRange(1, max_side + 1), rc::gen::inRange(1, max_side + 1)));
}
PackOptions any_options() {
    PackOptions options;
    options.method = static_cast<Method>(*rc::gen::inRange(0, 3));
    options.max_side = *rc::gen::inRange(64, 300);
    options.padding = *rc::gen::inRange(0, 4);
    options.extrude = *rc::gen::inRange(0, 4);
    options.rotate = *rc::gen::arbitrary<bool>();
    options.power_of_two = *rc::gen::arbitrary<bool>();
    options.crop = *rc::gen::arbitrary<bool>();
    options.tries = *rc::gen::inRange(1, 60);
    return options;
}
std::vector<Size> random_sizes(std::size_t count, int max_side, std::uint64_t seed) {
    Random random(seed);
    std::vector<Size> sizes;
    for (std::size_t i = 0; i < count; ++i)
        sizes.push_back({1 + static_cast<int>(random.below(static_cast<std::uint64_t>(max_side))),
                         1 + static_cast<int>(random.below(static_cast<std::uint64_t>(max_side)))});
    return sizes;
}

RC_GTEST_PROP(Packer, PlacesEveryRectangleInsideAPageWithoutOverlap, ()) {
    const std::vector<Size> sizes = any_sizes(56);
    const PackOptions options = any_options();
    const Result<Packing> packing = pack(sizes, options);
    RC_ASSERT(packing.has_value());
    RC_ASSERT(problem_of(*packing, sizes, options) == "");
}

RC_GTEST_PROP(Packer, SameTriesGiveTheSamePacking, ()) {
    const std::vector<Size> sizes = any_sizes(56);
    const PackOptions options = any_options();
    const Result<Packing> a = pack(sizes, options), b = pack(sizes, options);
    RC_ASSERT(a.has_value() && b.has_value());
    RC_ASSERT(a->places == b->places);
    RC_ASSERT(a->pages == b->pages);
    RC_ASSERT(a->rule == b->rule);
}

RC_GTEST_PROP(Packer, AddKeepsPackedRectanglesInPlace, ()) {
    std::vector<Size> sizes = any_sizes(40);
    const std::vector<Size> more = any_sizes(40);
    const PackOptions options = any_options();
    Result<Packing> packing = pack(sizes, options);
    RC_ASSERT(packing.has_value());
    const Packing before = *packing;
    RC_ASSERT(add(*packing, sizes, more, options).has_value());
    for (std::size_t i = 0; i < sizes.size(); ++i) RC_ASSERT(packing->places[i] == before.places[i]);
    for (std::size_t i = 0; i < before.pages.size(); ++i) RC_ASSERT(packing->pages[i] == before.pages[i]);
    sizes.insert(sizes.end(), more.begin(), more.end());
    RC_ASSERT(problem_of(*packing, sizes, options) == "");
}

TEST(Packer, MoreTriesAreNeverWorse) {
    const std::vector<Size> sizes = random_sizes(150, 60, 5);
    PackOptions options;
    std::int64_t area = std::numeric_limits<std::int64_t>::max();
    for (options.tries = 1; options.tries < 300; options.tries *= 2) {
        const Result<Packing> packing = pack(sizes, options);
        ASSERT_TRUE(packing);
        ASSERT_EQ(packing->pages.size(), 1u);
        EXPECT_LE(area_of(packing->pages[0]), area) << options.tries;
        area = area_of(packing->pages[0]);
    }
}

TEST(Packer, EqualSquaresFillThePage) {
    for (const Method method : {Method::Best, Method::KdTree, Method::Skyline}) {
        PackOptions options;
        options.method = method;
        options.tries = 1;
        const std::vector<Size> squares(64, {8, 8});
        const Result<Packing> packing = pack(squares, options);
        ASSERT_TRUE(packing);
        EXPECT_EQ(packing->pages, std::vector<Size>{Size(64, 64)});
        EXPECT_EQ(packing->occupancy(squares), 1);
    }
}

TEST(Packer, PaddingIsBetweenNeighboursOnly) {
    PackOptions options;
    options.padding = 3;
    const std::vector<Size> squares(4, {10, 10});
    const Result<Packing> packing = pack(squares, options);
    ASSERT_TRUE(packing);
    EXPECT_EQ(packing->pages, std::vector<Size>{Size(23, 23)});
}

TEST(Packer, ExtrudedEdgesAreInsideThePage) {
    PackOptions options;
    options.extrude = 2;
    const std::vector<Size> one{{10, 10}};
    const Result<Packing> packing = pack(one, options);
    ASSERT_TRUE(packing);
    EXPECT_EQ(packing->pages, std::vector<Size>{Size(14, 14)});
    EXPECT_EQ(packing->places[0], (Place{0, 2, 2, false}));
}

TEST(Packer, UsesFullPagesAndASmallLastOne) {
    PackOptions options;
    options.max_side = 100;
    const std::vector<Size> sizes(5, {50, 100});
    const Result<Packing> packing = pack(sizes, options);
    ASSERT_TRUE(packing);
    EXPECT_EQ(problem_of(*packing, sizes, options), "");
    EXPECT_EQ(packing->pages.size(), 3u);
    options.crop = true;
    const Result<Packing> cropped = pack(sizes, options);
    ASSERT_TRUE(cropped);
    EXPECT_EQ(area_of(cropped->pages.back()), 5000);
}

TEST(Packer, PacksRectanglesAsLargeAsAPage) {
    PackOptions options;
    options.max_side = 64;
    for (const bool power : {false, true}) {
        options.power_of_two = power;
        const std::vector<Size> sizes{{64, 64}, {64, 1}, {1, 64}};
        const Result<Packing> packing = pack(sizes, options);
        ASSERT_TRUE(packing);
        EXPECT_EQ(problem_of(*packing, sizes, options), "");
    }
}

TEST(Packer, AddUsesFreeSpaceOfPagesFirst) {
    PackOptions options;
    options.max_side = 64;
    const std::vector<Size> packed{{64, 40}, {40, 24}};
    Result<Packing> packing = pack(packed, options);
    ASSERT_TRUE(packing);
    ASSERT_EQ(packing->pages.size(), 1u);
    const std::vector<Size> more(9, {8, 8});
    ASSERT_TRUE(add(*packing, packed, more, options));
    EXPECT_EQ(packing->pages.size(), 1u) << "24 x 24 pixels are free, enough for nine of 8 x 8";
}

TEST(Packer, NoRectanglesNeedNoPage) {
    const Result<Packing> packing = pack({});
    ASSERT_TRUE(packing);
    EXPECT_TRUE(packing->pages.empty());
    EXPECT_EQ(packing->occupancy({}), 0);
}

TEST(Packer, RejectsInvalidSizesAndOptions) {
    const auto status = [](std::vector<Size> sizes, PackOptions options) { return pack(sizes, options).status(); };
    for (const Size bad : {Size{0, 5}, Size{5, 0}, Size{-1, 5}, Size{4097, 1}, Size{1, 2000000000}}) {
        const Result<Packing> packing = pack(std::vector<Size>{{1, 1}, bad});
        ASSERT_FALSE(packing);
        EXPECT_EQ(packing.status(), Status::OutOfRange);
        EXPECT_EQ(packing.error().where, "rectangle 1");
    }
    PackOptions options;
    options.max_side = 0;
    EXPECT_EQ(status({{1, 1}}, options), Status::BadArgument);
    options.max_side = 65537;
    EXPECT_EQ(status({{1, 1}}, options), Status::BadArgument);
    options = {};
    options.padding = -1;
    EXPECT_EQ(status({{1, 1}}, options), Status::BadArgument);
    options = {};
    options.budget_ms = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(status({{1, 1}}, options), Status::BadArgument);
    options = {};
    options.max_side = 100;
    options.power_of_two = true;
    EXPECT_EQ(status({{65, 1}}, options), Status::OutOfRange) << "the largest page is 64 x 64";
    Packing empty;
    EXPECT_EQ(add(empty, std::vector<Size>{{1, 1}}, {}, {}).status(), Status::BadArgument);
}

TEST(Packer, PacksExtremeSizes) {
    for (const std::vector<Size>& sizes :
         {std::vector<Size>(3000, {1, 1}), std::vector<Size>(40, {1, 2000}), std::vector<Size>{{65536, 1}, {1, 65536}},
          random_sizes(3, 60000, 1), random_sizes(20000, 3, 2)}) {
        for (const bool rotate : {false, true}) {
            PackOptions options;
            options.max_side = max_page_side;
            options.rotate = rotate;
            options.tries = 12;
            const Result<Packing> packing = pack(sizes, options);
            ASSERT_TRUE(packing);
            EXPECT_EQ(problem_of(*packing, sizes, options), "");
        }
    }
}

/// Uses the sets of rectangles from the table in docs/atlas.md.
TEST(Packer, FillsPublishedSetsWithinFewTries) {
    const struct {
        const char* name;
        std::size_t count;
        double after_ten, after_sixty;
    } sets[] = {{"uni500", 500, 0.966, 0.98}, {"sprite2000", 2000, 0.965, 0.985}, {"glyph3000", 3000, 0.985, 0.995}};
    for (const auto& set : sets) {
        const std::string path = std::string(FASE_SHARED_DATA) + "/atlas/" + set.name + ".txt";
        if (!std::filesystem::exists(path)) GTEST_SKIP() << "skipped: no " << path;
        const std::vector<Size> sizes = read_sizes(path);
        ASSERT_EQ(sizes.size(), set.count);
        PackOptions options;
        for (const auto& [tries, least] : {std::pair(10, set.after_ten), std::pair(60, set.after_sixty)}) {
            options.tries = tries;
            const Result<Packing> packing = pack(sizes, options);
            ASSERT_TRUE(packing);
            EXPECT_EQ(problem_of(*packing, sizes, options), "");
            ASSERT_EQ(packing->pages.size(), 1u);
            EXPECT_EQ(packing->pages[0].width, packing->pages[0].height);
            EXPECT_GE(packing->occupancy(sizes), least) << set.name << " after " << tries;
        }
    }
}

}  // namespace
}  // namespace fase::atlas
