/// Tests of uris: allowed paths and base64 data.
#include "fase/scene/detail/uri.hpp"

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

TEST(Uri, ResolvesUrisInsideTheFolder) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "sub");
    write_text(folder / "a b.bin", "x");
    write_text(folder / "sub/c.bin", "x");
    EXPECT_TRUE(resolve_uri(folder.path(), "a%20b.bin"));
    EXPECT_TRUE(resolve_uri(folder.path(), "sub/c.bin"));
    EXPECT_TRUE(resolve_uri(folder.path(), "./sub/c.bin"));
}

TEST(Uri, RefusesUrisOutsideTheFolder) {
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

TEST(Uri, RefusesBadBase64) {
    EXPECT_EQ(*decode_data_uri("data:a/b;base64,aGVsbG8="), test::bytes_of("hello"));
    EXPECT_TRUE(decode_data_uri("data:;base64,")->empty());
    for (const std::string_view uri :
         {"data:", "data:a/b,hello", "data:;base64,abc", "data:;base64,ab!=", "data:;base64,a===", "data:;base64,ab=c",
          "data:;base64,====", "data:;base64,aGVs bG8="}) {
        EXPECT_FALSE(decode_data_uri(uri)) << uri;
    }
}

RC_GTEST_PROP(Uri, Base64RoundTrips, (const std::vector<std::uint8_t>& values)) {
    std::vector<std::byte> bytes;
    for (const std::uint8_t value : values) bytes.push_back(std::byte{value});
    const auto back = decode_data_uri("data:;base64," + encode_base64(bytes));
    RC_ASSERT(back.has_value());
    RC_ASSERT(*back == bytes);
}

}  // namespace
}  // namespace fase::scene
