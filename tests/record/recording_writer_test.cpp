/// Tests a killed program, a full disk, and two recorders with the same file.
#include "fase/record/recording_writer.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <atomic>
#include <chrono>
#include <new>
#include <thread>

#include "fase/record/player.hpp"
#include "tests/record/artificial_run.hpp"

namespace fase::record {
namespace {

using namespace std::chrono_literals;

/// The progress that a child process reports to its parent.
struct Progress {
    std::atomic<std::uint64_t> frames{0}, flushed{0};
};

class SharedProgress {
public:
    SharedProgress()
        : memory_(::mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)),
          progress_(new (memory_) Progress) {}
    ~SharedProgress() { ::munmap(memory_, sizeof(Progress)); }
    SharedProgress(const SharedProgress&) = delete;
    SharedProgress& operator=(const SharedProgress&) = delete;
    Progress* operator->() const { return progress_; }

private:
    void* memory_;
    Progress* progress_;
};

/// Records until the process is killed.
[[noreturn]] void record_forever(const std::string& name, const SharedProgress& progress) {
    const ArtificialRun run(300);
    Result<RecordingWriter> writer = RecordingWriter::create(name, ArtificialRun::head());
    if (!writer || !run.add_tables(*writer)) ::_exit(1);
    for (std::uint64_t k = 0;; ++k) {
        if (!(*writer).add_frame(run.frame(k))) ::_exit(1);
        progress->frames = (*writer).frames();
        progress->flushed = (*writer).frames_flushed();
    }
}

TEST(KilledRecording, OpensUpToTheLastFlushedFrame) {
    const TemporaryFolder folder;
    const std::string name = folder / "run.faserec";
    const ArtificialRun run(300);
    for (int attempt = 0; attempt < 20; ++attempt) {
        SharedProgress progress;
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) record_forever(name, progress);
        while (progress->flushed == 0) std::this_thread::sleep_for(1ms);
        std::this_thread::sleep_for(std::chrono::microseconds(3137 * attempt));
        ::kill(child, SIGKILL);
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        ASSERT_TRUE(WIFSIGNALED(status));

        EXPECT_FALSE(std::filesystem::exists(name));
        Result<Player> player = Player::open(name);  // finds NAME.part
        ASSERT_TRUE(player) << player.error().text();
        EXPECT_EQ((*player).path(), name + ".part");
        EXPECT_FALSE((*player).complete());
        EXPECT_NE((*player).lost(), "");
        EXPECT_GE((*player).frames(), progress->flushed);             // no flushed frame is lost
        EXPECT_GE((*player).frames() + 65, progress->frames.load());  // at most one block is lost
        Frame frame;
        for (std::uint64_t k = 0; k < (*player).frames(); ++k) {
            const Result<void> read = (*player).read(k, frame);
            ASSERT_TRUE(read) << read.error().text();
            EXPECT_EQ(frame.step, k + 1);
        }
        const Frame last = run.frame((*player).frames() - 1);
        ASSERT_EQ(frame.bodies.size(), last.bodies.size());
        for (std::size_t i = 0; i < last.bodies.size(); ++i) {
            EXPECT_LT(length(frame.bodies[i].pose.position - last.bodies[i].pose.position), 0.001);
        }
    }
    // Each new recording renamed the file of the previous, killed one.
    EXPECT_TRUE(std::filesystem::exists(name + ".lost"));
    EXPECT_TRUE(std::filesystem::exists(name + ".lost19"));
    EXPECT_FALSE(std::filesystem::exists(name + ".lost20"));
    EXPECT_TRUE(Player::open(name + ".lost19"));
}

TEST(Recording, IsFlushedInTimeEvenIfStepsAreSlow) {
    const TemporaryFolder folder;
    const ArtificialRun run(5);
    RecorderOptions options;
    options.flush_seconds = 0.05;
    Result<RecordingWriter> writer = RecordingWriter::create(folder / "run.faserec", ArtificialRun::head(), options);
    ASSERT_TRUE(writer);
    ASSERT_TRUE(run.add_tables(*writer));
    std::uint64_t k = 0;
    for (; k < 3; ++k) {
        ASSERT_TRUE((*writer).add_frame(run.frame(k)));
        std::this_thread::sleep_for(60ms);
    }
    EXPECT_GE((*writer).frames_flushed() + 1, k);  // steps are slower than the interval: only one frame can be pending
    ASSERT_TRUE((*writer).add_frame(run.frame(k++)));
    EXPECT_EQ((*writer).frames_flushed(), k);
}

