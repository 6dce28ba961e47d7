/// Tests box traces: round trips, and every kind of damaged file.
#include "fase/record/trace.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <bit>
#include <filesystem>
#include <limits>

#include "fase/core/random.hpp"
#include "tests/record/artificial_run.hpp"

namespace fase::record {
namespace {

constexpr float infinity = Aabb::infinity;
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

using Frames = std::vector<std::vector<Aabb>>;

/// Returns frames with moving boxes; every third box is static, and the first is a half-space.
Frames artificial_frames(std::size_t boxes, std::size_t frames) {
    Random random(7);
    Frames result(frames, std::vector<Aabb>(boxes));
    for (std::size_t i = 0; i < boxes; ++i) {
        const Vec3 lo{random.between(-9, 9), random.between(-9, 9), random.between(-9, 9)};
        Aabb box{lo, lo + Vec3{random.unit(), random.unit(), 0}};
        if (i == 0) box = {{-infinity, -infinity, -infinity}, {infinity, 0, infinity}};
        for (std::size_t f = 0; f < frames; ++f) {
            result[f][i] = box;
            const Vec3 offset{random.unit(), 0, -0.0f};
            if (i % 3 != 0) box = {box.lo + offset, box.hi + offset};
        }
    }
    return result;
}
std::vector<std::uint8_t> flags_for(std::size_t boxes) {
    std::vector<std::uint8_t> flags(boxes);
    for (std::size_t i = 0; i < boxes; ++i) flags[i] = i % 3 == 0 ? trace_static : i % 3 == 1 ? 0 : trace_asleep;
    return flags;
}

Result<void> write(const std::string& name, const Frames& frames, const std::vector<std::uint8_t>& flags) {
    Result<TraceWriter> writer = TraceWriter::create(name, frames.at(0).size());
    if (!writer) return writer.error();
    for (const auto& frame : frames)
        if (auto added = writer->add_frame(frame); !added) return added.error();
    return writer->finish(flags);
}

/// Reads all frames; returns them or the first error.
Result<Frames> read_all(const std::string& name) {
    Result<TraceReader> reader = TraceReader::open(name);
    if (!reader) return reader.error();
    Frames frames;
    for (std::vector<Aabb> boxes;;) {
        const Result<bool> more = reader->next(boxes);
        if (!more) return more.error();
        if (!*more) return frames;
        frames.push_back(boxes);
    }
}

/// A small trace as bytes, with functions to damage it.
class BrokenTrace : public ::testing::Test {
protected:
    static constexpr std::size_t boxes = 6, frames = 3, flags_at = 16, boxes_at = 16 + 8;
    static constexpr std::size_t at(std::size_t frame, std::size_t body, std::size_t number) {
        return boxes_at + ((frame * boxes + body) * 6 + number) * 4;
    }
    void SetUp() override {
        ASSERT_TRUE(write(name, artificial_frames(boxes, frames), flags_for(boxes)));
        good = read_file(name);
        ASSERT_EQ(good.size(), boxes_at + boxes * frames * 24);
    }
    static void put(std::string& bytes, std::size_t offset, std::uint32_t value) {
        for (std::size_t i = 0; i < 4; ++i) bytes[offset + i] = static_cast<char>(value >> (8 * i));
    }
    static void put(std::string& bytes, std::size_t offset, float value) {
        put(bytes, offset, std::bit_cast<std::uint32_t>(value));
    }
    /// Expects that the bytes are rejected with Format, and that the error contains the offset and the text.
    void expect_rejected(const std::string& bytes, std::size_t offset, const std::string& text) {
        write_file(name, bytes);
        const Result<Frames> read = read_all(name);
        ASSERT_FALSE(read) << text;
        EXPECT_EQ(read.status(), Status::Format) << read.error().text();
        EXPECT_EQ(read.error().where, name + ": byte " + std::to_string(offset)) << read.error().text();
        EXPECT_NE(read.error().problem.find(text), std::string::npos) << read.error().text();
    }
    TemporaryFolder folder;
    std::string name = folder / "t.aabt", good;
};

TEST(Trace, ReadsBackAsWritten) {
    const TemporaryFolder folder;
    for (const std::size_t boxes : {1u, 2u, 3u, 4u, 5u, 40000u}) {
        const std::string name = folder / "t.aabt";
        const Frames frames = artificial_frames(boxes, 3);
        const auto flags = flags_for(boxes);
        ASSERT_TRUE(write(name, frames, flags));
        EXPECT_EQ(std::filesystem::file_size(name), 16 + (boxes + 3) / 4 * 4 + boxes * 3 * 24);
        Result<TraceReader> reader = TraceReader::open(name);
        ASSERT_TRUE(reader) << reader.error().text();
        EXPECT_EQ(reader->boxes(), boxes);
        EXPECT_EQ(reader->frames(), 3u);
        EXPECT_TRUE(std::equal(flags.begin(), flags.end(), reader->flags().begin(), reader->flags().end()));
        const Result<Frames> back = read_all(name);
        ASSERT_TRUE(back) << back.error().text();
        EXPECT_TRUE(*back == frames);
    }
}

TEST(Trace, FlagsGiveTheMotionStates) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write(folder / "t.aabt", Frames{std::vector<Aabb>(4, {{0, 0, 0}, {1, 1, 1}})},
                      {0, trace_asleep, trace_static, 3}));
    const Result<TraceReader> reader = TraceReader::open(folder / "t.aabt");
    ASSERT_TRUE(reader) << reader.error().text();
    EXPECT_EQ(reader->motion_states(),
              (std::vector{MotionState::Awake, MotionState::Asleep, MotionState::Static, MotionState::Static}));
}

