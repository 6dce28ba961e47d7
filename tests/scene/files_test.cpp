/// Tests of the files that scenes are read from and written to.
#include "fase/scene/files.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>

#include "tests/scene/support.hpp"

namespace fase::scene {
namespace {

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

TEST(Files, RefusesWhatIsNoRegularFile) {
    const TemporaryFolder folder;
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_EQ(read_file(folder / "pipe", 100).status(), Status::Format);
    EXPECT_EQ(read_file(folder.path(), 100).status(), Status::Format);
    EXPECT_EQ(read_file("/dev/zero", 100).status(), Status::Format);
    EXPECT_EQ(read_file(folder / "nothing", 100).status(), Status::Io);
    EXPECT_EQ(read_file("/dev/zero", 100).error().where, "/dev/zero");
}

TEST(Files, FollowsUrisInsideTheFolder) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "sub");
    write_text(folder / "a b.bin", "x");
    write_text(folder / "sub/c.bin", "x");
    EXPECT_TRUE(resolve_uri(folder.path(), "a%20b.bin"));
    EXPECT_TRUE(resolve_uri(folder.path(), "sub/c.bin"));
    EXPECT_TRUE(resolve_uri(folder.path(), "./sub/c.bin"));
}

TEST(Files, RefusesUrisThatLeadOut) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "model");
    write_text(folder / "secret", "x");
    const std::string model = folder / "model";
    std::filesystem::create_symlink(folder / "secret", model + "/link");
    using namespace std::string_literals;
    for (const std::string& uri : {"../secret"s,
                                   "%2e%2e/secret"s,
                                   "..%2fsecret"s,
                                   "sub/../../secret"s,
                                   "/etc/passwd"s,
                                   "%2fetc/passwd"s,
                                   "C:\\secret"s,
                                   "c:/secret"s,
                                   "..\\secret"s,
                                   "http://host/a"s,
                                   "file:///etc/passwd"s,
                                   "link"s,
                                   ""s,
                                   "%"s,
                                   "%4"s,
                                   "%zz"s,
                                   "a\0b"s,
                                   "%00"s,
                                   "missing"s,
                                   std::string(5000, 'a')}) {
        const auto path = resolve_uri(model, uri);
        EXPECT_FALSE(path) << uri;
        if (!path) {
            EXPECT_EQ(path.status(), Status::Format) << uri;
        }
    }
}

TEST(Files, RefusesBadBase64) {
    EXPECT_EQ(*decode_data_uri("data:a/b;base64,aGVsbG8="), test::bytes_of("hello"));
    EXPECT_TRUE(decode_data_uri("data:;base64,")->empty());
    for (const std::string_view uri :
         {"data:", "data:a/b,hello", "data:;base64,abc", "data:;base64,ab!=", "data:;base64,a===", "data:;base64,ab=c",
          "data:;base64,====", "data:;base64,aGVs bG8="}) {
        EXPECT_FALSE(decode_data_uri(uri)) << uri;
    }
}

RC_GTEST_PROP(Files, Base64GivesBackWhatItTook, (const std::vector<std::uint8_t>& values)) {
    std::vector<std::byte> bytes;
    for (const std::uint8_t value : values) bytes.push_back(std::byte{value});
    const auto back = decode_data_uri("data:;base64," + encode_base64(bytes));
    RC_ASSERT(back.has_value());
    RC_ASSERT(*back == bytes);
}

TEST(Files, WritesWholeFilesOnly) {
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

TEST(Files, LeaveNothingBehindWhenWritingFails) {
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
}  // namespace fase::scene
