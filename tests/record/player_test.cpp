/// Tests reading: damaged files open up to the damage, and no input causes a crash.
#include "fase/record/player.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstring>
#include <functional>

#include "fase/record/recording/bytes.hpp"
#include "fase/record/recording/chunk_packer.hpp"
#include "fase/record/recording/crc32.hpp"
#include "tests/record/artificial_run.hpp"

namespace fase::record {
namespace {

/// A small recording of several blocks as bytes, with the end of each chunk.
struct Sample {
    std::string bytes;
    std::vector<std::size_t> ends;
    std::vector<std::uint64_t> frames_at;  ///< readable frames if the chunk of the same index in `ends` is complete

    explicit Sample(const TemporaryFolder& folder, std::uint32_t bodies = 12, std::uint64_t frames = 20) {
        RecorderOptions options;
        options.flush_frames = 5;
        options.contacts = true;
        EXPECT_TRUE(record_run(folder / "sample", ArtificialRun(bodies), frames, options));
        bytes = read_file(folder / "sample");
        std::size_t at = 16;
        std::uint64_t so_far = 0;
        while (at + 12 < bytes.size()) {
            std::uint32_t length = 0;
            std::memcpy(&length, bytes.data() + at + 4, 4);
            const std::string type = bytes.substr(at, 4);
            if (type == "FRMS") so_far += options.flush_frames;
            at += length + 12;
            ends.push_back(at);
            frames_at.push_back(so_far);
            if (type == "INDX") break;
        }
        EXPECT_EQ(at + 16, bytes.size());
    }
    [[nodiscard]] std::uint64_t complete_frames(std::size_t good_bytes) const {
        std::uint64_t frames = 0;
        for (std::size_t i = 0; i < ends.size() && ends[i] <= good_bytes; ++i) frames = frames_at[i];
        return frames;
    }
};

/// Opens a file and reads all frames. Returns their number; -1 if it does not open.
std::int64_t read_all(const std::string& name, bool* complete = nullptr) {
    Result<Player> player = Player::open(name);
    if (!player) {
        EXPECT_NE(player.error().text(), "");
        return -1;
    }
    if (complete != nullptr) *complete = (*player).complete();
    EXPECT_EQ((*player).complete(), (*player).lost().empty());
    Frame frame;
    for (std::uint64_t k = 0; k < (*player).frames(); ++k) {
        const Result<void> read = (*player).read(k, frame);
        EXPECT_TRUE(read) << read.error().text();
    }
    return static_cast<std::int64_t>((*player).frames());
}

TEST(Player, OpensATruncatedFileUpToItsLastCompleteBlock) {
    const TemporaryFolder folder;
    const Sample sample(folder);
    const std::string name = folder / "cut";
    for (std::size_t length = 0; length < sample.bytes.size(); ++length) {
        write_file(name, sample.bytes.substr(0, length));
        bool complete = true;
        const std::int64_t frames = read_all(name, &complete);
        if (length < sample.ends[0]) {
            EXPECT_EQ(frames, -1) << length;
        } else {
            EXPECT_EQ(frames, static_cast<std::int64_t>(sample.complete_frames(length))) << length;
            EXPECT_FALSE(complete) << length;
        }
    }
    write_file(name, sample.bytes);
    bool complete = false;
    EXPECT_EQ(read_all(name, &complete), 20);
    EXPECT_TRUE(complete);
}

TEST(Player, AFileThatIsCutBeforeItsFirstFramesHasNoCompleteFrame) {
    const TemporaryFolder folder;
    const Sample sample(folder);
    const std::string name = folder / "cut", problem = name + ": found no complete frame; expected at least one";
    for (std::size_t length = 1; length < sample.bytes.size(); ++length) {
        write_file(name, sample.bytes.substr(0, length));
        const Result<Player> player = Player::open(name);
        if (!player) {
            EXPECT_LT(length, sample.ends[0]);
            EXPECT_TRUE(player.error().text().starts_with(problem)) << player.error().text();
            EXPECT_EQ(player.status(), Status::Format);
            continue;
        }
        const Result<void> has_frames = player->check_has_frames();
        EXPECT_EQ(has_frames.has_value(), sample.complete_frames(length) > 0) << length;
        if (!has_frames) {
            EXPECT_EQ(has_frames.error().text(), problem) << length;
            EXPECT_NE(player->lost().find("no complete frame"), std::string::npos) << player->lost();
        }
    }
}

TEST(Player, OpensAFileWithAnyBitFlippedUpToTheDamage) {
    const TemporaryFolder folder;
    const Sample sample(folder, 8, 10);
    const std::string name = folder / "flipped";
    for (std::size_t at = 0; at < sample.bytes.size(); ++at) {
        for (int bit = 0; bit < 8; ++bit) {
            std::string bytes = sample.bytes;
            bytes[at] = static_cast<char>(bytes[at] ^ (1 << bit));
            write_file(name, bytes);
            bool complete = true;
            const std::int64_t frames = read_all(name, &complete);
            if (at < sample.ends[0]) {
                EXPECT_EQ(frames, -1) << at;
            } else if (at < sample.bytes.size() - 16) {  // before the tail, which the scan does not need
                EXPECT_EQ(frames, static_cast<std::int64_t>(sample.complete_frames(at))) << at;
                EXPECT_FALSE(complete) << at;
            }
        }
    }
}

/// Returns the recording with one chunk unpacked, changed and packed again with a correct checksum.
std::string with_changed_chunk(const std::string& bytes, std::size_t begin, std::size_t end,
                               const std::function<void(std::vector<std::byte>&)>& change) {
    std::uint32_t type = 0;
    std::memcpy(&type, bytes.data() + begin, 4);
    const auto body = std::as_bytes(std::span(bytes).subspan(begin + 8, end - begin - 12));
    Result<std::vector<std::byte>> raw = unpack({ChunkType{type}, body});
    EXPECT_TRUE(raw);
    change(*raw);
    ChunkPacker packer;
    std::vector<std::byte> chunk;
    EXPECT_TRUE(packer.append(ChunkType{type}, *raw, chunk));
    return bytes.substr(0, begin) + std::string(reinterpret_cast<const char*>(chunk.data()), chunk.size()) +
           bytes.substr(end);
}

TEST(Player, SurvivesWrongNumbersUnderCorrectChecksums) {
    const TemporaryFolder folder;
    const Sample sample(folder, 8, 10);
    const std::string name = folder / "wrong";
    std::uint64_t rejected = 0, tried = 0;
    for (std::size_t c = 0; c < sample.ends.size(); ++c) {
        const std::size_t begin = c == 0 ? 16 : sample.ends[c - 1];
        std::size_t raw_size = 0;
        with_changed_chunk(sample.bytes, begin, sample.ends[c], [&](auto& raw) { raw_size = raw.size(); });
        for (std::size_t at = 0; at < raw_size; ++at) {
            for (const int change : {1, 0x80, 0xff}) {
                write_file(name, with_changed_chunk(sample.bytes, begin, sample.ends[c],
                                                    [&](auto& raw) { raw[at] ^= static_cast<std::byte>(change); }));
                ++tried;
                Result<Player> player = Player::open(name);
                if (!player) {
                    ++rejected;
                    continue;
                }
                Frame frame;
                bool all = (*player).complete();
                for (std::uint64_t k = 0; k < (*player).frames(); ++k) {
                    const Result<void> read = (*player).read(k, frame);
                    all = all && read.has_value();
                    for (const BodyFrame& body : frame.bodies) {
                        ASSERT_LT(body.row, (*player).tables().bodies.size());
                        ASSERT_LT(body.kind, 3);
                    }
                    for (const HitFrame& hit : frame.hits) ASSERT_LT(hit.b, (*player).tables().colliders.size());
                }
                if (!all) ++rejected;
            }
        }
        for (std::size_t length = 0; length < raw_size; ++length) {
            write_file(name,
                       with_changed_chunk(sample.bytes, begin, sample.ends[c], [&](auto& raw) { raw.resize(length); }));
            Result<Player> player = Player::open(name);
            if (!player) continue;
            Frame frame;
            for (std::uint64_t k = 0; k < (*player).frames(); ++k) (void)(*player).read(k, frame);
        }
    }
    EXPECT_GT(rejected, tried / 20);  // many changes only change values
}

TEST(Player, RejectsAChunkThatExpandsTooMuch) {
    const TemporaryFolder folder;
    const Sample sample(folder);
    // A block of 48 MiB of zeros, which would compress to a few bytes.
    const std::vector<std::byte> zeros(std::size_t(48) << 20);
    ChunkPacker packer;
    std::vector<std::byte> uncompressed;
    ASSERT_TRUE(packer.append(frames_chunk, zeros, uncompressed));
    EXPECT_GT(uncompressed.size(), zeros.size());  // a writer stores it uncompressed
    // A reader rejects a compressed chunk that states the same length.
    std::vector<std::byte> packed;
    ASSERT_TRUE(packer.append(frames_chunk, std::span(zeros).first(std::size_t(4) << 20), packed));
    ASSERT_LT(packed.size(), 10000u);
    ByteWriter body;
    body.put_bytes(std::span<const std::byte>(packed).subspan(0, packed.size() - 4));
    body.set_u32(12, 48u << 20);
    const std::span<const std::byte> claimed = body.bytes().subspan(8);
    EXPECT_EQ(raw_length({frames_chunk, claimed}).status(), Status::Format);
    EXPECT_EQ(unpack({frames_chunk, claimed}).status(), Status::Format);
    // A stated length within the limits, but too large or too small.
    body.set_u32(12, (4u << 20) + 1);
    EXPECT_EQ(unpack({frames_chunk, body.bytes().subspan(8)}).status(), Status::Format);
    body.set_u32(12, (4u << 20) - 1);
    EXPECT_EQ(unpack({frames_chunk, body.bytes().subspan(8)}).status(), Status::Format);
}

TEST(Player, NamesTheVersionOfANewerFile) {
    const TemporaryFolder folder;
    Sample sample(folder);
    sample.bytes[8] = 7;
    const std::uint32_t check = crc32(std::as_bytes(std::span(sample.bytes).first(12)));
    std::memcpy(sample.bytes.data() + 12, &check, 4);
    write_file(folder / "newer", sample.bytes);
    const Result<Player> player = Player::open(folder / "newer");
    ASSERT_FALSE(player);
    EXPECT_EQ(player.status(), Status::Format);
    EXPECT_NE(player.error().text().find("found version 7; this program reads 1"), std::string::npos);
}

TEST(Player, SkipsChunksOfUnknownType) {
    const TemporaryFolder folder;
    const Sample sample(folder);
    ChunkPacker packer;
    std::vector<std::byte> chunk;
    ASSERT_TRUE(packer.append(chunk_type("NEWS"), std::as_bytes(std::span("something")), chunk));
    std::string bytes = sample.bytes;
    bytes.insert(sample.ends[3], std::string(reinterpret_cast<const char*>(chunk.data()), chunk.size()));
    write_file(folder / "news", bytes);
    EXPECT_EQ(read_all(folder / "news"), 20);
}

TEST(Player, RejectsInputThatIsNotARecording) {
    const TemporaryFolder folder;
    EXPECT_EQ(Player::open(folder / "nothing").status(), Status::Io);
    EXPECT_EQ(Player::open(folder.path()).status(), Status::Io);
    EXPECT_EQ(Player::open("/dev/zero").status(), Status::Io);
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_EQ(Player::open(folder / "pipe").status(), Status::Io);
    write_file(folder / "text", "FASEtte and other words that are long enough to be read");
    EXPECT_EQ(Player::open(folder / "text").status(), Status::Format);
    write_file(folder / "empty", "");
    EXPECT_EQ(Player::open(folder / "empty").status(), Status::Format);
}

TEST(Player, ReportsAnErrorWhenTheFileShrinksOrChanges) {
    const TemporaryFolder folder;
    const Sample sample(folder);
    const std::string name = folder / "shrinking";
    write_file(name, sample.bytes);
    Result<Player> player = Player::open(name);
    ASSERT_TRUE(player);
    ASSERT_TRUE((*player).frame(3));
    std::filesystem::resize_file(name, sample.ends[3]);
    EXPECT_FALSE((*player).frame(19));
    std::string bytes = sample.bytes;
    std::fill(bytes.begin() + 100, bytes.end(), 'x');
    const auto overwrite = [&](const std::string& with) {  // in place; write_file() would create a new file
        std::fstream(name, std::ios::binary | std::ios::in | std::ios::out)
            .write(with.data(), static_cast<std::streamsize>(with.size()));
    };
    overwrite(bytes);
    const Result<Frame> changed = (*player).frame(19);
    EXPECT_EQ(changed.status(), Status::Format);
    overwrite(sample.bytes);
    EXPECT_TRUE((*player).frame(19));
}

TEST(Index, ListsEveryChunkAndItsFrames) {
    const TemporaryFolder folder;
    const Sample sample(folder);
    std::uint64_t index_at = 0;
    std::memcpy(&index_at, sample.bytes.data() + sample.bytes.size() - 16, 8);
    ASSERT_EQ(index_at, sample.ends[sample.ends.size() - 2]);
    const auto body = std::as_bytes(std::span(sample.bytes).subspan(index_at + 8, sample.ends.back() - index_at - 12));
    const Result<std::vector<std::byte>> raw = unpack({index_chunk, body});
    ASSERT_TRUE(raw);
    ByteReader in(*raw);
    ASSERT_EQ(in.get<std::uint32_t>(), sample.ends.size() - 1);
    std::size_t at = 16;
    std::uint64_t frames = 0;
    for (std::size_t i = 0; i + 1 < sample.ends.size(); ++i) {
        const auto type = in.get<std::uint32_t>();
        EXPECT_EQ(in.get<std::uint64_t>(), at);
        const bool block = ChunkType{type} == frames_chunk;
        EXPECT_EQ(in.get<std::uint64_t>(), block ? frames : 0);
        EXPECT_EQ(in.get<std::uint32_t>(), block ? 5u : 0u);
        frames += block ? 5 : 0;
        at = sample.ends[i];
    }
    EXPECT_FALSE(in.failed());
    EXPECT_EQ(in.remaining(), 0u);
}

}  // namespace
}  // namespace fase::record
