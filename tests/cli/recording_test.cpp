/// Tests `fase run --record`: where it writes, and that a recording survives signals, kills and full disks.
#include <sys/stat.h>

#include "fase/record/player.hpp"
#include "tests/cli/fase_program.hpp"

namespace fase::cli {
namespace {

using record::Player;
using Clock = std::chrono::steady_clock;

/// A run of hours with a small scene: it flushes many frames per second.
const std::vector<std::string> long_run{"run",        "stack",   "--count",  "10",
                                        "--no-sleep", "--steps", "10000000", "--record"};

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

std::uint64_t bytes_of(const std::string& file) {
    std::error_code ignored;
    const auto size = std::filesystem::file_size(file, ignored);
    return ignored ? 0 : size;
}

/// Reads every frame and returns their number. Expects consecutive steps.
std::uint64_t read_all(Player& player) {
    record::Frame frame;
    for (std::uint64_t i = 0; i < player.frames(); ++i) {
        const auto read = player.read(i, frame);
        EXPECT_TRUE(read) << read.error().text();
        EXPECT_EQ(frame.step, i);
    }
    return player.frames();
}

TEST(Recording, ContainsTheInitialStateAndEveryStep) {
    const TemporaryFolder folder;
    const std::string file = folder / "r.faserec";
    const Outcome outcome = run_fase({"run", "castle", "--count", "100", "--steps", "25", "--record", file});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("recording  " + file + ": 26 frames"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("\n           look at it: fase view " + file + "\n"), std::string::npos) << outcome.out;
    Result<Player> player = Player::open(file);
    ASSERT_TRUE(player) << player.error().text();
    EXPECT_TRUE(player->complete());
    EXPECT_EQ(read_all(*player), 26u);
    EXPECT_EQ(player->head().title, "castle");
    EXPECT_FALSE(player->tables().meshes.empty());
    EXPECT_FALSE(player->tables().visuals.empty());
}

TEST(Recording, AnUnwritablePathIsRefusedBeforeTheRun) {
    const TemporaryFolder folder;
    const std::string scene = folder / "scene.glb";
    ASSERT_EQ(run_fase({"generate", "stack", "-o", scene}).code, 0);
    ASSERT_EQ(::symlink(scene.c_str(), (folder / "link").c_str()), 0);
    const std::string before = read_file(scene);
    const auto refused = [&](const std::string& out, const std::string& words) {
        expect_error_line(run_fase({"run", scene, "--steps", "1000000", "--record", out}), 3, words);
    };
    refused(scene, "found the input file");
    refused(folder / "link", "found the input file");
    refused(folder / "./scene.glb", "found the input file");
    refused(folder.path(), "found a folder");
    refused(folder / "new/", "found a folder's name");
    refused(scene + "/r.faserec", "expected a folder");
    refused(scene + "/deep/r.faserec", "Not a directory");
    refused(folder / std::string(300, 'n'), "File name too long");
    EXPECT_EQ(read_file(scene), before);
    for (const char* command : {"--html", "--glb"}) {
        expect_error_line(run_fase({"view", scene, command, folder.path()}), 3, "found a folder");
    }
    expect_error_line(run_fase({"generate", "stack", "-o", folder.path()}), 3, "found a folder");
}

TEST(Recording, AReadOnlyFileOrFolderIsRefused) {
    const TemporaryFolder folder;
    const std::string file = folder / "r.faserec";
    // The superuser may write everywhere, so the capability is removed.
    const std::string as_regular_user =
        ::geteuid() != 0 ? "exec \"$0\" \"$@\"" : "exec setpriv --bounding-set=-dac_override \"$0\" \"$@\"";
    const auto run = [&](const std::string& out) {
        return RunningFase::by_shell(as_regular_user, {"run", "stack", "--steps", "1", "--record", out}).wait();
    };
    if (run(folder / "first.faserec").code != 0) GTEST_SKIP() << "skipped: cannot drop the rights of the superuser";
    write_file(file, "old");
    ::chmod(file.c_str(), 0400);
    expect_error_line(run(file), 3, "found a read-only file");
    ::chmod(folder.path().c_str(), 0500);
    expect_error_line(run(folder / "new.faserec"), 3, "read-only folder");
    ::chmod(folder.path().c_str(), 0700);
    EXPECT_EQ(read_file(file), "old");
}

TEST(Recording, AFullDiskIsReportedWithTheWrittenAmount) {
    expect_error_line(run_fase(with(long_run, {"/dev/full"})), 3, "/dev/full");
    const TemporaryFolder folder;
    const std::string file = folder / "r.faserec";
    // 64 blocks of 512 bytes.
    const Outcome outcome = RunningFase::by_shell("ulimit -f 64; exec \"$0\" \"$@\"", with(long_run, {file})).wait();
    expect_error_line(outcome, 3, "frames");
    EXPECT_FALSE(std::filesystem::exists(file));
    Result<Player> player = Player::open(file);
    ASSERT_TRUE(player) << player.error().text();
    EXPECT_GT(read_all(*player), 0u);
    EXPECT_NE(outcome.err.find(std::to_string(player->frames()) + " frames"), std::string::npos) << outcome.err;
}

TEST(Recording, ASignalEndsTheRunWithACompleteRecording) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const TemporaryFolder folder;
        const std::string file = folder / "r.faserec";
        RunningFase running(with(long_run, {file}));
        ASSERT_TRUE(wait_until([&] { return bytes_of(file + ".part") > 4000; }));
        const auto begin = Clock::now();
        running.send(signal);
        const Outcome outcome = running.wait();
        EXPECT_EQ(outcome.code, 128 + signal);
        EXPECT_LT(Clock::now() - begin, std::chrono::seconds(1));
        EXPECT_NE(outcome.out.find(" of 10000000"), std::string::npos) << outcome.out;
        EXPECT_NE(outcome.out.find("look at it: fase view "), std::string::npos) << outcome.out;
        Result<Player> player = Player::open(file);
        ASSERT_TRUE(player) << player.error().text();
        EXPECT_TRUE(player->complete()) << player->lost();
        const std::uint64_t frames = read_all(*player);
        EXPECT_NE(outcome.out.find(": " + std::to_string(frames) + " frames"), std::string::npos) << outcome.out;
        EXPECT_FALSE(std::filesystem::exists(file + ".part"));
    }
}

