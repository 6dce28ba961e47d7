#include "fase/query/cull.hpp"

#include <array>
#include <cmath>

#include "fase/query/round_regions.hpp"
#include "tests/query/boxes.hpp"

namespace fase::query::test {
namespace {

class EveryCamera : public EveryStructure {};

/// A symmetric perspective camera at `eye` that looks along -z: 2 · slope wide at 1 m, near 1 m, far 9 m. Column-major,
/// OpenGL depth range.
std::array<float, 16> camera(Vec3 eye, float slope) {
    const float near = 1, far = 9, scale = 1 / slope;
    const float a = -(far + near) / (far - near), b = -2 * far * near / (far - near);
    return {scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, a, -1, -eye.x * scale, -eye.y * scale, -eye.z * a + b, eye.z};
}

TEST_P(EveryCamera, SeesWhatIsInFrontOfTheCamera) {
    EXPECT_TRUE(rc::check([&] {
        const auto boxes = *any_boxes();
        const Vec3 eye = *any_point() + Vec3{0, 0, 6};
        const float slope = *rc::gen::element(0.5f, 1.0f, 2.0f);
        std::vector<Proxy> inside, partly;
        RC_ASSERT(bool(cull(filled(GetParam(), boxes), camera(eye, slope), ClipDepth::MinusOneToOne, inside, &partly)));
        std::sort(inside.begin(), inside.end());
        std::sort(partly.begin(), partly.end());
        // Scaled distance of each corner inside each plane. Corners within `slack` of a plane count as inside.
        const auto corners = [&](const Aabb& box, double slack, bool all) {
            std::array<int, 6> in{};
            for (int corner = 0; corner < 8; ++corner) {
                const Vec3d p = Vec3d{corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                                      corner & 4 ? box.hi.z : box.lo.z} -
                                to_double(eye);
                const double reach = -p.z * slope;
                const std::array<double, 6> depth{reach + p.x, reach - p.x, reach + p.y,
                                                  reach - p.y, -p.z - 1,    9 + p.z};
                for (std::size_t side = 0; side < 6; ++side) in[side] += depth[side] >= -slack ? 1 : 0;
            }
            return std::all_of(in.begin(), in.end(), [&](int count) { return all ? count == 8 : count > 0; });
        };
        for (Proxy p = 0; p < boxes.size(); ++p) {
            const bool seen = std::binary_search(inside.begin(), inside.end(), p);
            const bool cut = std::binary_search(partly.begin(), partly.end(), p);
            RC_ASSERT(seen || !cut);
            if (corners(boxes[p], -1e-4, true)) RC_ASSERT(seen && !cut);
            if (!corners(boxes[p], 1e-4, false)) RC_ASSERT(!seen);
            if (seen && !cut) RC_ASSERT(corners(boxes[p], 1e-4, true));
            const Vec3 middle = centre(boxes[p]);
            if (corners({middle, middle}, -1e-4, true)) RC_ASSERT(seen);
        }
        RC_ASSERT(std::adjacent_find(inside.begin(), inside.end()) == inside.end());
    }));
}

TEST_P(EveryCamera, DistinguishesBoxesInsideASphereFromBoxesPartlyInside) {
    const AnyStructure structure =
        filled(GetParam(), {{{-1, -1, -1}, {1, 1, 1}}, {{1, 0, 0}, {9, 1, 1}}, {{3, 3, 3}, {4, 4, 4}}});
    std::vector<Proxy> inside, partly;
    cull(structure, SphereRegion({0, 0, 0}, 2), inside, &partly);
    std::sort(inside.begin(), inside.end());
    EXPECT_EQ(inside, (std::vector<Proxy>{0, 1}));
    EXPECT_EQ(partly, std::vector<Proxy>{1});
}

TEST(Cull, RejectsASingularMatrix) {
    const AnyStructure structure = filled("brute_force", {{{0, 0, 0}, {1, 1, 1}}});
    std::vector<Proxy> inside;
    const std::array<float, 16> zeros{};
    EXPECT_EQ(cull(structure, zeros, ClipDepth::ZeroToOne, inside).status(), Status::BadArgument);
    EXPECT_TRUE(inside.empty());
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryCamera, ::testing::ValuesIn(structure_names()), name_of);

}  // namespace
}  // namespace fase::query::test
