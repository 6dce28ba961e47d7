/// Tests of the strict JSON reader.
#include "fase/scene/detail/json.hpp"

#include <gtest/gtest.h>

#include "tests/scene/support.hpp"

namespace fase::scene {
namespace {

TEST(Json, KeepsValuesAndTheirOrder) {
    const auto document = parse_json(R"( {"a": [1, -2.5e3, true, null], "b": {"c": "d\u00e9\n"}} )");
    ASSERT_TRUE(document);
    const JsonValue root = document->root();
    EXPECT_EQ(root.size(), 2u);
    std::vector<double> numbers;
    root.find("a")->for_each_element([&](JsonValue value) {
        if (value.is(JsonKind::Number)) numbers.push_back(value.number());
    });
    EXPECT_EQ(numbers, (std::vector<double>{1, -2500}));
    EXPECT_EQ(root.find("b")->find("c")->string(), "d\xc3\xa9\n");
    EXPECT_FALSE(root.find("x"));
    EXPECT_FALSE(root.find("a")->find("x"));
}

TEST(Json, GivesThePointerOfAValue) {
    const auto document = parse_json(R"({"nodes": [{}, {"a/b~": [0, {"x": 1}]}]})");
    ASSERT_TRUE(document);
    std::string pointer;
    document->root().find("nodes")->for_each_element([&](JsonValue node) {
        if (const auto list = node.find("a/b~"))
            list->for_each_element([&](JsonValue v) { pointer = v.find("x") ? v.find("x")->pointer() : ""; });
    });
    EXPECT_EQ(pointer, "/nodes/1/a~1b~0/1/x");
    EXPECT_EQ(document->root().pointer(), "");
}

TEST(Json, RefusesInvalidJson) {
    using namespace std::string_literals;
    for (const std::string& text :
         {""s, "{"s, "[1,]"s, "{\"a\":1,}"s, "NaN"s, "[1] x"s, "'a'"s, "\"\\ud800\""s, "\xef\xbb\xbf{}"s, "{}\0"s,
          "[\"\0\"]"s, "01"s, "[1e999]"s, "\"\xff\""s, "{\"a\":1,\"a\":2}"s}) {
        const auto document = parse_json(text);
        ASSERT_FALSE(document) << text;
        EXPECT_EQ(document.status(), Status::Format);
        EXPECT_TRUE(document.error().where.starts_with("byte ")) << document.error().text();
        EXPECT_EQ(document.error().text().find('\n'), std::string::npos);
    }
}

TEST(Json, NamesTheByteOfTheError) {
    const auto document = parse_json("[1, 2, x]");
    ASSERT_FALSE(document);
    EXPECT_EQ(document.error().where, "byte 8");
}

TEST(Json, EnforcesTheDepthLimit) {
    const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
    EXPECT_TRUE(parse_json(nested(128)));
    EXPECT_FALSE(parse_json(nested(129)));
    EXPECT_FALSE(parse_json(std::string(100000, '[')));
    EXPECT_FALSE(parse_json(nested(3), {.depth = 2, .unique_keys = true}));
}

TEST(Json, RefusesADuplicateKeyAmongMany) {
    std::string text = "{";
    for (int i = 0; i < 5000; ++i) text += "\"k" + std::to_string(i) + "\":0,";
    EXPECT_TRUE(parse_json(text + "\"k5000\":0}"));
    EXPECT_FALSE(parse_json(text + "\"k77\":0}"));
}

TEST(Json, SurvivesAMillionDigits) {
    EXPECT_FALSE(parse_json(std::string(1000000, '1')));
    EXPECT_TRUE(parse_json("0." + std::string(1000000, '1')));
}

TEST(Json, QuotedTextIsValidJson) {
    const std::string hard = "a\"\\\n\x1b\x7f\xff\xc3\xa9";
    const std::string text = scene::quoted(hard);
    const auto document = parse_json(text);
    ASSERT_TRUE(document) << text;
    EXPECT_EQ(document->root().string(), "a\"\\\n\x1b\x7f\xef\xbf\xbd\xc3\xa9");
    EXPECT_EQ(quoted_short("abcdef", 3), "\"abc…\"");
}

TEST(Json, AgreesWithTheParsingSuite) {
    const std::filesystem::path folder = std::filesystem::path(FASE_SHARED_DATA) / "json-suite" / "test_parsing";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "skipped: no " << folder;
    std::size_t right = 0, wrong = 0, free = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        const bool accepted =
            parse_json(test::content_of(entry.path()), {.depth = 128, .unique_keys = false}).has_value();
        if (name[0] == 'y') {
            EXPECT_TRUE(accepted) << name;
            ++right;
        } else if (name[0] == 'n') {
            EXPECT_FALSE(accepted) << name;
            ++wrong;
        } else {
            ++free;
        }
    }
    EXPECT_GT(right, 90u);
    EXPECT_GT(wrong, 180u);
    EXPECT_GT(free, 30u);
}

}  // namespace
}  // namespace fase::scene