TEST(Recording, ASecondSignalEndsItImmediately) {
    const TemporaryFolder folder;
    // Many bodies, so that the first signal arrives during a step.
    RunningFase running({"run", "pile", "--count", "4000", "--steps", "100000", "--record", folder / "r.faserec"});
    ASSERT_TRUE(wait_until([&] { return bytes_of(folder / "r.faserec.part") > 0; }));
    running.send(SIGINT);
    running.send(SIGINT);
    const auto begin = Clock::now();
    EXPECT_EQ(running.wait().code, 130);
    EXPECT_LT(Clock::now() - begin, std::chrono::seconds(1));
}

TEST(Recording, AKillLosesNoFlushedFrame) {
    for (int kill = 0; kill < 20; ++kill) {
        const TemporaryFolder folder;
        const std::string file = folder / "r.faserec", part = file + ".part";
        RunningFase running(with(long_run, {file}));
        // Kills at another file position each time.
        ASSERT_TRUE(wait_until([&] { return bytes_of(part) > 500u * static_cast<unsigned>(kill + 1); }));
        std::uint64_t seen = 0;
        {
            const Result<Player> player = Player::open(file);
            ASSERT_TRUE(player) << player.error().text();
            seen = player->frames();
        }
        const auto flushed_at = std::filesystem::last_write_time(part);
        EXPECT_LT(std::filesystem::file_time_type::clock::now() - flushed_at, std::chrono::seconds(2));
        running.send(SIGKILL);
        EXPECT_EQ(running.wait().code, -SIGKILL);
        Result<Player> player = Player::open(file);
        ASSERT_TRUE(player) << player.error().text();
        EXPECT_FALSE(player->complete());
        EXPECT_GE(player->frames(), seen);
        EXPECT_EQ(read_all(*player), player->frames());
        // Only the block that was being written may be damaged.
        EXPECT_LT(player->file_bytes() - player->good_bytes(), 65536u);
    }
}

TEST(Recording, ASecondRecorderOfOneFileIsRefused) {
    const TemporaryFolder folder;
    const std::string file = folder / "r.faserec";
    RunningFase running(with(long_run, {file}));
    ASSERT_TRUE(wait_until([&] { return bytes_of(file + ".part") > 0; }));
    expect_error_line(run_fase({"run", "stack", "--steps", "1", "--record", file}), 3, "r.faserec");
    running.send(SIGINT);
    EXPECT_EQ(running.wait().code, 130);
    const Result<Player> player = Player::open(file);
    ASSERT_TRUE(player);
    EXPECT_TRUE(player->complete());
}

}  // namespace
}  // namespace fase::cli
