/// Ray test against eight triangles. Included inside the namespace of each target, so no #pragma once and no includes.
///
/// The vertices are sheared so that the ray runs along a coordinate axis; the test is then on which side of the
/// projected edges the origin is. Without fused operations rounding is monotone, so a difference of products has the
/// correct sign or is 0; when it is 0, double decides, where products of floats are exact. So all triangles of a mesh
/// agree.

using Floats = hn::CappedTag<float, 8>;
using V = hn::Vec<Floats>;
constexpr int lanes = static_cast<int>(hn::MaxLanes(Floats()));
static_assert(8 % lanes == 0);

HWY_INLINE V splat(float value) { return hn::Set(Floats(), value); }

struct ShearedRay {
    int axis[3];      // the last is the dominant axis of the ray
    float origin[3];  // in the order of `axis`
    float rest[3];    // rounding error of `origin`, so that vertices relative to the origin are rounded once
    float shear_x, shear_y, scale;

    explicit ShearedRay(const Ray& ray) {
        const Vec3 size = abs(ray.direction);
        const int dominant = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        for (int i = 0; i < 3; ++i) {
            axis[i] = (dominant + 1 + i) % 3;
            origin[i] = static_cast<float>(ray.origin[axis[i]]);
            rest[i] = static_cast<float>(ray.origin[axis[i]] - double(origin[i]));
        }
        scale = 1 / ray.direction[dominant];
        shear_x = ray.direction[axis[0]] * scale;
        shear_y = ray.direction[axis[1]] * scale;
    }
};

/// A vertex of each triangle: x and y in the projection plane, z along the ray's axis.
struct Corner {
    V x, y, z;
};
HWY_INLINE Corner sheared(const float (*corner)[8], int lane, const ShearedRay& ray) {
    const auto from_origin = [&](int i) {
        const V position = hn::Load(Floats(), corner[ray.axis[i]] + lane);
        return hn::Sub(hn::Sub(position, splat(ray.origin[i])), splat(ray.rest[i]));
    };
    const V z = from_origin(2);
    return {hn::Sub(from_origin(0), hn::Mul(splat(ray.shear_x), z)),
            hn::Sub(from_origin(1), hn::Mul(splat(ray.shear_y), z)), z};
}
/// Returns on which side of the edge from a to b the ray passes: twice the signed area of the triangle with the origin.
HWY_INLINE V side_of(const Corner& a, const Corner& b) { return hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x)); }

/// The same, computed in double and rounded to float: 0 only when it is exactly 0.
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

/// Returns a bit for each triangle that the ray hits between 0 and `limit`, and stores the distances.
HWY_INLINE std::uint32_t test_block(const TriangleBlock& block, const ShearedRay& ray, float limit, float* distance) {
    std::uint32_t hits = 0;
    const V zero = hn::Zero(Floats());
    for (int lane = 0; lane < 8; lane += lanes) {
        const Corner a = sheared(block.corner[0], lane, ray), b = sheared(block.corner[1], lane, ray),
                     c = sheared(block.corner[2], lane, ray);
        V u = side_of(c, b), v = side_of(a, c), w = side_of(b, a);
        const auto on_line = hn::Or(hn::Eq(u, zero), hn::Or(hn::Eq(v, zero), hn::Eq(w, zero)));
        // Unused lanes are all 0, which looks like an edge; they must not cause the slow path.
        const auto triangle = hn::Load(hn::CappedTag<std::uint32_t, 8>(), block.triangle + lane);
        const auto used = hn::Ne(triangle, hn::Set(hn::CappedTag<std::uint32_t, 8>(), no_index));
        if (bits_of(hn::And(on_line, hn::RebindMask(Floats(), used))) != 0) {
            u = exact_side(c, b);
            v = exact_side(a, c);
            w = exact_side(b, a);
        }
        const V min = hn::Min(u, hn::Min(v, w)), max = hn::Max(u, hn::Max(v, w));
        const V determinant = hn::Add(hn::Add(u, v), w);
        const V sum = hn::Add(hn::Add(hn::Mul(u, a.z), hn::Mul(v, b.z)), hn::Mul(w, c.z));
        const V t = hn::Div(hn::Mul(sum, splat(ray.scale)), determinant);
        auto hit = hn::Or(hn::Ge(min, zero), hn::Le(max, zero));
        hit = hn::And(hit, hn::Ne(determinant, zero));
        hit = hn::And(hit, hn::And(hn::Ge(t, zero), hn::Le(t, splat(limit))));
        hn::Store(t, Floats(), distance + lane);
        hits |= bits_of(hit) << lane;
    }
    return hits;
}

Hit cast_at(const RayMeshView& mesh, const Ray& ray, bool any) {
    const broad::RayMeasure measure(ray);
    const ShearedRay sheared_ray(ray);
    Hit best;
    alignas(64) float distance[8];
    const auto visit = [&](Proxy index, const Aabb&, float) -> float {
        const TriangleBlock& block = mesh.blocks[index];
        const float limit = best.distance < ray.length ? best.distance : ray.length;
        for (std::uint32_t bits = test_block(block, sheared_ray, limit, distance); bits != 0; bits &= bits - 1) {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
            if (distance[lane] > best.distance) continue;
            // A hit never counts before the entry into its box, so the result does not depend on the traversal order.
            const float entry = measure.distance(triangle_box(block, lane, mesh.margin), ray.length);
            const Hit hit{distance[lane] > entry ? distance[lane] : entry, block.triangle[lane]};
            if (hit.distance <= ray.length && hit < best) best = hit;
        }
        return any && best.is_hit() ? -1.0f : best.distance;
    };
    mesh.tree.nearest_first(measure, ray.length, broad::wide::VisitNear(visit));
    return best;
}