TEST(Recording, IsWrittenEvery64Frames) {
    const TemporaryFolder folder;
    const ArtificialRun run(5);
    RecorderOptions options;
    options.flush_seconds = 3600;
    Result<RecordingWriter> writer = RecordingWriter::create(folder / "run.faserec", ArtificialRun::head(), options);
    ASSERT_TRUE(writer);
    ASSERT_TRUE(run.add_tables(*writer));
    for (std::uint64_t k = 0; k < 130; ++k) {
        ASSERT_TRUE((*writer).add_frame(run.frame(k)));
        EXPECT_EQ((*writer).frames_flushed(), (k + 1) / 64 * 64);
        if (k == 70) {
            const Result<Player> meanwhile = Player::open(folder / "run.faserec");
            ASSERT_TRUE(meanwhile);
            EXPECT_EQ((*meanwhile).frames(), 64u);
        }
    }
}

TEST(TwoRecorders, TheSecondOneIsRejected) {
    const TemporaryFolder folder;
    const std::string name = folder / "run.faserec";
    Result<RecordingWriter> first = RecordingWriter::create(name, ArtificialRun::head());
    ASSERT_TRUE(first);
    const Result<RecordingWriter> second = RecordingWriter::create(name, ArtificialRun::head());
    ASSERT_FALSE(second);
    EXPECT_EQ(second.status(), Status::Busy);
    ASSERT_TRUE((*first).finish());
    EXPECT_TRUE(RecordingWriter::create(name, ArtificialRun::head()));
}

TEST(TwoRecorders, TheSecondProcessIsRejected) {
    const TemporaryFolder folder;
    const std::string name = folder / "run.faserec";
    SharedProgress progress;
    const pid_t child = ::fork();
    if (child == 0) record_forever(name, progress);
    while (progress->flushed == 0) std::this_thread::sleep_for(1ms);
    const Result<RecordingWriter> second = RecordingWriter::create(name, ArtificialRun::head());
    EXPECT_EQ(second.status(), Status::Busy);
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    EXPECT_TRUE(RecordingWriter::create(name, ArtificialRun::head()));
}

TEST(Recording, ReplacesAnOlderOneOnlyWhenItIsFinished) {
    const TemporaryFolder folder;
    const std::string name = folder / "run.faserec";
    ASSERT_TRUE(record_run(name, ArtificialRun(3), 5));
    const std::string older = read_file(name);
    {
        Result<RecordingWriter> writer = RecordingWriter::create(name, ArtificialRun::head());
        ASSERT_TRUE(writer);
        EXPECT_EQ(read_file(name), older);
    }
    EXPECT_EQ(read_file(name), older);
    ASSERT_TRUE(record_run(name, ArtificialRun(3), 6));
    const Result<Player> player = Player::open(name);
    ASSERT_TRUE(player);
    EXPECT_EQ((*player).frames(), 6u);
}

TEST(Recording, RejectsAnInvalidPathAtCreation) {
    const TemporaryFolder folder;
    for (const std::string& name : {folder / "no/such/folder/run.faserec", folder.path(), std::string(),
                                    std::string("/proc/nothing.faserec"), folder / std::string(5000, 'x')}) {
        EXPECT_EQ(RecordingWriter::create(name, ArtificialRun::head()).status(), Status::Io) << name;
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(DiskFull, IsReportedAtCreation) {
    const Result<RecordingWriter> writer = RecordingWriter::create("/dev/full", ArtificialRun::head());
    ASSERT_FALSE(writer);
    EXPECT_EQ(writer.status(), Status::Io);
    EXPECT_NE(writer.error().text().find("disk full"), std::string::npos) << writer.error().text();
    EXPECT_NE(writer.error().text().find("wrote 0 frames, 0 bytes"), std::string::npos) << writer.error().text();
}

/// Lowers the file size limit of this process during its lifetime.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit now{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &now);
    }
    ~FileSizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    rlimit before_{};
};

