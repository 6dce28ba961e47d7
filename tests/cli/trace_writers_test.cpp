/// Runs the trace writers of docs/traces.md and reads their files.
#include <cstdlib>

#include "tests/cli/made_traces.hpp"

namespace fase::cli {
namespace {

/// The first block of code in that language.
std::string code_in(const std::string& page, const std::string& language) {
    const std::string head = "\n```" + language + "\n";
    const std::size_t begin = page.find(head);
    if (begin == std::string::npos) return {};
    const std::size_t first = begin + head.size();
    return page.substr(first, page.find("\n```", first) + 1 - first);
}

bool is_installed(const std::string& program) {
    return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

constexpr const char* python_line = "python3 -B writer.py";

class TraceWriters : public ::testing::Test {
protected:
    /// Writes the program in `language` to a file, runs the shell line there, and returns the trace.
    std::string written_by(const std::string& language, const std::string& source, const std::string& line) {
        const std::string code = code_in(read_file(std::string(FASE_DATA) + "/../docs/traces.md"), language);
        EXPECT_FALSE(code.empty()) << language;
        write_file(folder / source, code);
        EXPECT_EQ(std::system(("cd '" + folder.path() + "' && " + line).c_str()), 0) << code;
        return read_file(folder / "boxes.aabt");
    }
    void expect_good_trace() {
        const Outcome info = run_fase({"info", folder / "boxes.aabt", "--json"});
        EXPECT_EQ(info.code, 0) << info.err;
        EXPECT_NE(info.out.find("\"boxes\": 21, \"frames\": 40, \"static\": 1"), std::string::npos) << info.out;
        const Outcome pairs = run_fase({"pairs", folder / "boxes.aabt", "--check", "--json"});
        EXPECT_EQ(pairs.code, 0) << pairs.err;
        const Rows rows(pairs.out);
        EXPECT_TRUE(is_true(rows[0], "checked"));
        EXPECT_EQ(number_at(rows[0], "pairs_first"), 0);
        EXPECT_EQ(number_at(rows[0], "pairs_last"), 20) << "all cubes touch the ground";
    }
    void expect_same_as_python(const std::string& compiler, const std::string& language, const std::string& line) {
        if (!is_installed(compiler) || !is_installed("python3"))
            GTEST_SKIP() << "skipped: no " << compiler << " or python3";
        const std::string trace = written_by(language, "writer." + language, line);
        expect_good_trace();
        EXPECT_EQ(written_by("python", "writer.py", python_line), trace);
    }
    TemporaryFolder folder;
};

TEST_F(TraceWriters, ThePythonProgramWritesATrace) {
    if (!is_installed("python3")) GTEST_SKIP() << "skipped: no python3";
    written_by("python", "writer.py", python_line);
    expect_good_trace();
}

TEST_F(TraceWriters, TheCxxProgramWritesTheSameTrace) {
    expect_same_as_python("c++", "cpp", "c++ -std=c++20 -Wall -Wextra -Werror writer.cpp -o writer && ./writer");
}

TEST_F(TraceWriters, TheCProgramWritesTheSameTrace) {
    expect_same_as_python("cc", "c", "cc -std=c11 -Wall -Wextra -Werror writer.c -o writer && ./writer");
}

}  // namespace
}  // namespace fase::cli
