/// The lists of sizes of all shapes.
#include "fase/geometry/shape_description.hpp"

#include <gtest/gtest.h>

#include <set>

#include "fase/geometry/mass.hpp"
#include "tests/geometry/random_shapes.hpp"

namespace fase {
namespace {

TEST(ShapeSizes, describe_a_shape_completely) {
    Random random(3);
    for_each_shape([&]<class S>() {
        if constexpr (SizedShape<S>) {
            const S shape = test::random_shape<S>(random);
            EXPECT_EQ(shape_with<S>(size_numbers(shape)), shape) << S::name;
        }
    });
}

TEST(ShapeSizes, have_distinct_names_and_places) {
    for_each_shape([]<class S>() {
        if constexpr (SizedShape<S>) {
            std::set<std::string_view> names;
            S shape;
            std::set<const float*> places;
            for (const ShapeSize<S>& size : S::sizes) {
                EXPECT_TRUE(names.insert(size.name).second) << S::name << "." << size.name;
                EXPECT_TRUE(places.insert(&size.in(shape)).second) << S::name << "." << size.name;
            }
        }
    });
}

TEST(ShapeSizes, of_zero_pass_the_check_only_where_they_are_allowed) {
    for_each_shape([]<class S>() {
        if constexpr (SizedShape<S>) {
            for (const ShapeSize<S>& size : S::sizes) {
                S shape;
                size.in(shape) = 0;
                EXPECT_EQ(bool(check(Shape(shape))), size.zero == ZeroSize::Allowed) << S::name << "." << size.name;
            }
        }
    });
}

}  // namespace
}  // namespace fase
