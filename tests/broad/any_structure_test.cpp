#include "fase/broad/any_structure.hpp"
#include "fase/broad/registry.hpp"

#include <gtest/gtest.h>

namespace fase::broad {
namespace {

TEST(AnyStructure, RejectsAnUnknownNameAndListsTheKnownOnes) {
    const Result<AnyStructure> found = AnyStructure::named("octopus");
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().status, Status::BadArgument);
    EXPECT_NE(found.error().text().find("octopus"), std::string::npos);
    for_each_structure(
        [&]<Structure S>() { EXPECT_NE(found.error().text().find(S::info.name), std::string::npos) << S::info.name; });
}

TEST(AnyStructure, IsTheStructureOfItsName) {
    for_each_structure([]<Structure S>() {
        const Result<AnyStructure> found = AnyStructure::named(S::info.name);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->info().name, S::info.name);
        EXPECT_EQ(found->info().idea, S::info.idea);
        EXPECT_EQ(found->size(), 0u);
        EXPECT_NE(AnyStructure::names().find(S::info.name), std::string::npos);
    });
    EXPECT_EQ(AnyStructure{}.info().name, default_structure);
}

TEST(AnyStructure, ReturnsTheCellsOfStructuresWithCells) {
    AnyStructure tree = *AnyStructure::named("dynamic_bvh"), list = *AnyStructure::named("brute_force");
    std::vector<Move> boxes;
    for (Proxy p = 0; p < 10; ++p) {
        const auto x = static_cast<float>(p);
        boxes.push_back({p, {{x, 0, 0}, {x + 0.5f, 1, 1}}});
    }
    for (AnyStructure* s : {&tree, &list}) {
        s->insert(boxes);
        s->commit();
        EXPECT_GE(s->bytes(), 10 * sizeof(Aabb));
    }
    std::vector<DrawnCell> cells;
    list.cells(cells);
    EXPECT_TRUE(cells.empty());
    tree.cells(cells);
    ASSERT_EQ(cells.size(), 9u);
    EXPECT_EQ(cells[0].depth, 0);
    EXPECT_EQ(cells[0].box, (Aabb{{0, 0, 0}, {9.5f, 1, 1}}));
}

TEST(AnyStructure, IsCopiedDeeply) {
    for_each_structure([]<Structure S>() {
        AnyStructure one = *AnyStructure::named(S::info.name);
        const Move box{3, {{0, 0, 0}, {1, 1, 1}}};
        one.insert(std::span(&box, 1));
        one.commit();
        AnyStructure copy = one;
        one.clear();
        one.commit();
        EXPECT_EQ(one.size(), 0u);
        std::vector<Proxy> found;
        copy.overlapping(box.box, found);
        EXPECT_EQ(found, (std::vector<Proxy>{3}));
    });
}

}  // namespace
}  // namespace fase::broad
