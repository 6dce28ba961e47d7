/// Signed distances compared with published values, for pairs that were wrong in other collision libraries.
#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fase/core/detail/files.hpp"
#include "fase/narrow/distance.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase {
namespace {

using scene::JsonValue;

std::vector<double> numbers(const JsonValue& object, const char* key) {
    std::vector<double> found;
    const auto array = object.find(key);
    if (array) array->for_each_element([&](const JsonValue& v) { found.push_back(v.number()); });
    return found;
}

struct Placed {
    Shape shape;
    TransformD pose;
};

/// Reads a shape and its pose; nullopt: a shape that Fase does not have.
std::optional<Placed> placed(const JsonValue& object) {
    const std::string_view type = object.find("type")->string();
    const std::vector<double> s = numbers(object, "size"), p = numbers(object, "pos"), r = numbers(object, "rot");
    Placed result;
    bool known = false;
    for_each_shape([&]<class S>() {
        if constexpr (SizedShape<S>) {
            if (type != S::name) return;
            known = true;
            SizeNumbers<S> sizes;
            for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = static_cast<float>(s[i]);
            result.shape = shape_with<S>(sizes);
        }
    });
    if (!known) return std::nullopt;
    result.pose.position = {p[0], p[1], p[2]};
    result.pose.rotation = {{r[0], r[3], r[6]}, {r[1], r[4], r[7]}, {r[2], r[5], r[8]}};
    // The axis of round shapes is z there and y here.
    if (type == "capsule" || type == "cylinder") {
        result.pose.rotation = result.pose.rotation * Mat3d{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    }
    return result;
}

TEST(PublishedPairs, MatchWithinTheirTolerances) {
    const std::string file = std::string(FASE_SHARED_DATA) + "/shape-pairs/pairs.json";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "skipped: no " << file;
    const auto bytes = read_file(file, 1 << 26);
    ASSERT_TRUE(bytes);
    const auto document = scene::parse_json({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
    ASSERT_TRUE(document);
    int compared = 0;
    document->root().find("cases")->for_each_element([&](const JsonValue& one) {
        const auto a = placed(*one.find("a")), b = placed(*one.find("b"));
        if (!a || !b) return;
        const std::string_view id = one.find("id")->string();
        const TransformD x = inverse(a->pose) * b->pose;
        const narrow::Distance d = narrow::signed_distance(a->shape, b->shape, x);
        if (const auto published = one.find("distance")) {
            EXPECT_NEAR(d.distance, published->number(), one.find("tol")->number()) << id;
            ++compared;
        }
        if (const auto sign = one.find("sign")) {
            EXPECT_GT(d.distance * sign->number(), 0) << id;
            EXPECT_EQ(narrow::overlaps(a->shape, b->shape, x), sign->number() < 0) << id;
            ++compared;
        }
        if (const auto computed = one.find("distance_computed_by_us")) {
            EXPECT_NEAR(d.distance, computed->number(), 1e-6) << id;
        }
        const std::vector<double> normal = numbers(one, "normal");
        if (normal.size() == 3) {
            const Vec3d world = a->pose.rotation * d.normal;
            EXPECT_LT(length(cross(world, Vec3d{normal[0], normal[1], normal[2]})), 1e-6) << id;
        }
    });
    EXPECT_GT(compared, 150);
}

}  // namespace
}  // namespace fase
