/// A ray against eight triangles. Included inside the namespace of each target, hence no #pragma once and no includes.
/// Nothing is fused: two triangles compute the same number, with the opposite sign, for the edge that they share.

using Floats = hn::CappedTag<float, 8>;
using V = hn::Vec<Floats>;
constexpr int lanes = static_cast<int>(hn::MaxLanes(Floats()));
static_assert(8 % lanes == 0);

HWY_INLINE V splat(float value) { return hn::Set(Floats(), value); }

struct Wide3 {
    V x, y, z;
    friend HWY_INLINE Wide3 operator+(const Wide3& a, const Wide3& b) {
        return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
    }
    friend HWY_INLINE Wide3 operator-(const Wide3& a, const Wide3& b) {
        return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
    }
};
HWY_INLINE Wide3 splat(Vec3 v) { return {splat(v.x), splat(v.y), splat(v.z)}; }
HWY_INLINE V dot(const Wide3& a, const Wide3& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Wide3 cross(const Wide3& a, const Wide3& b) {
    return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
            hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

/// The ray's origin as a float and what is left of it, so that the way to a corner is rounded once.
struct WideRay {
    Wide3 origin, rest, direction;
    explicit WideRay(const Ray& ray)
        : origin(splat(to_float(ray.origin))),
          rest(splat(to_float(ray.origin - to_double(to_float(ray.origin))))),
          direction(splat(ray.direction)) {}
};

HWY_INLINE Wide3 load_corner(const TriangleBlock& block, int corner, int lane) {
    const auto axis = [&](int i) { return hn::Load(Floats(), block.corner[corner][i] + lane); };
    return {axis(0), axis(1), axis(2)};
}

/// Which triangles the ray meets between 0 and `farthest`, a bit each, and where.
HWY_INLINE std::uint32_t test_block(const TriangleBlock& block, const WideRay& ray, float farthest, float* at) {
    std::uint32_t bits = 0;
    const V zero = hn::Zero(Floats());
    for (int lane = 0; lane < 8; lane += lanes) {
        const Wide3 a = load_corner(block, 0, lane) - ray.origin - ray.rest;
        const Wide3 b = load_corner(block, 1, lane) - ray.origin - ray.rest;
        const Wide3 c = load_corner(block, 2, lane) - ray.origin - ray.rest;
        const Wide3 ab = b - a, bc = c - b, ca = a - c;
        const V u = dot(cross(ab, a + b), ray.direction);  // on which side of the edge the ray passes
        const V v = dot(cross(bc, b + c), ray.direction);
        const V w = dot(cross(ca, c + a), ray.direction);
        const V least = hn::Min(u, hn::Min(v, w)), most = hn::Max(u, hn::Max(v, w));
        const Wide3 normal = cross(ab, ca);  // reversed; the sign falls out of the quotient
        const V slope = dot(normal, ray.direction);
        const V t = hn::Div(dot(normal, a), slope);
        auto hit = hn::Or(hn::Ge(least, zero), hn::Le(most, zero));
        hit = hn::And(hit, hn::Ne(slope, zero));
        hit = hn::And(hit, hn::And(hn::Ge(t, zero), hn::Le(t, splat(farthest))));
        hn::Store(t, Floats(), at + lane);
        std::uint8_t mask[8] = {};
        hn::StoreMaskBits(Floats(), hit, mask);
        bits |= static_cast<std::uint32_t>(mask[0]) << lane;
    }
    return bits;
}

Hit cast_at(const RayMeshView& mesh, const Ray& ray, bool any) {
    const broad::RayMeasure measure(ray);
    const WideRay wide_ray(ray);
    Hit best;
    alignas(64) float at[8];
    const auto visit = [&](Proxy number, const Aabb&, float) -> float {
        const TriangleBlock& block = mesh.blocks[number];
        const float farthest = best.at < ray.length ? best.at : ray.length;
        for (std::uint32_t bits = test_block(block, wide_ray, farthest, at); bits != 0; bits &= bits - 1) {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
            if (at[lane] > best.at) continue;
            // Not before its box, where the search could have ended already: the answer is then that of all triangles.
            const float entry = measure.at(roomy_box(block, lane, mesh.room), ray.length);
            const Hit hit{at[lane] > entry ? at[lane] : entry, block.triangle[lane]};
            if (hit.at <= ray.length && hit < best) best = hit;
        }
        return any && best.met() ? -1.0f : best.at;
    };
    mesh.tree.nearest_first(measure, ray.length, broad::wide::Near(visit));
    return best;
}