TEST(Trace, RewindRestartsAtTheFirstFrame) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write(folder / "t.aabt", artificial_frames(9, 2), flags_for(9)));
    Result<TraceReader> reader = TraceReader::open(folder / "t.aabt");
    ASSERT_TRUE(reader);
    std::vector<Aabb> boxes, first;
    ASSERT_TRUE(*reader->next(first));
    ASSERT_TRUE(*reader->next(boxes));
    ASSERT_FALSE(*reader->next(boxes));
    EXPECT_TRUE(boxes.empty());
    reader->rewind();
    ASSERT_TRUE(*reader->next(boxes));
    EXPECT_TRUE(boxes == first);
}

TEST(Trace, SharedTracesAreReadCompletely) {
    const std::filesystem::path traces = std::filesystem::path(FASE_SHARED_DATA) / "traces";
    if (!std::filesystem::exists(traces)) GTEST_SKIP() << "skipped: " << traces << " is missing";
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(traces)) {
        if (entry.path().extension() != ".aabt") continue;
        const Result<Frames> read = read_all(entry.path().string());
        ASSERT_TRUE(read) << read.error().text();
        EXPECT_GE(read->size(), 1u);
        ++count;
    }
    EXPECT_GE(count, 3u);
}

TEST_F(BrokenTrace, TruncatedFileIsRejected) {
    for (std::size_t length = 0; length < good.size(); ++length) {
        write_file(name, good.substr(0, length));
        const Result<Frames> read = read_all(name);
        ASSERT_FALSE(read) << length;
        ASSERT_EQ(read.status(), Status::Format) << read.error().text();
        ASSERT_TRUE(read.error().where.starts_with(name)) << read.error().text();
    }
    expect_rejected(good.substr(0, at(1, 2, 3)), at(1, 2, 3), "frame 1, body 2: found the end of the file");
}

TEST_F(BrokenTrace, FileWithAFlippedBitIsRejectedOrStillValid) {
    std::size_t rejected = 0;
    for (std::size_t byte = 0; byte < good.size(); ++byte) {
        for (int bit = 0; bit < 8; ++bit) {
            std::string bytes = good;
            bytes[byte] = static_cast<char>(bytes[byte] ^ (1 << bit));
            write_file(name, bytes);
            const Result<Frames> read = read_all(name);
            if (read) {
                ASSERT_EQ(read->size(), frames);
                ASSERT_GE(byte, 16u) << "a changed head must be rejected";
                continue;
            }
            ++rejected;
            ASSERT_EQ(read.status(), Status::Format) << read.error().text();
            ASSERT_TRUE(read.error().where.starts_with(name)) << read.error().text();
        }
    }
    EXPECT_GT(rejected, 16u * 8u);
}

