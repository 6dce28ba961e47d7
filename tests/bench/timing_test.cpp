/// Statistics of measured times.
#include "bench/timing.hpp"

#include <gtest/gtest.h>

namespace fase::bench {
namespace {

TEST(Timing, AnEmptyListGivesZero) {
    EXPECT_EQ(median_of({}), 0);
    EXPECT_EQ(timing_of({}).worst, 0);
}

TEST(Timing, TheMedianIsTheMiddleValueOrTheMeanOfTheTwo) {
    EXPECT_EQ(median_of(std::vector<double>{9, 1, 4}), 4);
    EXPECT_EQ(median_of(std::vector<double>{9, 1, 4, 2}), 3);
    EXPECT_EQ(median_of(std::vector<double>{7}), 7);
}

TEST(Timing, MeanMedianAndWorstAreOfAllTimes) {
    const Timing timing = timing_of(std::vector<double>{1, 2, 9});
    EXPECT_EQ(timing.mean, 4);
    EXPECT_EQ(timing.median, 2);
    EXPECT_EQ(timing.worst, 9);
}

}  // namespace
}  // namespace fase::bench
