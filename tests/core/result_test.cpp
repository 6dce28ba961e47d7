/// Result: a value or an error.
#include "fase/core/result.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace fase {
namespace {

Result<int> half_of(int n) {
    if (n % 2 != 0) return Error{Status::BadArgument, "n", "found 7; expected an even number", "add 1"};
    return n / 2;
}

TEST(Result, holds_the_value) {
    const Result<int> result = half_of(8);
    ASSERT_TRUE(result);
    EXPECT_TRUE(result.has_value());
    EXPECT_EQ(*result, 4);
    EXPECT_EQ(result.status(), Status::Ok);
}

TEST(Result, holds_the_error) {
    const Result<int> result = half_of(7);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.status(), Status::BadArgument);
    EXPECT_EQ(result.error().text(), "n: found 7; expected an even number; add 1");
}

TEST(Result, moves_what_cannot_be_copied) {
    Result<std::unique_ptr<int>> result = std::make_unique<int>(5);
    const std::unique_ptr<int> moved = *std::move(result);
    EXPECT_EQ(*moved, 5);
}

TEST(Result, gives_access_to_its_value) {
    Result<std::string> result = std::string("abc");
    EXPECT_EQ(result->size(), 3u);
    *result += "d";
    EXPECT_EQ(*result, "abcd");
}

TEST(Result, gives_another_value_when_there_is_none) {
    EXPECT_EQ(half_of(8).value_or(-1), 4);
    EXPECT_EQ(half_of(7).value_or(-1), -1);
    const Result<std::string> text = std::string("abc");
    EXPECT_EQ(text.value_or("none"), "abc");
    EXPECT_EQ(Result<std::unique_ptr<int>>(Error{}).value_or(nullptr), nullptr);
    EXPECT_EQ(*Result<std::unique_ptr<int>>(std::make_unique<int>(5)).value_or(nullptr), 5);
}

TEST(Result, of_void_is_success_or_an_error) {
    const Result<void> done;
    EXPECT_TRUE(done);
    EXPECT_EQ(done.status(), Status::Ok);
    const Result<void> failed = Error{Status::Io, "a.bin", "cannot open", ""};
    EXPECT_FALSE(failed);
    EXPECT_EQ(failed.status(), Status::Io);
    EXPECT_EQ(failed.error().text(), "a.bin: cannot open");
}

TEST(Error, omits_empty_parts) {
    EXPECT_EQ((Error{Status::Io, "", "disk full", ""}).text(), "disk full");
    EXPECT_EQ((Error{Status::Io, "", "disk full", "free some"}).text(), "disk full; free some");
}

TEST(Status, has_a_name_for_each) {
    EXPECT_STREQ(name_of(Status::Ok), "Ok");
    EXPECT_STREQ(name_of(Status::Busy), "Busy");
    for (int s = 0; s <= static_cast<int>(Status::Busy); ++s) {
        EXPECT_STRNE(name_of(static_cast<Status>(s)), "?") << s;
        for (int t = 0; t < s; ++t) EXPECT_STRNE(name_of(static_cast<Status>(s)), name_of(static_cast<Status>(t)));
    }
}

}  // namespace
}  // namespace fase
