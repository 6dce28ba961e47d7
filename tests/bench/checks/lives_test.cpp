/// Random lives: reproducible, varied, and made short when they fail.
#include "bench/checks/lives.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace fase::checks {
namespace {

bool has(const Life& life, CallKind kind) {
    return std::any_of(life.begin(), life.end(), [&](const Call& call) { return call.kind == kind; });
}

TEST(Lives, contain_every_kind_of_call) {
    std::set<CallKind> seen;
    for (int run = 0; run < 20; ++run)
        for (const Call& call : random_life(1, run)) seen.insert(call.kind);
    EXPECT_EQ(seen.size(), static_cast<std::size_t>(CallKind::Count));
}

TEST(Lives, are_the_same_for_the_same_seed) {
    EXPECT_EQ(described(random_life(3, 4)), described(random_life(3, 4)));
    EXPECT_NE(described(random_life(3, 4)), described(random_life(3, 5)));
}

TEST(Lives, are_shrunk_to_the_calls_that_fail) {
    const auto fails = [](const Life& life) {  // a kind, and another one somewhere behind it
        const auto save =
            std::find_if(life.begin(), life.end(), [](const Call& call) { return call.kind == CallKind::Save; });
        return has(Life(save, life.end()), CallKind::SetKind);
    };
    int tried = 0;
    for (int run = 0; run < 40; ++run) {
        const Life life = random_life(1, run);
        if (!fails(life)) continue;
        ++tried;
        const Life shorter = shrunk(life, fails);
        ASSERT_EQ(shorter.size(), 2u);
        EXPECT_EQ(shorter[0].kind, CallKind::Save);
        EXPECT_EQ(shorter[1].kind, CallKind::SetKind);
    }
    EXPECT_GT(tried, 5);
}

TEST(Lives, are_described_one_call_per_line) {
    const Life life{{CallKind::AddBody, 1}, {CallKind::Steps, 2}, {CallKind::Save, 3}};
    const std::string text = described(life);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
    EXPECT_NE(text.find("add_body("), std::string::npos);
    EXPECT_NE(text.find("snapshot"), std::string::npos);
}

}  // namespace
}  // namespace fase::checks