TEST(DiskFull, KeepsWrittenFramesAndReportsTheirNumber) {
    const TemporaryFolder folder;
    const std::string name = folder / "run.faserec";
    const ArtificialRun run(100);
    RecorderOptions options;
    options.flush_frames = 16;
    Error error;
    std::uint64_t flushed = 0, bytes = 0;
    {
        const FileSizeLimit limit(50000);  // within a block; raises SIGXFSZ, which is not ignored here
        Result<RecordingWriter> writer = RecordingWriter::create(name, ArtificialRun::head(), options);
        ASSERT_TRUE(writer);
        ASSERT_TRUE(run.add_tables(*writer));
        Result<void> added;
        for (std::uint64_t k = 0; k < 10000 && added; ++k) added = (*writer).add_frame(run.frame(k));
        ASSERT_FALSE(added);
        error = added.error();
        flushed = (*writer).frames_flushed();
        bytes = (*writer).bytes();
        EXPECT_EQ((*writer).add_frame(run.frame(0)).status(), Status::Io);
        EXPECT_EQ((*writer).finish().status(), Status::Io);
    }
    EXPECT_GT(flushed, 0u);
    EXPECT_NE(error.text().find("wrote " + std::to_string(flushed) + " frames, " + std::to_string(bytes) + " bytes"),
              std::string::npos)
        << error.text();
    EXPECT_FALSE(std::filesystem::exists(name));
    EXPECT_EQ(std::filesystem::file_size(name + ".part"), bytes);
    Result<Player> player = Player::open(name);
    ASSERT_TRUE(player) << player.error().text();
    ASSERT_EQ((*player).frames(), flushed);
    EXPECT_TRUE((*player).frame(flushed - 1));
}

TEST(DiskFull, LeavesNoEmptyFileBehind) {
    const TemporaryFolder folder;
    {
        const FileSizeLimit limit(0);
        EXPECT_EQ(RecordingWriter::create(folder / "run.faserec", ArtificialRun::head()).status(), Status::Io);
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Recording, ToAPipeWithoutAReaderFails) {
    const TemporaryFolder folder;
    const std::string name = folder / "pipe";
    ASSERT_EQ(::mkfifo(name.c_str(), 0600), 0);
    EXPECT_EQ(RecordingWriter::create(name, ArtificialRun::head()).status(), Status::Io);  // no reader yet
    const int reader = ::open(name.c_str(), O_RDONLY | O_NONBLOCK);
    ASSERT_GE(reader, 0);
    Result<RecordingWriter> writer = RecordingWriter::create(name, ArtificialRun::head());
    ASSERT_TRUE(writer);
    ::close(reader);
    ASSERT_TRUE((*writer).add_frame(ArtificialRun(0).frame(0)));
    EXPECT_EQ((*writer).finish().status(), Status::Io);  // without SIGPIPE
}

TEST(Recording, DurableRecordingHasTheSameBytes) {
    const TemporaryFolder folder;
    RecorderOptions options;
    ASSERT_TRUE(record_run(folder / "a", ArtificialRun(20), 70, options));
    options.durable = true;
    ASSERT_TRUE(record_run(folder / "b", ArtificialRun(20), 70, options));
    EXPECT_EQ(read_file(folder / "a"), read_file(folder / "b"));
}

TEST(Recording, RejectsOptionsOutOfRange) {
    const TemporaryFolder folder;
    for (const RecorderOptions& options :
         {RecorderOptions{.flush_seconds = -1}, RecorderOptions{.flush_seconds = std::nan("")},
          RecorderOptions{.flush_frames = 0}, RecorderOptions{.flush_frames = 65},
          RecorderOptions{.quanta_per_metre = 0}}) {
        EXPECT_EQ(RecordingWriter::create(folder / "run", ArtificialRun::head(), options).status(),
                  Status::BadArgument);
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace fase::record
