/// Tests round trips: bodies are within the specified error, everything else is exact.
#include <gtest/gtest.h>

#include "fase/record/player.hpp"
#include "tests/record/artificial_run.hpp"

namespace fase::record {
namespace {

void expect_same_points(Vec3d a, Vec3d b) { EXPECT_LT(length(a - b), 0.0005); }

void expect_same(const Frame& read, const Frame& written, bool contacts) {
    EXPECT_EQ(read.number, written.number);
    EXPECT_EQ(read.step, written.step);
    EXPECT_EQ(read.time, written.time);
    EXPECT_EQ(read.total_ms, written.total_ms);
    EXPECT_EQ(read.stage_ms, written.stage_ms);
    EXPECT_EQ(read.counters, written.counters);
    ASSERT_EQ(read.bodies.size(), written.bodies.size());
    double worst_metres = 0, worst_degrees = 0;
    for (std::size_t i = 0; i < read.bodies.size(); ++i) {
        const BodyFrame &a = read.bodies[i], &b = written.bodies[i];
        ASSERT_EQ(a.row, b.row);
        EXPECT_EQ(a.kind, b.kind);
        EXPECT_EQ(a.awake, b.awake);
        EXPECT_EQ(a.quarantined, b.quarantined);
        EXPECT_EQ(a.island, b.island);
        worst_metres = std::max(worst_metres, length(a.pose.position - b.pose.position));
        worst_degrees = std::max(worst_degrees, degrees_between(a.pose.rotation, b.pose.rotation));
    }
    EXPECT_LT(worst_metres, 0.001);
    EXPECT_LT(worst_degrees, 0.1);
    EXPECT_EQ(read.contacts_begun, written.contacts_begun);
    EXPECT_EQ(read.contacts_ended, written.contacts_ended);
    EXPECT_EQ(read.sensors_begun, written.sensors_begun);
    EXPECT_EQ(read.sensors_ended, written.sensors_ended);
    ASSERT_EQ(read.hits.size(), written.hits.size());
    for (std::size_t i = 0; i < read.hits.size(); ++i) {
        EXPECT_EQ(read.hits[i].a, written.hits[i].a);
        EXPECT_EQ(read.hits[i].b, written.hits[i].b);
        expect_same_points(read.hits[i].point, written.hits[i].point);
        EXPECT_EQ(read.hits[i].normal, written.hits[i].normal);
        EXPECT_EQ(read.hits[i].speed, written.hits[i].speed);
        EXPECT_EQ(read.hits[i].impulse, written.hits[i].impulse);
    }
    ASSERT_EQ(read.contacts.size(), contacts ? written.contacts.size() : 0);
    for (std::size_t i = 0; i < read.contacts.size(); ++i) {
        const ContactFrame &a = read.contacts[i], &b = written.contacts[i];
        EXPECT_EQ(a.a, b.a);
        EXPECT_EQ(a.b, b.b);
        EXPECT_EQ(a.normal, b.normal);
        ASSERT_EQ(a.count, b.count);
        EXPECT_EQ(a.separations, b.separations);
        EXPECT_EQ(a.impulses, b.impulses);
        for (std::size_t p = 0; p < static_cast<std::size_t>(a.count); ++p)
            expect_same_points(a.points[p], b.points[p]);
    }
}

struct Case {
    double origin;
    bool contacts;
    std::uint32_t flush_frames;
};
class RoundTrip : public testing::TestWithParam<Case> {};

TEST_P(RoundTrip, EveryFrameReadsBackAsWritten) {
    const TemporaryFolder folder;
    const std::string name = folder / "run.faserec";
    const ArtificialRun run(200, GetParam().origin);
    RecorderOptions options;
    options.contacts = GetParam().contacts;
    options.flush_frames = GetParam().flush_frames;
    const Result<void> recorded = record_run(name, run, 150, options);
    ASSERT_TRUE(recorded) << recorded.error().text();
    EXPECT_FALSE(std::filesystem::exists(name + ".part"));

    Result<Player> player = Player::open(name);
    ASSERT_TRUE(player) << player.error().text();
    EXPECT_TRUE((*player).complete());
    EXPECT_EQ((*player).lost(), "");
    ASSERT_EQ((*player).frames(), 150u);
    Frame frame;
    for (std::uint64_t k = 0; k < 150; ++k) {
        const Result<void> read = (*player).read(k, frame);
        ASSERT_TRUE(read) << read.error().text();
        expect_same(frame, run.frame(k), GetParam().contacts);
    }
    for (const std::uint64_t k : {149u, 0u, 70u, 69u, 64u, 63u, 128u, 1u}) {
        const Result<void> read = (*player).read(k, frame);
        ASSERT_TRUE(read) << read.error().text();
        expect_same(frame, run.frame(k), GetParam().contacts);
    }
    EXPECT_EQ((*player).read(150, frame).status(), Status::OutOfRange);
}

INSTANTIATE_TEST_SUITE_P(All, RoundTrip,
                         testing::Values(Case{0, false, 64}, Case{0, true, 64}, Case{1e6, true, 7}, Case{1e7, false, 1},
                                         Case{-1e6, false, 64}));

TEST(Recording, TablesReadBackAsWritten) {
    const TemporaryFolder folder;
    const ArtificialRun run(50);
    ASSERT_TRUE(record_run(folder / "run.faserec", run, 3));
    const Result<Player> player = Player::open(folder / "run.faserec");
    ASSERT_TRUE(player);
    const Tables& tables = (*player).tables();
    Head head = ArtificialRun::head();
    head.quanta_per_metre = 2048;
    EXPECT_EQ(tables.head, head);
    ASSERT_EQ(tables.bodies.size(), 50u);
    ASSERT_EQ(tables.colliders.size(), 50u);
    for (std::uint32_t i = 0; i < 50; ++i) {
        EXPECT_EQ(tables.bodies[i], run.body(i));
        EXPECT_EQ(tables.colliders[i], run.collider(i));
    }
    ASSERT_EQ(tables.shapes.size(), 2u);
    EXPECT_EQ(tables.shapes[0].kind, ShapeKind::Box);
    EXPECT_EQ(tables.shapes[1].vertices.size(), 4u);
    EXPECT_EQ(tables.shapes[1].triangles.size(), 4u);
    ASSERT_EQ(tables.meshes.size(), 1u);
    EXPECT_EQ(tables.meshes[0].normals.size(), 3u);
    ASSERT_EQ(tables.visuals.size(), 1u);
    EXPECT_EQ(tables.visuals[0].pose.position, (Vec3{1, 2, 3}));
}

TEST(Recording, NeedsAtMost16BytesPerAwakeBodyAndFrameBeforeCompression) {
    const TemporaryFolder folder;
    for (const std::uint32_t bodies : {10u, 1000u, 20000u}) {
        const ArtificialRun run(bodies);
        Result<RecordingWriter> writer = RecordingWriter::create(folder / "run.faserec", ArtificialRun::head());
        ASSERT_TRUE(writer);
        ASSERT_TRUE(run.add_tables(*writer));
        std::uint64_t awake = 0;
        for (std::uint64_t k = 0; k < 20; ++k) {
            const Frame frame = run.frame(k);
            for (const BodyFrame& body : frame.bodies) awake += body.awake && k > 0 ? 1 : 0;
            ASSERT_TRUE((*writer).add_frame(frame));
        }
        ASSERT_TRUE((*writer).finish());
        const FrameCost cost = (*writer).cost();
        EXPECT_GT(cost.moves, awake * 9 / 10);  // all except the few that jump
        EXPECT_LE(double(cost.move_bytes) / double(cost.moves), 16);
        RecordProperty("bytes_per_body_" + std::to_string(bodies),
                       std::to_string(double(cost.move_bytes) / double(cost.moves)));
        RecordProperty("packed_bytes_per_body_" + std::to_string(bodies),
                       std::to_string(double((*writer).bytes()) / double(awake)));
    }
}

TEST(Recording, RejectsInvalidFramesAndContinues) {
    const TemporaryFolder folder;
    const ArtificialRun run(20);
    Result<RecordingWriter> writer = RecordingWriter::create(folder / "run.faserec", ArtificialRun::head());
    ASSERT_TRUE(writer);
    ASSERT_TRUE(run.add_tables(*writer));
    const Frame good = run.frame(0);
    const auto expect_rejected = [&](const Frame& frame) {
        EXPECT_EQ((*writer).add_frame(frame).status(), Status::BadArgument);
    };
    ASSERT_TRUE((*writer).add_frame(good));
    Frame bad = good;
    bad.bodies[3].pose.position.y = std::nan("");
    expect_rejected(bad);
    bad = good;
    bad.bodies[3].pose.position.y = 2e9;
    expect_rejected(bad);
    bad = good;
    bad.bodies[3].pose.rotation = {0, 0, 0, 0};
    expect_rejected(bad);
    bad = good;
    bad.bodies.back().row = 20;
    expect_rejected(bad);
    bad = good;
    std::swap(bad.bodies[3], bad.bodies[4]);
    expect_rejected(bad);
    bad = good;
    bad.stage_ms.pop_back();
    expect_rejected(bad);
    ASSERT_TRUE((*writer).add_frame(run.frame(1)));
    ASSERT_TRUE((*writer).finish());
    Result<Player> player = Player::open(folder / "run.faserec");
    ASSERT_TRUE(player);
    ASSERT_EQ((*player).frames(), 2u);
    const Result<Frame> second = (*player).frame(1);
    ASSERT_TRUE(second);
    expect_same(*second, run.frame(1), false);
}

TEST(Recording, EmptyRecordingOpens) {
    const TemporaryFolder folder;
    ASSERT_TRUE(record_run(folder / "run.faserec", ArtificialRun(0), 0));
    Result<Player> player = Player::open(folder / "run.faserec");
    ASSERT_TRUE(player) << player.error().text();
    EXPECT_EQ((*player).frames(), 0u);
    EXPECT_TRUE((*player).complete());
    EXPECT_EQ((*player).frame(0).status(), Status::OutOfRange);
}

}  // namespace
}  // namespace fase::record
