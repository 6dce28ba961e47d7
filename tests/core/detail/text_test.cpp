/// Texts of values.
#include "fase/core/detail/text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace fase::detail {
namespace {

TEST(Text, fills_values_into_a_pattern) {
    EXPECT_EQ(format("found {} of {}; expected {}", 3, 7u, "all"), "found 3 of 7; expected all");
    EXPECT_EQ(format("no values"), "no values");
    EXPECT_EQ(format("{}{}", std::string("a"), std::string_view("b")), "ab");
}

TEST(Text, writes_the_shortest_number_that_reads_back) {
    EXPECT_EQ(text_of(0.1f), "0.1");
    EXPECT_EQ(text_of(100000.0), "100000");
    EXPECT_EQ(text_of(-2.5), "-2.5");
    EXPECT_EQ(text_of(1e20), "1e+20");
    EXPECT_EQ(text_of(1e-7f), "1e-07");
    EXPECT_EQ(text_of(std::numeric_limits<float>::infinity()), "inf");
    EXPECT_EQ(text_of(std::numeric_limits<double>::quiet_NaN()), "nan");
    EXPECT_EQ(rounded_text_of(0.0012345), "0.0012");
}

TEST(Text, bytes_and_lines_of_a_file_look_different) {
    EXPECT_EQ(at_byte("a.glb", 0), "a.glb: byte 0");
    EXPECT_EQ(at_byte("a.glb", 0xffffffffffull), "a.glb: byte 1099511627775");
    EXPECT_EQ(at_line("a.obj", 12), "a.obj:12");
}

}  // namespace
}  // namespace fase::detail
