#pragma once
/// Runs the program under test with given arguments and streams.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "fase/scene/detail/json.hpp"
#include "tests/record/artificial_run.hpp"

namespace fase::cli {

using record::read_file;
using record::TemporaryFolder;
using record::write_file;

/// The result of a run. `code` is the exit code, or -n if signal n ended the program.
struct Outcome {
    int code = 0;
    std::string out, err;
};

/// A run of the program. By default, its streams go to files in a temporary folder.
class RunningFase {
public:
    /// @param out target of standard output: a file name, "" for a temporary file, or "closed"
    explicit RunningFase(const std::vector<std::string>& arguments, const std::string& out = {}) {
        std::vector<std::string> all{FASE_PROGRAM};
        all.insert(all.end(), arguments.begin(), arguments.end());
        start(all, out);
    }
    /// Runs a shell line in which "$0" is the program and "$@" are the arguments.
    static RunningFase by_shell(const std::string& line, const std::vector<std::string>& arguments) {
        std::vector<std::string> all{"/bin/sh", "-c", line, FASE_PROGRAM};
        all.insert(all.end(), arguments.begin(), arguments.end());
        return RunningFase(all, 0);
    }
    ~RunningFase() {
        if (id_ > 0) {
            ::kill(id_, SIGKILL);
            ::waitpid(id_, nullptr, 0);
        }
    }
    RunningFase(const RunningFase&) = delete;
    RunningFase& operator=(const RunningFase&) = delete;

    void send(int signal) const { ::kill(id_, signal); }
    Outcome wait() {
        int status = 0;
        ::waitpid(id_, &status, 0);
        id_ = -1;
        const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
        return {code, read_file(folder_ / "out"), read_file(folder_ / "err")};
    }
    /// The text on standard error up to now.
    [[nodiscard]] std::string errors_so_far() const { return read_file(folder_ / "err"); }

private:
    RunningFase(const std::vector<std::string>& all, int) { start(all, {}); }
    void start(const std::vector<std::string>& all, const std::string& out) {
        std::vector<char*> pointers;
        for (const std::string& one : all) pointers.push_back(const_cast<char*>(one.c_str()));
        pointers.push_back(nullptr);
        posix_spawn_file_actions_t streams;
        ::posix_spawn_file_actions_init(&streams);
        const std::string default_out = folder_ / "out", errors = folder_ / "err";
        const std::string& out_name = out.empty() ? default_out : out;
        constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC;
        ::posix_spawn_file_actions_addopen(&streams, 0, "/dev/null", O_RDONLY, 0);
        ::posix_spawn_file_actions_addopen(&streams, 2, errors.c_str(), flags, 0600);
        if (out == "closed") {
            ::posix_spawn_file_actions_addclose(&streams, 1);
        } else {
            ::posix_spawn_file_actions_addopen(&streams, 1, out_name.c_str(), flags, 0600);
        }
        posix_spawnattr_t attributes;
        ::posix_spawnattr_init(&attributes);
        sigset_t defaults, none;
        ::sigemptyset(&none);
        ::sigemptyset(&defaults);
        for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) ::sigaddset(&defaults, signal);
        ::posix_spawnattr_setsigdefault(&attributes, &defaults);
        ::posix_spawnattr_setsigmask(&attributes, &none);
        ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
        EXPECT_EQ(::posix_spawn(&id_, all[0].c_str(), &streams, &attributes, pointers.data(), environ), 0);
        ::posix_spawnattr_destroy(&attributes);
        ::posix_spawn_file_actions_destroy(&streams);
    }
    TemporaryFolder folder_;
    pid_t id_ = -1;
};

/// Runs the program to its end.
inline Outcome run_fase(const std::vector<std::string>& arguments) { return RunningFase(arguments).wait(); }

/// Waits until `condition` holds, for at most 30 s.
template <class Condition> bool wait_until(Condition&& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (std::chrono::steady_clock::now() < end) {
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
}

/// Expects exactly one error line in the documented form, with `words` in it.
inline void expect_error_line(const Outcome& outcome, int code, const std::string& words) {
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_TRUE(outcome.err.starts_with("fase: error: ")) << outcome.err;
    EXPECT_TRUE(outcome.err.ends_with('\n')) << outcome.err;
    EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err << " lacks " << words;
    EXPECT_EQ(outcome.out, "");
}

inline std::set<std::string> keys_of(const scene::JsonValue& object) {
    std::set<std::string> keys;
    object.for_each_member([&](std::string_view key, const scene::JsonValue&) { keys.emplace(key); });
    return keys;
}
/// Expects all documented keys in an object.
inline void expect_keys(const scene::JsonValue& object, const std::vector<std::string>& keys) {
    for (const std::string& key : keys) EXPECT_TRUE(object.find(key)) << "no key " << key;
}
inline double number_at(const scene::JsonValue& object, const std::string& key) {
    const auto value = object.find(key);
    EXPECT_TRUE(value && value->is(scene::JsonKind::Number)) << key;
    return value && value->is(scene::JsonKind::Number) ? value->number() : -1;
}
inline std::string text_at(const scene::JsonValue& object, const std::string& key) {
    const auto value = object.find(key);
    EXPECT_TRUE(value && value->is(scene::JsonKind::String)) << key;
    return value && value->is(scene::JsonKind::String) ? std::string(value->string()) : "";
}

}  // namespace fase::cli
