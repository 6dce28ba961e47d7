/// The choice of the SIMD level.
#include "fase/core/simd.hpp"

#include <gtest/gtest.h>

namespace fase {
namespace {

TEST(Simd, CanBeLimitedToAnyLevelOfTheProcessor) {
    const std::string best(simd_level());
    bool any = false;
    for (const char* level : {"sse4", "avx2", "avx512"}) {
        const Result<void> limited = limit_simd(level);
        if (limited) {
            EXPECT_EQ(simd_level(), level);
            any = true;
        } else {
            EXPECT_EQ(limited.status(), Status::Unsupported);
            EXPECT_EQ(simd_level(), best) << "a missing level changes nothing";
        }
    }
    ASSERT_TRUE(limit_simd("best"));
    EXPECT_EQ(simd_level(), best);
    if (!any) GTEST_SKIP() << "skipped: not an x86 processor";
}

TEST(Simd, AnUnknownLevelIsRefusedWithTheKnownOnes) {
    const Result<void> limited = limit_simd("mmx");
    ASSERT_FALSE(limited);
    EXPECT_EQ(limited.status(), Status::BadArgument);
    EXPECT_NE(limited.error().text().find(simd_levels()), std::string::npos) << limited.error().text();
}

}  // namespace
}  // namespace fase
