/// The passes over blocks of contacts, written once for any lane type V (math/detail/lane.hpp,
/// math/detail/wide-inl.hpp). Included inside the namespace of each target, hence no #pragma once and no includes.
/// Source of the soft step: Catto 2024, Solver2D (small steps, relax, restitution last); of the soft constraint: Catto
/// 2011.

#ifndef FASE_LAMBDA_INLINE
#define FASE_LAMBDA_INLINE __attribute__((always_inline))
#endif
#ifndef FASE_INLINE
#define FASE_INLINE inline __attribute__((always_inline))
#endif

template <class V> struct Vec {
    V x, y, z;
    friend FASE_INLINE Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend FASE_INLINE Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend FASE_INLINE Vec operator*(Vec a, V s) { return {a.x * s, a.y * s, a.z * s}; }
};
template <class V> FASE_INLINE V dot(Vec<V> a, Vec<V> b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class V> FASE_INLINE Vec<V> cross(Vec<V> a, Vec<V> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class V> FASE_INLINE V max_of(V a, V b) { return select_greater(a, b, a, b); }
template <class V> FASE_INLINE V min_of(V a, V b) { return select_greater(b, a, a, b); }
template <class V> struct Symmetric { V xx, xy, xz, yy, yz, zz; };
template <class V> FASE_INLINE Vec<V> operator*(const Symmetric<V>& m, Vec<V> v) {
    return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
            m.xz * v.x + m.yz * v.y + m.zz * v.z};
}
template <class V> FASE_INLINE Vec<V> load3(const float (*rows)[8], int lane) {
    return {V::load(rows[0] + lane), V::load(rows[1] + lane), V::load(rows[2] + lane)};
}
/// The inverse rotation of `n` by the quaternion (q, w), less n.
template <class V> FASE_INLINE Vec<V> turned_back_less(Vec<V> q, V w, Vec<V> n) {
    return cross(q, cross(q, n) - n * w) * V::set(2.0f);
}

/// Velocities of the two bodies of each lane.
template <class V> struct Velocities {
    Vec<V> va, wa, vb, wb;
    V mass_a, mass_b, rest_a, rest_b;  // inverse masses ride along in the rows

    FASE_INLINE void gather(const SolverBody* bodies, const std::uint32_t* a, const std::uint32_t* b) {
        V row[8];
        const float* base = reinterpret_cast<const float*>(bodies);
        V::gather8(base, a, 16, row);
        va = {row[0], row[1], row[2]};
        mass_a = row[3];
        wa = {row[4], row[5], row[6]};
        rest_a = row[7];
        V::gather8(base, b, 16, row);
        vb = {row[0], row[1], row[2]};
        mass_b = row[3];
        wb = {row[4], row[5], row[6]};
        rest_b = row[7];
    }
    template <bool one_sided>
    FASE_INLINE void scatter(SolverBody* bodies, const std::uint32_t* a, const std::uint32_t* b) const {
        float* base = reinterpret_cast<float*>(bodies);
        if constexpr (!one_sided) {
            const V row[8] = {va.x, va.y, va.z, mass_a, wa.x, wa.y, wa.z, rest_a};
            V::scatter8(base, a, 16, row);
        }
        const V row[8] = {vb.x, vb.y, vb.z, mass_b, wb.x, wb.y, wb.z, rest_b};
        V::scatter8(base, b, 16, row);
    }
    /// Applies the impulse `p` at the manifold's centre and the torque impulse `turn`, to b and reversed to a.
    template <bool one_sided>
    FASE_INLINE void apply(Vec<V> p, Vec<V> turn, Vec<V> ca, Vec<V> cb, const Symmetric<V>& ia,
                           const Symmetric<V>& ib) {
        if constexpr (!one_sided) {
            va = va - p * mass_a;
            wa = wa - ia * (cross(ca, p) + turn);
        }
        vb = vb + p * mass_b;
        wb = wb + ib * (cross(cb, p) + turn);
    }
};

template <class V>
FASE_INLINE Symmetric<V> gather_inertia(const SolverMass* masses, const std::uint32_t* rows, V* inverse_mass) {
    V row[8];
    V::gather8(reinterpret_cast<const float*>(masses), rows, 8, row);
    *inverse_mass = row[6];
    return {row[0], row[1], row[2], row[3], row[4], row[5]};
}

/// Fills in what follows from the frozen manifold and the bodies as they stand at the begin of the step.
template <class V> void prepare_lanes(ContactBlock& k, int s, const PassInput& in) {
    const V zero = V::set(0.0f), one = V::set(1.0f);
    V ma, mb;
    const Symmetric<V> ia = gather_inertia<V>(in.masses, k.a + s, &ma);
    const Symmetric<V> ib = gather_inertia<V>(in.masses, k.b + s, &mb);
    Velocities<V> u;
    u.gather(in.bodies, k.a + s, k.b + s);
    const Vec<V> n = load3<V>(k.normal, s), t1 = load3<V>(k.tangent, s), t2 = cross(n, t1);
    const Vec<V> ca = load3<V>(k.offset_a, s), cb = load3<V>(k.offset_b, s), shift = load3<V>(k.shift, s);

    // Separations as of now: the manifold moved with its bodies since it was made.
    const Vec<V> ea = turned_back_less(load3<V>(k.turn_a, s), V::load(k.turn_a[3] + s), n);
    const Vec<V> eb = turned_back_less(load3<V>(k.turn_b, s), V::load(k.turn_b[3] + s), n);
    const Vec<V> e = eb - ea;
    const V base = dot(n, shift) + dot(eb, cb) - dot(ea, ca), e1 = dot(e, t1), e2 = dot(e, t2);

    const Vec<V> ja = cross(ca, n), jb = cross(cb, n), ija = ia * ja, ijb = ib * jb, ij = ija + ijb;
    const Symmetric<V> sum{ia.xx + ib.xx, ia.xy + ib.xy, ia.xz + ib.xz, ia.yy + ib.yy, ia.yz + ib.yz, ia.zz + ib.zz};
    const V mass = ma + mb;
    const Vec<V> sum_t1 = sum * t1, sum_t2 = sum * t2, sum_n = sum * n;
    const V m00 = mass + dot(ja, ija) + dot(jb, ijb), m01 = zero - dot(t2, ij), m02 = dot(t1, ij);
    const V m11 = dot(t2, sum_t2), m12 = zero - dot(t1, sum_t2), m22 = dot(t1, sum_t1);
    m00.store(k.coupling[0] + s);
    m01.store(k.coupling[1] + s);
    m02.store(k.coupling[2] + s);
    m11.store(k.coupling[3] + s);
    m12.store(k.coupling[4] + s);
    m22.store(k.coupling[5] + s);

    const Vec<V> rel = u.vb + cross(u.wb, cb) - u.va - cross(u.wa, ca), spin = u.wb - u.wa;
    const V q0 = dot(n, rel), q1 = zero - dot(t2, spin), q2 = dot(t1, spin);
    for (int i = 0; i < 4; ++i) {
        const V x = V::load(k.x[i] + s), y = V::load(k.y[i] + s), present = V::load(k.point_mass[i] + s);
        const V two_x = x + x, two_y = y + y;
        const V mass_here = m00 + two_x * m01 + two_y * m02 + x * x * m11 + y * y * m22 + two_x * y * m12;
        const V inverse = select_greater(mass_here, zero, one / mass_here, zero);
        select_greater(present, zero, inverse, zero).store(k.point_mass[i] + s);
        (V::load(k.separation[i] + s) + base + x * e1 + y * e2).store(k.separation[i] + s);
        (zero - (q0 + x * q1 + y * q2)).store(k.approach[i] + s);
        sqrt_of(x * x + y * y).store(k.lever[i] + s);
    }

    const Vec<V> a1 = cross(ca, t1), a2 = cross(ca, t2), b1 = cross(cb, t1), b2 = cross(cb, t2);
    const Vec<V> ia1 = ia * a1, ia2 = ia * a2, ib1 = ib * b1, ib2 = ib * b2;
    const V k11 = mass + dot(a1, ia1) + dot(b1, ib1), k22 = mass + dot(a2, ia2) + dot(b2, ib2);
    const V k12 = dot(a1, ia2) + dot(b1, ib2), det = k11 * k22 - k12 * k12;
    const V inverse = select_greater(det, zero, one / det, zero);
    (k22 * inverse).store(k.friction_mass[0] + s);
    (zero - k12 * inverse).store(k.friction_mass[1] + s);
    (k11 * inverse).store(k.friction_mass[2] + s);
    const V twist = dot(n, sum_n);
    select_greater(twist, zero, one / twist, zero).store(k.twist_mass + s);
    dot(n, ia1 + ib1).store(k.twist_coupling[0] + s);
    dot(n, ia2 + ib2).store(k.twist_coupling[1] + s);
}

/// Starts with the impulses of the last step.
template <class V, bool one_sided> void warm_start_lanes(ContactBlock& k, int s, const PassInput& in) {
    V ignored;
    const Symmetric<V> ia = gather_inertia<V>(in.masses, k.a + s, &ignored);
    const Symmetric<V> ib = gather_inertia<V>(in.masses, k.b + s, &ignored);
    Velocities<V> u;
    u.gather(in.bodies, k.a + s, k.b + s);
    const Vec<V> n = load3<V>(k.normal, s), t1 = load3<V>(k.tangent, s), t2 = cross(n, t1);
    V sum = V::set(0.0f), sx = sum, sy = sum;
    for (int i = 0; i < 4; ++i) {
        const V impulse = V::load(k.impulse[i] + s);
        sum = sum + impulse;
        sx = sx + V::load(k.x[i] + s) * impulse;
        sy = sy + V::load(k.y[i] + s) * impulse;
    }
    const Vec<V> p = n * sum + t1 * V::load(k.friction_impulse[0] + s) + t2 * V::load(k.friction_impulse[1] + s);
    const Vec<V> turn = t1 * sy - t2 * sx + n * V::load(k.twist_impulse + s);
    u.template apply<one_sided>(p, turn, load3<V>(k.offset_a, s), load3<V>(k.offset_b, s), ia, ib);
    u.template scatter<one_sided>(in.bodies, k.a + s, k.b + s);
}

/// Friction takes this part of its correction a pass: the rest follows in the next ones, and neighbours in a wall do
/// not overshoot each other.
constexpr float friction_gain = 0.7f;

/// One Gauss-Seidel pass. `biased`: soft, pushes overlap out; otherwise it relaxes: hard, and with friction.
template <class V, bool one_sided, bool biased> void solve_lanes(ContactBlock& k, int s, const PassInput& in) {
    const V zero = V::set(0.0f), one = V::set(1.0f), rate = V::set(1.0f / in.sub_step);
    const V bias_rate = V::set(in.softness.mass_scale * in.softness.bias_rate);
    const V mass_scale = V::set(in.softness.mass_scale), impulse_scale = V::set(in.softness.impulse_scale);
    const V fastest_out = V::set(-in.push_out_speed);
    V ignored;
    const Symmetric<V> ia = gather_inertia<V>(in.masses, k.a + s, &ignored);
    const Symmetric<V> ib = gather_inertia<V>(in.masses, k.b + s, &ignored);
    Velocities<V> u;
    u.gather(in.bodies, k.a + s, k.b + s);
    const Vec<V> n = load3<V>(k.normal, s), t1 = load3<V>(k.tangent, s), t2 = cross(n, t1);
    const Vec<V> ca = load3<V>(k.offset_a, s), cb = load3<V>(k.offset_b, s);

    V base, e1, e2;
    {
        V a[8], b[8];
        const float* poses = reinterpret_cast<const float*>(in.bodies) + 8;
        V::gather8(poses, k.a + s, 16, a);
        V::gather8(poses, k.b + s, 16, b);
        const Vec<V> ea = turned_back_less(Vec<V>{a[4], a[5], a[6]}, a[7], n);
        const Vec<V> eb = turned_back_less(Vec<V>{b[4], b[5], b[6]}, b[7], n);
        const Vec<V> moved = Vec<V>{b[0], b[1], b[2]} - Vec<V>{a[0], a[1], a[2]}, e = eb - ea;
        base = dot(n, moved) + dot(eb, cb) - dot(ea, ca);
        e1 = dot(e, t1);
        e2 = dot(e, t2);
    }

    // Normal velocity as an affine function of the point; impulses change it through the 3 x 3 coupling alone.
    const Vec<V> rel = u.vb + cross(u.wb, cb) - u.va - cross(u.wa, ca), spin = u.wb - u.wa;
    V q0 = dot(n, rel), q1 = zero - dot(t2, spin), q2 = dot(t1, spin);
    const V m00 = V::load(k.coupling[0] + s), m01 = V::load(k.coupling[1] + s), m02 = V::load(k.coupling[2] + s);
    const V m11 = V::load(k.coupling[3] + s), m12 = V::load(k.coupling[4] + s), m22 = V::load(k.coupling[5] + s);
    V impulse[4], x[4], y[4], mass[4], bias[4], scale[4], decay[4];
    V mass_sum = zero, residual = zero, scaled = zero, decayed = zero;
    for (int i = 0; i < 4; ++i) {
        x[i] = V::load(k.x[i] + s);
        y[i] = V::load(k.y[i] + s);
        mass[i] = V::load(k.point_mass[i] + s);
        impulse[i] = V::load(k.impulse[i] + s);
        const V separation = V::load(k.separation[i] + s) + base + x[i] * e1 + y[i] * e2;
        if constexpr (biased) {
            bias[i] = select_greater(separation, zero, separation * rate, max_of(bias_rate * separation, fastest_out));
            scale[i] = select_greater(separation, zero, one, mass_scale);
            decay[i] = select_greater(separation, zero, zero, impulse_scale);
        } else {
            bias[i] = max_of(separation, zero) * rate;
            scale[i] = one;
            decay[i] = zero;
        }
        mass_sum = mass_sum + mass[i];
        residual = residual + (mass[i] * (scale[i] * (q0 + x[i] * q1 + y[i] * q2) + bias[i]) + decay[i] * impulse[i]);
        scaled = scaled + mass[i] * scale[i];
        decayed = decayed + mass[i] * decay[i];
    }
    V sum = zero, sx = zero, sy = zero;
    const auto push = [&](int i, V wanted) FASE_LAMBDA_INLINE {
        const V next = select_greater(mass[i], zero, max_of(wanted, zero), zero);
        const V d = next - impulse[i], dx = x[i] * d, dy = y[i] * d;
        impulse[i] = next;
        sum = sum + d;
        sx = sx + dx;
        sy = sy + dy;
        q0 = q0 + (m00 * d + m01 * dx + m02 * dy);
        q1 = q1 + (m01 * d + m11 * dx + m12 * dy);
        q2 = q2 + (m02 * d + m12 * dx + m22 * dy);
    };
    // First all points together, so that a load that rests on them evenly is borne evenly; then one by one.
    const V stiffness = mass_sum * (scaled * m00) + decayed;
    const V together = select_greater(stiffness, zero, residual / stiffness, zero);
    for (int i = 0; i < 4; ++i) push(i, impulse[i] - mass[i] * together);
    for (int i = 0; i < 4; ++i)
        push(i, impulse[i] - mass[i] * (scale[i] * (q0 + x[i] * q1 + y[i] * q2) + bias[i]) - decay[i] * impulse[i]);
    V total = zero, twist_limit = zero;
    for (int i = 0; i < 4; ++i) {
        impulse[i].store(k.impulse[i] + s);
        total = total + impulse[i];
        twist_limit = twist_limit + impulse[i] * V::load(k.lever[i] + s);
    }
    u.template apply<one_sided>(n * sum, t1 * sy - t2 * sx, ca, cb, ia, ib);

    {
        // Friction: a twist about the normal, then both tangents at once inside the cone.
        const V mu = V::load(k.friction + s), gain = V::set(friction_gain);
        const Vec<V> rel2 = u.vb + cross(u.wb, cb) - u.va - cross(u.wa, ca), spin2 = u.wb - u.wa;
        const V old_twist = V::load(k.twist_impulse + s), limit = mu * twist_limit;
        const V twist =
            min_of(max_of(old_twist - gain * V::load(k.twist_mass + s) * dot(n, spin2), zero - limit), limit);
        twist.store(k.twist_impulse + s);
        const V d = twist - old_twist;
        const V u1 = dot(rel2, t1) + V::load(k.twist_coupling[0] + s) * d;
        const V u2 = dot(rel2, t2) + V::load(k.twist_coupling[1] + s) * d;
        const V f0 = V::load(k.friction_mass[0] + s), f1 = V::load(k.friction_mass[1] + s),
                f2 = V::load(k.friction_mass[2] + s);
        const V old1 = V::load(k.friction_impulse[0] + s), old2 = V::load(k.friction_impulse[1] + s);
        V new1 = old1 - gain * (f0 * u1 + f1 * u2), new2 = old2 - gain * (f1 * u1 + f2 * u2);
        const V most = mu * total, squared = new1 * new1 + new2 * new2;
        const V shrink = select_greater(squared, most * most, most / sqrt_of(squared), one);
        new1 = new1 * shrink;
        new2 = new2 * shrink;
        new1.store(k.friction_impulse[0] + s);
        new2.store(k.friction_impulse[1] + s);
        u.template apply<one_sided>(t1 * (new1 - old1) + t2 * (new2 - old2), n * d, ca, cb, ia, ib);
    }
    u.template scatter<one_sided>(in.bodies, k.a + s, k.b + s);
}

template <class V> void prepare_blocks(ContactBlock* blocks, std::size_t count, const PassInput& in) {
    for (std::size_t i = 0; i < count; ++i)
        for (int s = 0; s < block_lanes; s += V::lanes) prepare_lanes<V>(blocks[i], s, in);
}
template <class V, bool one_sided>
void run_one(Pass pass, ContactBlock* blocks, std::size_t count, const PassInput& in) {
    for (std::size_t i = 0; i < count; ++i)
        for (int s = 0; s < block_lanes; s += V::lanes) switch (pass) {
                case Pass::WarmStart: warm_start_lanes<V, one_sided>(blocks[i], s, in); break;
                case Pass::Biased: solve_lanes<V, one_sided, true>(blocks[i], s, in); break;
                case Pass::Relax: solve_lanes<V, one_sided, false>(blocks[i], s, in); break;
                case Pass::Prepare: break;
            }
}
template <class V>
void run_blocks(Pass pass, ContactBlock* blocks, std::size_t count, bool one_sided, const PassInput& in) {
    if (pass == Pass::Prepare) {
        prepare_blocks<V>(blocks, count, in);
    } else if (one_sided) {
        run_one<V, true>(pass, blocks, count, in);
    } else {
        run_one<V, false>(pass, blocks, count, in);
    }
}