TEST_F(BrokenTrace, HeadIsCheckedFirst) {
    std::string bytes = good;
    bytes[0] = 'B';
    for (const auto& [other, kind] :
         {std::pair(bytes, "another kind of file"), std::pair(std::string(), "an empty file")}) {
        write_file(name, other);
        const Result<Frames> read = read_all(name);
        ASSERT_FALSE(read);
        EXPECT_EQ(read.error().text(), name + ": found " + kind + "; expected a trace, which begins with AABT");
    }
    bytes = good;
    put(bytes, 4, 7u);
    expect_rejected(bytes, 4, "found version 7; this program reads 1");
    bytes = good;
    put(bytes, 8, 0u);
    expect_rejected(bytes, 8, "found 0 boxes");
    bytes = good;
    put(bytes, 12, 0u);
    expect_rejected(bytes, 12, "found 0 frames");
    expect_rejected(good + "x", good.size(), "found 1 bytes after the last of 3 frames");
    bytes = good;
    put(bytes, 12, 2u);
    expect_rejected(bytes, at(2, 0, 0), "after the last of 2 frames");
    bytes = good;
    bytes[flags_at + 5] = 4;
    expect_rejected(bytes, flags_at + 5, "body 5: found flags 4; expected 0 to 3");
    bytes = good;
    bytes[flags_at + 7] = 1;
    expect_rejected(bytes, flags_at + 7, "found 1 after the flags");
}

TEST_F(BrokenTrace, ImpossibleCountsAllocateNoMemory) {
    struct rusage before {
    }, after{};
    getrusage(RUSAGE_SELF, &before);
    for (const std::uint32_t count : {0xffffffffu, 0xfffffffcu, 0x80000000u, 0x0aaaaaabu}) {
        std::string bytes = good;
        put(bytes, 8, count);
        expect_rejected(bytes, 16, "of flags; expected " + std::to_string(count));
        bytes = good;
        put(bytes, 12, count);
        expect_rejected(bytes, good.size(), "found the end of the file after 3 frames");
        put(bytes, 8, count);
        expect_rejected(bytes, 16, "of flags; expected");
    }
    getrusage(RUSAGE_SELF, &after);
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 64 * 1024);
}

TEST_F(BrokenTrace, ErrorNamesFrameAndBodyOfAnInvalidBox) {
    const auto with = [&](std::size_t frame, std::size_t body, std::size_t number, float value) {
        std::string bytes = good;
        put(bytes, at(frame, body, number), value);
        return bytes;
    };
    expect_rejected(with(1, 4, 2, not_a_number), at(1, 4, 2), "frame 1, body 4: found NaN as lower z");
    expect_rejected(with(0, 2, 3, -not_a_number), at(0, 2, 3), "frame 0, body 2: found NaN as upper x");
    expect_rejected(with(2, 5, 4, -1e9f), at(2, 5, 1), "frame 2, body 5: found lower y");
    expect_rejected(with(0, 1, 0, infinity), at(0, 1, 0), "above upper x");
    std::string bytes = with(0, 1, 0, infinity);
    put(bytes, at(0, 1, 3), infinity);
    expect_rejected(bytes, at(0, 1, 0), "not at infinity");
    expect_rejected(with(2, 3, 5, 1e9f), at(2, 3, 0), "frame 2, body 3: found a static body whose box moved");
    // The first frame defines the box of a static body, so the error is in the second frame.
    expect_rejected(with(0, 3, 5, 1e9f), at(1, 3, 0), "frame 1, body 3: found a static body whose box moved");
}

TEST_F(BrokenTrace, InfiniteBoxesAndMinusZeroAreValid) {
    std::string bytes = good;
    put(bytes, at(1, 4, 0), -infinity);
    put(bytes, at(1, 4, 3), infinity);
    put(bytes, at(2, 3, 2), -0.0f);
    for (const std::size_t frame : {0, 1, 2})
        for (const std::size_t number : {2, 5}) put(bytes, at(frame, 3, number), frame == 1 ? 0.0f : -0.0f);
    write_file(name, bytes);
    const Result<Frames> read = read_all(name);
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ((*read)[1][4].hi.x, infinity);
}

TEST_F(BrokenTrace, SpecialFilesAreRejected) {
    EXPECT_EQ(TraceReader::open(folder / "none.aabt").status(), Status::Io);
    EXPECT_EQ(TraceReader::open(folder.path()).status(), Status::Io);
    EXPECT_EQ(TraceReader::open("/dev/zero").status(), Status::Io);
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_EQ(TraceReader::open(folder / "pipe").status(), Status::Io);
}

