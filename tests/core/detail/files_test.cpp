/// Reading and writing complete files.
#include "fase/core/detail/files.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "tests/scene/support.hpp"

namespace fase {
namespace {

namespace test = scene::test;
using test::TemporaryFolder;
using test::write_text;

TEST(Files, ReadsARegularFile) {
    const TemporaryFolder folder;
    write_text(folder / "a", "hello");
    EXPECT_EQ(*read_file(folder / "a", 100), test::bytes_of("hello"));
    EXPECT_EQ(read_file(folder / "a", 4).status(), Status::Format);
    EXPECT_EQ(read_start(folder / "a", 2)->bytes, test::bytes_of("he"));
    EXPECT_EQ(read_start(folder / "a", 2)->size, 5u);
}

TEST(Files, TheObserverKnowsTheTemporaryFileWhileItExists) {
    const TemporaryFolder folder;
    static std::vector<std::string> told;
    told.clear();
    observe_parts([](const char* part) { told.emplace_back(part); });
    EXPECT_TRUE(write_file(folder / "a", test::bytes_of("one")));
    EXPECT_FALSE(write_file(folder / "none/a", test::bytes_of("one")));
    observe_parts(nullptr);
    EXPECT_TRUE(write_file(folder / "b", test::bytes_of("two")));
    ASSERT_EQ(told.size(), 4u);
    EXPECT_TRUE(told[0].starts_with(folder / "a.part")) << told[0];
    EXPECT_TRUE(told[2].starts_with(folder / "none/a.part")) << told[2];
    EXPECT_EQ(told[1] + told[3], "");
}

TEST(Files, RefusesPipesFoldersAndDevices) {
    const TemporaryFolder folder;
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_EQ(read_file(folder / "pipe", 100).status(), Status::Format);
    EXPECT_EQ(read_file(folder.path(), 100).status(), Status::Format);
    EXPECT_EQ(read_file("/dev/zero", 100).status(), Status::Format);
    EXPECT_EQ(read_file(folder / "nothing", 100).status(), Status::Io);
    EXPECT_EQ(read_file("/dev/zero", 100).error().where, "/dev/zero");
}

TEST(Files, WritesAtomically) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write_file(folder / "a", test::bytes_of("one")));
    ASSERT_TRUE(write_file(folder / "a", test::bytes_of("two")));
    EXPECT_EQ(test::content_of(folder / "a"), "two");
    std::filesystem::create_symlink("a", folder / "link");
    ASSERT_TRUE(write_file(folder / "link", test::bytes_of("three")));
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    EXPECT_EQ(test::content_of(folder / "a"), "three");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2) << "a temporary file was left";
}

TEST(Files, LeavesNoTemporaryFileWhenWritingFails) {
    const TemporaryFolder folder;
    EXPECT_EQ(write_file(folder.path(), test::bytes_of("x")).status(), Status::Io);
    EXPECT_EQ(write_file(folder / "none/a", test::bytes_of("x")).status(), Status::Io);
    EXPECT_EQ(write_file("/dev/full", test::bytes_of("x")).status(), Status::Io);
    struct stat about = {};
    ASSERT_EQ(stat("/dev/full", &about), 0);
    EXPECT_TRUE(S_ISCHR(about.st_mode)) << "a device was replaced by a file";
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace fase
