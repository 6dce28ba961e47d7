/// A ray against eight triangles. Included inside the namespace of each target, hence no #pragma once and no includes.
///
/// The corners are sheared so that the ray runs along an axis; then the question is on which side of the edges, drawn
/// in the plane, the origin lies. Nothing is fused and rounding is monotone: a difference of products has the right
/// sign or is 0, and then double, in which products of floats are exact, decides. So all triangles of a mesh agree.

using Floats = hn::CappedTag<float, 8>;
using V = hn::Vec<Floats>;
constexpr int lanes = static_cast<int>(hn::MaxLanes(Floats()));
static_assert(8 % lanes == 0);

HWY_INLINE V splat(float value) { return hn::Set(Floats(), value); }

struct ShearedRay {
    int axis[3];      // the last is the one along which the ray runs fastest
    float origin[3];  // in the order of `axis`
    float rest[3];    // what the float origin lacks, so that the way to a corner is rounded once
    float shear_x, shear_y, scale;

    explicit ShearedRay(const Ray& ray) {
        const Vec3 size = abs(ray.direction);
        const int fastest = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        for (int i = 0; i < 3; ++i) {
            axis[i] = (fastest + 1 + i) % 3;
            origin[i] = static_cast<float>(ray.origin[axis[i]]);
            rest[i] = static_cast<float>(ray.origin[axis[i]] - double(origin[i]));
        }
        scale = 1 / ray.direction[fastest];
        shear_x = ray.direction[axis[0]] * scale;
        shear_y = ray.direction[axis[1]] * scale;
    }
};

/// A corner of each triangle: in the plane, and how far along the ray's axis.
struct Corner {
    V x, y, z;
};
HWY_INLINE Corner sheared(const float (*corner)[8], int lane, const ShearedRay& ray) {
    const auto way = [&](int i) {
        const V at = hn::Load(Floats(), corner[ray.axis[i]] + lane);
        return hn::Sub(hn::Sub(at, splat(ray.origin[i])), splat(ray.rest[i]));
    };
    const V z = way(2);
    return {hn::Sub(way(0), hn::Mul(splat(ray.shear_x), z)), hn::Sub(way(1), hn::Mul(splat(ray.shear_y), z)), z};
}
/// On which side of the edge from a to b the ray passes: twice the surface that they span.
HWY_INLINE V side_of(const Corner& a, const Corner& b) { return hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x)); }

/// The same in double, rounded: 0 only where it is 0.
HWY_NOINLINE V exact_side(const Corner& a, const Corner& b) {
    alignas(64) float ax[8], ay[8], bx[8], by[8], side[8];
    hn::Store(a.x, Floats(), ax);
    hn::Store(a.y, Floats(), ay);
    hn::Store(b.x, Floats(), bx);
    hn::Store(b.y, Floats(), by);
    for (int i = 0; i < lanes; ++i) {
        const double exact = double(ax[i]) * double(by[i]) - double(ay[i]) * double(bx[i]);
        const float rounded = static_cast<float>(exact);
        const float tiny =
            exact > 0 ? std::numeric_limits<float>::denorm_min() : -std::numeric_limits<float>::denorm_min();
        side[i] = rounded == 0 && exact != 0 ? tiny : rounded;
    }
    return hn::Load(Floats(), side);
}

HWY_INLINE std::uint32_t bits_of(hn::Mask<Floats> mask) {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(Floats(), mask, bits);
    return bits[0];
}

/// Which triangles the ray meets between 0 and `farthest`, a bit each, and where.
HWY_INLINE std::uint32_t test_block(const TriangleBlock& block, const ShearedRay& ray, float farthest, float* at) {
    std::uint32_t met = 0;
    const V zero = hn::Zero(Floats());
    for (int lane = 0; lane < 8; lane += lanes) {
        const Corner a = sheared(block.corner[0], lane, ray), b = sheared(block.corner[1], lane, ray),
                     c = sheared(block.corner[2], lane, ray);
        V u = side_of(c, b), v = side_of(a, c), w = side_of(b, a);
        const auto on_line = hn::Or(hn::Eq(u, zero), hn::Or(hn::Eq(v, zero), hn::Eq(w, zero)));
        // Where there is no triangle all is 0, on every line.
        const auto there = hn::Load(hn::CappedTag<std::uint32_t, 8>(), block.triangle + lane);
        const auto used = hn::Ne(there, hn::Set(hn::CappedTag<std::uint32_t, 8>(), nothing));
        if (bits_of(hn::And(on_line, hn::RebindMask(Floats(), used))) != 0) {
            u = exact_side(c, b);
            v = exact_side(a, c);
            w = exact_side(b, a);
        }
        const V least = hn::Min(u, hn::Min(v, w)), most = hn::Max(u, hn::Max(v, w));
        const V whole = hn::Add(hn::Add(u, v), w);
        const V sum = hn::Add(hn::Add(hn::Mul(u, a.z), hn::Mul(v, b.z)), hn::Mul(w, c.z));
        const V t = hn::Div(hn::Mul(sum, splat(ray.scale)), whole);
        auto hit = hn::Or(hn::Ge(least, zero), hn::Le(most, zero));
        hit = hn::And(hit, hn::Ne(whole, zero));
        hit = hn::And(hit, hn::And(hn::Ge(t, zero), hn::Le(t, splat(farthest))));
        hn::Store(t, Floats(), at + lane);
        met |= bits_of(hit) << lane;
    }
    return met;
}

Hit cast_at(const RayMeshView& mesh, const Ray& ray, bool any) {
    const broad::RayMeasure measure(ray);
    const ShearedRay sheared_ray(ray);
    Hit best;
    alignas(64) float at[8];
    const auto visit = [&](Proxy number, const Aabb&, float) -> float {
        const TriangleBlock& block = mesh.blocks[number];
        const float farthest = best.at < ray.length ? best.at : ray.length;
        for (std::uint32_t bits = test_block(block, sheared_ray, farthest, at); bits != 0; bits &= bits - 1) {
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