TEST(TraceWriter, RenamesTheFileWhenItIsComplete) {
    const TemporaryFolder folder;
    const std::string name = folder / "t.aabt";
    write_file(name, "old");
    Result<TraceWriter> writer = TraceWriter::create(name, 4);
    ASSERT_TRUE(writer) << writer.error().text();
    EXPECT_EQ(TraceWriter::create(name, 4).status(), Status::Busy);
    for (const auto& frame : artificial_frames(4, 2)) ASSERT_TRUE(writer->add_frame(frame));
    EXPECT_EQ(read_file(name), "old");
    EXPECT_EQ(TraceReader::open(name + ".part").status(), Status::Format) << "its frame count is still 0";
    ASSERT_TRUE(writer->finish(flags_for(4)));
    EXPECT_TRUE(read_all(name));
    EXPECT_FALSE(std::filesystem::exists(name + ".part"));
    EXPECT_FALSE(writer->add_frame(artificial_frames(4, 1)[0])) << "the file is closed";
}

TEST(TraceWriter, RejectsWhatAReaderWouldReject) {
    const TemporaryFolder folder;
    EXPECT_EQ(TraceWriter::create(folder / "t.aabt", 0).status(), Status::BadArgument);
    EXPECT_EQ(TraceWriter::create("/dev/null", 4).status(), Status::Io);
    EXPECT_EQ(TraceWriter::create(folder / "none/t.aabt", 4).status(), Status::Io);
    Result<TraceWriter> writer = TraceWriter::create(folder / "t.aabt", 4);
    ASSERT_TRUE(writer);
    EXPECT_EQ(writer->finish(flags_for(4)).status(), Status::BadArgument) << "without a frame";
    const Frames frames = artificial_frames(4, 2);
    EXPECT_EQ(writer->add_frame(artificial_frames(5, 1)[0]).status(), Status::BadArgument);
    for (const Aabb& bad : {Aabb{}, Aabb{{0, 0, not_a_number}, {1, 1, 1}}, Aabb{{infinity, 0, 0}, {infinity, 1, 1}}}) {
        std::vector<Aabb> boxes = frames[0];
        boxes[2] = bad;
        const Result<void> added = writer->add_frame(boxes);
        EXPECT_EQ(added.status(), Status::BadArgument);
        EXPECT_EQ(added.error().where, "frame 0, body 2");
    }
    for (const auto& frame : frames) ASSERT_TRUE(writer->add_frame(frame));
    EXPECT_FALSE(writer->moved(0));
    EXPECT_TRUE(writer->moved(1));
    const std::vector<std::uint8_t> one_moves(4, trace_static), unknown(4, 8), few(3, 0);
    for (const auto& flags : {one_moves, unknown, few}) EXPECT_EQ(writer->finish(flags).status(), Status::BadArgument);
    EXPECT_TRUE(writer->finish(flags_for(4)));
    EXPECT_TRUE(*read_all(folder / "t.aabt") == frames);
}

TEST(TraceWriter, DiscardRemovesTheFile) {
    const TemporaryFolder folder;
    Result<TraceWriter> writer = TraceWriter::create(folder / "t.aabt", 4);
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->add_frame(artificial_frames(4, 1)[0]));
    writer->discard();
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    EXPECT_EQ(writer->add_frame(artificial_frames(4, 1)[0]).status(), Status::Io);
    EXPECT_EQ(writer->finish(flags_for(4)).status(), Status::Io);
}

TEST(TraceWriter, LeavesTheWrittenFramesInThePartOnAFullDisk) {
    const TemporaryFolder folder;
    const std::string name = folder / "t.aabt";
    write_file(name, "an older trace");
    Result<TraceWriter> writer = TraceWriter::create(name, 400);
    ASSERT_TRUE(writer);
    struct rlimit before {};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit small{25000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    const Frames frames = artificial_frames(400, 3);
    std::vector<Status> statuses;
    std::string problem;
    for (const auto& frame : frames) {
        const Result<void> added = writer->add_frame(frame);
        statuses.push_back(added.status());
        if (!added) problem = added.error().problem;
    }
    const Result<void> finished = writer->finish(flags_for(400));
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_EQ(statuses, (std::vector<Status>{Status::Ok, Status::Ok, Status::Io}));
    EXPECT_NE(problem.find("wrote 2 frames, 19616 bytes"), std::string::npos) << problem;
    ASSERT_FALSE(finished);
    EXPECT_EQ(finished.error().where, name + ".part");
    EXPECT_EQ(read_file(name), "an older trace");
    const Result<Frames> back = read_all(name + ".part");
    ASSERT_TRUE(back) << back.error().text();
    EXPECT_EQ(back->size(), 2u);
}

}  // namespace
}  // namespace fase::record
