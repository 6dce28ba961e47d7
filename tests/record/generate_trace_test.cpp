/// Tests generated traces: each kind has its described properties and the same bytes on every machine.
#include "fase/record/generate_trace.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "fase/broad/search/plain_sweep.hpp"
#include "fase/core/hash.hpp"
#include "fase/record/trace.hpp"
#include "tests/record/artificial_run.hpp"

namespace fase::record {
namespace {

struct GeneratedFrames {
    GeneratedTrace counts;
    std::vector<std::uint8_t> flags;
    std::vector<std::vector<Aabb>> frames;
    [[nodiscard]] std::size_t moved_in(std::size_t frame) const {
        std::size_t moved = 0;
        for (std::size_t i = 0; i < flags.size(); ++i) moved += frames[frame][i] == frames[frame - 1][i] ? 0 : 1;
        return moved;
    }
    [[nodiscard]] std::size_t pairs_in(std::size_t frame) const {
        std::vector<broad::Move> moves;
        for (const Aabb& box : frames[frame]) moves.push_back({static_cast<broad::Proxy>(moves.size()), box});
        std::vector<broad::Pair> pairs;
        broad::find_pairs_by_sweep(moves, pairs);
        return pairs.size();
    }
};

GeneratedFrames make(std::string_view kind, std::size_t count, std::uint32_t frames, std::uint64_t seed = 1) {
    const TemporaryFolder folder;
    const std::string name = folder / "t.aabt";
    GeneratedFrames generated;
    const auto counts = generate_trace(kind, {count, frames, seed}, name);
    EXPECT_TRUE(counts) << counts.error().text();
    auto trace = TraceReader::open(name);
    EXPECT_TRUE(trace) << trace.error().text();
    generated.counts = *counts;
    generated.flags.assign(trace->flags().begin(), trace->flags().end());
    for (std::vector<Aabb> boxes; *trace->next(boxes);) generated.frames.push_back(boxes);
    EXPECT_EQ(generated.frames.size(), trace->frames());
    return generated;
}

std::uint64_t hash_of(std::string_view kind, std::uint64_t seed) {
    const TemporaryFolder folder;
    EXPECT_TRUE(generate_trace(kind, {200, 40, seed}, folder / "t.aabt"));
    const std::string bytes = read_file(folder / "t.aabt");
    Hasher hash;
    hash.add_bytes(std::as_bytes(std::span(bytes)));
    return hash.value();
}

TEST(GenerateTrace, GivesTheSameBytesOnEveryMachine) {
    // A changed rule changes its hash; a different compiler must not.
    const std::map<std::string, std::uint64_t> golden{
        {"uniform", 0x727fb470f96a3573},    {"clusters", 0x53806783f7298d4f}, {"flat", 0xc091e7333e04e5e6},
        {"mixed", 0x2886baec89dc1550},      {"static", 0x81b67ef8bd2f2680},   {"asleep", 0xe6defa4b706d83f7},
        {"coincident", 0x3dd8e46cf5118e48}, {"lattice", 0xe071fefdfaa584f4},  {"explosion", 0xaad24fdbdf8e91e5},
        {"rain", 0x2f032f22cca2727f},       {"pile", 0x79b8a1d3777ca69}};
    for (const TraceKind& kind : trace_kinds()) {
        const std::uint64_t hash = hash_of(kind.name, 1);
        EXPECT_EQ(golden.contains(std::string(kind.name)) ? golden.at(std::string(kind.name)) : 0, hash)
            << kind.name << " 0x" << std::hex << hash;
        EXPECT_EQ(hash_of(kind.name, 1), hash) << kind.name;
        if (kind.name != "lattice") {
            EXPECT_NE(hash_of(kind.name, 2), hash) << kind.name << ": another seed must give another trace";
        }
    }
}

TEST(GenerateTrace, UsesTheRequestedOrDefaultCounts) {
    for (const TraceKind& kind : trace_kinds()) {
        SCOPED_TRACE(kind.name);
        for (const std::size_t count : {1u, 2u, 77u}) {
            const GeneratedFrames generated = make(kind.name, count, 3);
            EXPECT_EQ(generated.flags.size(), count);
            EXPECT_EQ(generated.frames.size(), 3u);
        }
        EXPECT_GE(kind.default_count, 1000u);
        EXPECT_GE(kind.default_frames, 30u);
    }
    const GeneratedFrames generated = make("coincident", 0, 1);
    EXPECT_EQ(generated.flags.size(), 4000u);
    EXPECT_EQ(make("lattice", 10, 0).frames.size(), 60u);
}

TEST(GenerateTrace, RejectsUnknownKindsAndTooManyBoxes) {
    const TemporaryFolder folder;
    const auto unknown = generate_trace("gravel", {}, folder / "t.aabt");
    EXPECT_EQ(unknown.status(), Status::BadArgument);
    EXPECT_NE(unknown.error().problem.find("expected one of uniform, clusters"), std::string::npos);
    EXPECT_EQ(generate_trace("rain", {.count = 10'000'001}, folder / "t.aabt").status(), Status::BadArgument);
    EXPECT_EQ(generate_trace("rain", {}, folder / "none/t.aabt").status(), Status::Io);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(GenerateTrace, MostBoxesOfStaticAndAsleepRest) {
    const GeneratedFrames fixed = make("static", 2000, 40);
    EXPECT_GT(fixed.counts.static_boxes, 1900u);
    EXPECT_LT(fixed.counts.static_boxes, 2000u);
    EXPECT_EQ(fixed.moved_in(20), 2000 - fixed.counts.static_boxes);
    const GeneratedFrames asleep = make("asleep", 6000, 60);
    EXPECT_GT(asleep.counts.asleep_boxes, 5500u);
    EXPECT_GT(asleep.moved_in(59), asleep.moved_in(1)) << "some wake";
    EXPECT_LT(asleep.moved_in(59), 600u);
}

TEST(GenerateTrace, BoxesFallBounceAndComeToRest) {
    const GeneratedFrames pile = make("pile", 500, 240);
    EXPECT_EQ(pile.moved_in(1), 500u);
    EXPECT_LT(pile.moved_in(239), 50u) << "nearly all rest";
    EXPECT_GT(pile.pairs_in(239), 2 * pile.pairs_in(0) / 3);
    const GeneratedFrames explosion = make("explosion", 500, 120);
    EXPECT_GT(explosion.pairs_in(0), 10 * (explosion.pairs_in(119) + 1));
    for (const char* kind : {"flat", "rain", "explosion"}) {
        const GeneratedFrames generated = make(kind, 300, 120);
        std::size_t up = 0, down = 0;
        for (std::size_t f = 1; f < generated.frames.size(); ++f)
            for (std::size_t i = 0; i < 300; ++i) {
                up += generated.frames[f][i].lo.y > generated.frames[f - 1][i].lo.y ? 1 : 0;
                down += generated.frames[f][i].lo.y < generated.frames[f - 1][i].lo.y ? 1 : 0;
                ASSERT_GT(generated.frames[f][i].lo.y, -0.01f) << kind << ": none falls through the floor";
            }
        EXPECT_GT(up, 100u) << kind;
        EXPECT_GT(down, 100u) << kind;
    }
}

TEST(GenerateTrace, KindsHaveTheirDescribedProperties) {
    const GeneratedFrames coincident = make("coincident", 400, 10);
    for (const auto& frame : coincident.frames)
        for (std::size_t i = 0; i < 100; ++i) ASSERT_EQ(frame[i], frame[0]);
    const GeneratedFrames lattice = make("lattice", 1000, 17);
    EXPECT_EQ(lattice.frames[16], lattice.frames[0]) << "out and back";
    EXPECT_GT(lattice.pairs_in(0), 10000u) << "each touches 26 others, except at the faces";
    for (const Aabb& box : lattice.frames[3])
        ASSERT_EQ(box.lo.x * 4, static_cast<float>(static_cast<int>(box.lo.x * 4)));
    const GeneratedFrames mixed = make("mixed", 4000, 1);
    float smallest = 1e9f, largest = 0;
    for (const Aabb& box : mixed.frames[0]) {
        smallest = std::min(smallest, extent(box).x);
        largest = std::max(largest, extent(box).x);
    }
    EXPECT_GT(largest, 200 * smallest);
}

}  // namespace
}  // namespace fase::record
