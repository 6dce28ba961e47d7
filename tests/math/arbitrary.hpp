#pragma once
/// Arbitrary vectors, rotations and poses for rapidcheck.
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "fase/math/pose.hpp"

namespace fase::test {

/// A number of any size from about 1e-4 to 1e4, or a small integer.
inline double number() {
    const int mantissa = *rc::gen::inRange(-100000, 100001);
    const int exponent = *rc::gen::inRange(0, 9);
    double size = 1;
    for (int i = 0; i < exponent; ++i) size *= 0.1;
    return mantissa * size;
}
/// A rotation; those about an axis, half turns and the identity are frequent.
inline Quatd rotation() {
    const int kind = *rc::gen::inRange(0, 4);
    const int range = kind == 0 ? 1 : 1000;
    for (;;) {
        const auto part = [&] { return double(*rc::gen::resize(100, rc::gen::inRange(-range, range + 1))); };
        const Quatd q{part(), part(), part(), part()};
        if (length_squared(q) > 0) return normalized(q);
    }
}

}  // namespace fase::test

namespace rc {

template <class T> struct Arbitrary<fase::Vec3Of<T>> {
    static Gen<fase::Vec3Of<T>> arbitrary() {
        return gen::exec([] {
            const double x = fase::test::number(), y = fase::test::number(), z = fase::test::number();
            return fase::Vec3Of<T>{static_cast<T>(x), static_cast<T>(y), static_cast<T>(z)};
        });
    }
};
template <> struct Arbitrary<fase::Quat> {
    static Gen<fase::Quat> arbitrary() {
        return gen::exec([] { return fase::normalized(fase::to_float(fase::test::rotation())); });
    }
};
template <> struct Arbitrary<fase::Quatd> {
    static Gen<fase::Quatd> arbitrary() {
        return gen::exec([] { return fase::test::rotation(); });
    }
};
template <class T> struct Arbitrary<fase::Mat3Of<T>> {
    static Gen<fase::Mat3Of<T>> arbitrary() {
        return gen::construct<fase::Mat3Of<T>>(gen::arbitrary<fase::Vec3Of<T>>(), gen::arbitrary<fase::Vec3Of<T>>(),
                                               gen::arbitrary<fase::Vec3Of<T>>());
    }
};
template <> struct Arbitrary<fase::LocalPose> {
    static Gen<fase::LocalPose> arbitrary() {
        return gen::construct<fase::LocalPose>(gen::arbitrary<fase::Vec3>(), gen::arbitrary<fase::Quat>());
    }
};
template <> struct Arbitrary<fase::Pose> {
    static Gen<fase::Pose> arbitrary() {
        return gen::construct<fase::Pose>(gen::arbitrary<fase::Vec3d>(), gen::arbitrary<fase::Quat>());
    }
};

}  // namespace rc
