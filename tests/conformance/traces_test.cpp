/// Checks every structure on boxes of real, deforming meshes: swept triangles and edges of cloth and armadillos.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "fase/broad/any_structure.hpp"
#include "fase/broad/registry.hpp"
#include "fase/broad/search/plain_sweep.hpp"

namespace fase::conformance {
namespace {

using broad::AnyStructure;
using broad::Move;
using broad::Pair;
using broad::Proxy;

/// Reads the first frame of a trace: "AABT", version, boxes, frames (u32 each), one flag byte per box padded to 4, then
/// six floats per box.
std::vector<Move> first_frame(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    char magic[4];
    std::uint32_t version = 0, count = 0, frames = 0;
    file.read(magic, 4);
    for (std::uint32_t* number : {&version, &count, &frames}) file.read(reinterpret_cast<char*>(number), 4);
    if (!file || std::memcmp(magic, "AABT", 4) != 0 || version != 1) return {};
    file.ignore((count + 3) / 4 * 4);
    std::vector<Move> boxes;
    for (Proxy p = 0; p < count; ++p) {
        float bounds[6];
        file.read(reinterpret_cast<char*>(bounds), sizeof bounds);
        boxes.push_back({p, {{bounds[0], bounds[1], bounds[2]}, {bounds[3], bounds[4], bounds[5]}}});
    }
    return file ? boxes : std::vector<Move>{};
}

/// Returns every n-th box, so that about `max_count` remain.
std::vector<Move> thinned(const std::vector<Move>& boxes, std::size_t max_count) {
    std::vector<Move> kept;
    const std::size_t stride = boxes.size() / max_count + 1;
    for (std::size_t i = 0; i < boxes.size(); i += stride) kept.push_back(boxes[i]);
    return kept;
}

std::vector<Pair> pairs_by_sweep(const std::vector<Move>& boxes) {
    std::vector<Pair> pairs;
    broad::find_pairs_by_sweep(boxes, pairs);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

class Traces : public ::testing::TestWithParam<const char*> {};

TEST_P(Traces, GiveTheSamePairsInEveryStructure) {
    const auto path = std::filesystem::path(FASE_SHARED_DATA) / "traces" / (std::string(GetParam()) + ".aabt");
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "skipped: " << path << " is missing";
    const std::vector<Move> boxes = thinned(first_frame(path), 30000);
    ASSERT_GT(boxes.size(), 10000u);
    const std::vector<Pair> expected = pairs_by_sweep(boxes);
    RecordProperty("pairs", std::to_string(expected.size()));
    broad::for_each_structure([&]<broad::Structure S>() {
        if (S::info.name == "brute_force")
            return;  // too slow here; the test below compares it with the sweep on a part
        AnyStructure s = *AnyStructure::named(S::info.name);
        s.insert(boxes);
        s.commit();
        std::vector<Pair> pairs;
        s.find_pairs(pairs);
        std::sort(pairs.begin(), pairs.end());
        EXPECT_EQ(s.broken_invariant(), "");
        EXPECT_TRUE(pairs == expected) << S::info.name << ": " << pairs.size() << " pairs, expected "
                                       << expected.size();
    });
}

TEST_P(Traces, GiveTheSamePairsToBruteForceAndTheSweepOnAPart) {
    const auto path = std::filesystem::path(FASE_SHARED_DATA) / "traces" / (std::string(GetParam()) + ".aabt");
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "skipped: " << path << " is missing";
    const std::vector<Move> part = thinned(first_frame(path), 6000);
    AnyStructure reference = *AnyStructure::named("brute_force");
    reference.insert(part);
    std::vector<Pair> pairs;
    reference.find_pairs(pairs);
    std::sort(pairs.begin(), pairs.end());
    EXPECT_TRUE(pairs == pairs_by_sweep(part));
    EXPECT_FALSE(pairs.empty());
}

INSTANTIATE_TEST_SUITE_P(Meshes, Traces, ::testing::Values("armadillo-rollers", "cloth-ball", "cloth-funnel"),
                         [](const auto& trace) {
                             std::string name = trace.param;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

}  // namespace
}  // namespace fase::conformance
