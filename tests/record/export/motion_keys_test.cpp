/// Tests that interpolation restores the omitted samples.
#include "fase/record/export/motion_keys.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace fase::record {
namespace {

template <class Value> struct Reduced {
    std::size_t keys = 0;
    double worst = 0;
};
/// Reduces 1,000 samples; measures the largest distance of a sample from the interpolated keys.
template <class Value> Reduced<Value> reduce(const std::function<Value(double)>& motion, double tolerance) {
    MotionKeys<Value> reducer(tolerance);
    std::vector<MotionKey<Value>> samples;
    for (int i = 0; i < 1000; ++i) {
        const double time = i / 60.0;
        samples.push_back({time, motion(time)});
        reducer.add(time, samples.back().value);
    }
    const auto& keys = reducer.finish();
    Reduced<Value> result;
    result.keys = keys.size();
    for (const auto& sample : samples) {
        const auto after =
            std::find_if(keys.begin(), keys.end(), [&](const auto& key) { return key.time >= sample.time; });
        if (after == keys.end() || after == keys.begin()) {
            const Value held = after == keys.end() ? keys.back().value : keys.front().value;
            result.worst = std::max(result.worst, distance_between(held, held, 0, sample.value));
            continue;
        }
        const auto before = std::prev(after);
        const double fraction = (sample.time - before->time) / (after->time - before->time);
        result.worst = std::max(result.worst, distance_between(before->value, after->value, fraction, sample.value));
    }
    return result;
}

TEST(MotionKeys, AMotionlessBodyHasOneKey) {
    EXPECT_EQ(reduce<Vec3d>([](double) { return Vec3d{1, 2, 3}; }, 0.001).keys, 1u);
}

TEST(MotionKeys, AStraightLineHasFewKeys) {
    const auto reduced = reduce<Vec3d>([](double t) { return Vec3d{t, 2 * t, 0}; }, 0.001);
    EXPECT_LE(reduced.keys, 10u);  // both ends and one per 120 samples
    EXPECT_LE(reduced.worst, 0.001);
}

TEST(MotionKeys, AThrowStaysWithinTheTolerance) {
    const auto reduced = reduce<Vec3d>(
        [](double t) {
            return Vec3d{3 * t, 20 * t - 4.905 * t * t, std::sin(t)};
        },
        0.005);
    EXPECT_LE(reduced.worst, 0.005);
    EXPECT_LT(reduced.keys, 400u);
    EXPECT_GT(reduced.keys, 100u);
}

TEST(MotionKeys, KeepTheTimeAtWhichRestEnds) {
    const auto motion = [](double t) { return Vec3d{t < 5 ? 0 : t > 8 ? 30 : (t - 5) * 10, 0, 0}; };
    const auto reduced = reduce<Vec3d>(motion, 0.001);
    EXPECT_LE(reduced.worst, 0.001);
    EXPECT_LE(reduced.keys, 12u);
}

TEST(MotionKeys, RotationStaysWithinTheTolerance) {
    const double degree = 3.14159265358979 / 180;
    const auto steady = reduce<Quatd>([](double t) { return rotation_about(Vec3d{0, 1, 0}, 2 * t); }, 0.1 * degree);
    EXPECT_LE(steady.worst, 0.1 * degree);
    EXPECT_LT(steady.keys, 40u);  // each arc must stay below half a turn
    const auto tumbling = reduce<Quatd>(
        [](double t) {
            return rotation_about(Vec3d{1, 0, 0}, std::sin(3 * t)) * rotation_about(Vec3d{0, 0, 1}, 5 * t);
        },
        0.1 * degree);
    EXPECT_LE(tumbling.worst, 0.1 * degree);
    EXPECT_LT(tumbling.keys, 800u);
}

}  // namespace
}  // namespace fase::record
