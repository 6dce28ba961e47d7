/// The solver passes over blocks of contacts, as templates over the lane type V (math/detail/lane.hpp,
/// math/detail/wide-inl.hpp). Included inside the namespace of each target, so no #pragma once and no includes.
/// Functions take a block `k` and the first lane `s` of V in it. The order of the operations is part of the results.
/// Source of the soft step: Catto 2024, Solver2D (small steps, relax, restitution last); of the soft constraint: Catto
/// 2011.

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
/// Returns v with its components multiplied by those of m.
template <class V> FASE_INLINE Vec<V> scaled(Vec<V> m, Vec<V> v) { return {m.x * v.x, m.y * v.y, m.z * v.z}; }
/// Returns R⁻¹ n - n for the rotation of a body about `rotated` (radians). With `turns` = 0 only the part that is
/// linear in the angle: for points that keep their place on a rolling body. Source of the rational form: Cayley 1846.
template <class V> FASE_INLINE Vec<V> inverse_rotation_delta(Vec<V> rotated, V turns, Vec<V> n) {
    const V half = V::set(0.5f), one = V::set(1.0f), two = V::set(2.0f);
    const Vec<V> t = rotated * half, tn = cross(t, n);
    return (cross(t, tn) * turns - tn) * (two / (one + turns * dot(t, t)));
}

/// The contact frame of each lane: the unit normal, two unit tangents, and the offsets from the two centres of mass to
/// the centre of the manifold.
template <class V> struct Frame {
    Vec<V> n, t1, t2, ca, cb;

    static FASE_INLINE Frame load(const ContactBlock& k, int s) {
        const Vec<V> n = load3<V>(k.normal, s), t1 = load3<V>(k.tangent, s);
        return {n, t1, cross(n, t1), load3<V>(k.offset_a, s), load3<V>(k.offset_b, s)};
    }
};

/// Inverse inertia tensors (world axes) and inverse masses along the world axes of the two bodies of each lane.
template <class V> struct Inertia {
    Symmetric<V> a, b;
    Vec<V> mass_a, mass_b;

    /// `z_a` and `z_b` are the inverse masses along z, which the rows of the velocities contain.
    template <Sides sides>
    FASE_INLINE void gather(const SolverMass* masses, const ContactBlock& k, int s, V z_a, V z_b) {
        const float* base = reinterpret_cast<const float*>(masses);
        V row[8];
        V::gather8(base, k.a + s, 8, row);
        if constexpr (sides == Sides::Hub) {
            const V split = V::load(k.split + s);
            for (V& value : row) value = value * split;
            z_a = z_a * split;
        }
        a = {row[0], row[1], row[2], row[3], row[4], row[5]};
        mass_a = {row[6], row[7], z_a};
        V::gather8(base, k.b + s, 8, row);
        b = {row[0], row[1], row[2], row[3], row[4], row[5]};
        mass_b = {row[6], row[7], z_b};
    }
};

/// The velocities that each lane of a block gives its body a.
struct alignas(64) HubVelocities {
    float row[6][8];
};

/// Velocities of the two bodies of each lane.
template <class V> struct Velocities {
    Vec<V> va, wa, vb, wb;
    V mass_a, mass_b, rest_a, rest_b;  // the rows also contain the inverse mass along z and an unused float

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
    /// Writes the velocities back; those of shared bodies go to `hub` (see merge_hub()).
    template <Sides sides>
    FASE_INLINE void scatter(SolverBody* bodies, const ContactBlock& k, int s, HubVelocities& hub) const {
        float* base = reinterpret_cast<float*>(bodies);
        if constexpr (sides == Sides::Both) {
            const V row[8] = {va.x, va.y, va.z, mass_a, wa.x, wa.y, wa.z, rest_a};
            V::scatter8(base, k.a + s, 16, row);
        }
        if constexpr (sides == Sides::Hub) {
            const V row[6] = {va.x, va.y, va.z, wa.x, wa.y, wa.z};
            for (int i = 0; i < 6; ++i) row[i].store(hub.row[i] + s);
        }
        const V row[8] = {vb.x, vb.y, vb.z, mass_b, wb.x, wb.y, wb.z, rest_b};
        V::scatter8(base, k.b + s, 16, row);
    }
    /// Applies the impulse `p` at the centre of the manifold and the angular impulse `turn` to b, and the opposite to
    /// a.
    template <Sides sides> FASE_INLINE void apply(Vec<V> p, Vec<V> turn, const Frame<V>& f, const Inertia<V>& inertia) {
        if constexpr (sides != Sides::OnlyB) {
            va = va - scaled(inertia.mass_a, p);
            wa = wa - inertia.a * (cross(f.ca, p) + turn);
        }
        vb = vb + scaled(inertia.mass_b, p);
        wb = wb + inertia.b * (cross(f.cb, p) + turn);
    }
    /// Returns the velocity of b relative to a at the centre of the manifold.
    FASE_INLINE Vec<V> relative(const Frame<V>& f) const { return vb + cross(wb, f.cb) - va - cross(wa, f.ca); }
};

/// A quantity that is affine in the tangent coordinates of a point: centre + x slope_x + y slope_y.
template <class V> struct Affine {
    V centre, slope_x, slope_y;

    FASE_INLINE V at(V x, V y) const { return centre + x * slope_x + y * slope_y; }
    /// Returns `start` plus the quantity, added from left to right.
    FASE_INLINE V add_to(V start, V x, V y) const { return start + centre + x * slope_x + y * slope_y; }
};

/// Returns the relative velocity along the normal, positive when the bodies separate.
template <class V> FASE_INLINE Affine<V> normal_velocity(const Frame<V>& f, const Velocities<V>& u) {
    const Vec<V> relative = u.relative(f), spin = u.wb - u.wa;
    return {dot(f.n, relative), V::set(0.0f) - dot(f.t2, spin), dot(f.t1, spin)};
}

/// Computes the change of the separation since the beginning of the step from the motion of the bodies, and stores it
/// for the passes until the bodies move again. The tangent frame turns with the points of b, and at the same time with
/// those of a.
template <class V>
FASE_INLINE Affine<V> update_change(ContactBlock& k, int s, const Frame<V>& f, const SolverBody* bodies) {
    V a[8], b[8];
    const float* motions = reinterpret_cast<const float*>(bodies) + 8;
    V::gather8(motions, k.a + s, 16, a);
    V::gather8(motions, k.b + s, 16, b);
    const Vec<V> moved = Vec<V>{b[0], b[1], b[2]} - Vec<V>{a[0], a[1], a[2]};
    const Vec<V> ea = inverse_rotation_delta(Vec<V>{a[4], a[5], a[6]}, V::load(k.turns_a + s), f.n);
    const Vec<V> eb = inverse_rotation_delta(Vec<V>{b[4], b[5], b[6]}, V::load(k.turns_b + s), f.n), e = eb - ea;
    const Affine<V> change{dot(f.n, moved) + dot(eb, f.cb) - dot(ea, f.ca), dot(e, f.t1), dot(e, f.t2)};
    change.centre.store(k.change[0] + s);
    change.slope_x.store(k.change[1] + s);
    change.slope_y.store(k.change[2] + s);
    return change;
}
template <class V> FASE_INLINE Affine<V> load_change(const ContactBlock& k, int s) {
    return {V::load(k.change[0] + s), V::load(k.change[1] + s), V::load(k.change[2] + s)};
}

/// The symmetric 3 x 3 matrix by which normal impulses change the normal velocity.
template <class V> struct Coupling {
    V m00, m01, m02, m11, m12, m22;

    static FASE_INLINE Coupling load(const ContactBlock& k, int s) {
        return {V::load(k.coupling[0] + s), V::load(k.coupling[1] + s), V::load(k.coupling[2] + s),
                V::load(k.coupling[3] + s), V::load(k.coupling[4] + s), V::load(k.coupling[5] + s)};
    }
    FASE_INLINE void store(ContactBlock& k, int s) const {
        m00.store(k.coupling[0] + s);
        m01.store(k.coupling[1] + s);
        m02.store(k.coupling[2] + s);
        m11.store(k.coupling[3] + s);
        m12.store(k.coupling[4] + s);
        m22.store(k.coupling[5] + s);
    }
};

/// Returns the coupling of the normal impulses; `sum` is the sum of the inverse inertia tensors, `mass` that of the
/// inverse masses.
template <class V>
FASE_INLINE Coupling<V> normal_coupling(const Frame<V>& f, const Inertia<V>& inertia, const Symmetric<V>& sum,
                                        Vec<V> mass) {
    const V zero = V::set(0.0f);
    const Vec<V> ja = cross(f.ca, f.n), jb = cross(f.cb, f.n);
    const Vec<V> ija = inertia.a * ja, ijb = inertia.b * jb, ij = ija + ijb;
    const Vec<V> sum_t1 = sum * f.t1, sum_t2 = sum * f.t2;
    return {dot(f.n, scaled(mass, f.n)) + dot(ja, ija) + dot(jb, ijb),
            zero - dot(f.t2, ij),
            dot(f.t1, ij),
            dot(f.t2, sum_t2),
            zero - dot(f.t1, sum_t2),
            dot(f.t1, sum_t1)};
}

/// Stores effective mass and lever arm of each point, and with `first` its approach speed.
template <class V, bool first>
FASE_INLINE void prepare_points(ContactBlock& k, int s, const Coupling<V>& m, const Affine<V>& velocity) {
    const V zero = V::set(0.0f), one = V::set(1.0f);
    for (int i = 0; i < 4; ++i) {
        const V x = V::load(k.x[i] + s), y = V::load(k.y[i] + s), present = V::load(k.point_mass[i] + s);
        const V two_x = x + x, two_y = y + y;
        const V mass_here = m.m00 + two_x * m.m01 + two_y * m.m02 + x * x * m.m11 + y * y * m.m22 + two_x * y * m.m12;
        const V inverse = select_greater(mass_here, zero, one / mass_here, zero);
        select_greater(present, zero, inverse, zero).store(k.point_mass[i] + s);
        if constexpr (first) (zero - velocity.at(x, y)).store(k.approach[i] + s);
        sqrt_of(x * x + y * y).store(k.lever[i] + s);
    }
}

/// Stores the effective masses of tangential friction and of the twist about the normal. `sum` and `mass` as in
/// normal_coupling().
template <class V>
FASE_INLINE void prepare_friction(ContactBlock& k, int s, const Frame<V>& f, const Inertia<V>& inertia,
                                  const Symmetric<V>& sum, Vec<V> mass) {
    const V zero = V::set(0.0f), one = V::set(1.0f);
    const Vec<V> a1 = cross(f.ca, f.t1), a2 = cross(f.ca, f.t2), b1 = cross(f.cb, f.t1), b2 = cross(f.cb, f.t2);
    const Vec<V> ia1 = inertia.a * a1, ia2 = inertia.a * a2, ib1 = inertia.b * b1, ib2 = inertia.b * b2;
    const Vec<V> m1 = scaled(mass, f.t1), m2 = scaled(mass, f.t2);
    const V k11 = dot(f.t1, m1) + dot(a1, ia1) + dot(b1, ib1), k22 = dot(f.t2, m2) + dot(a2, ia2) + dot(b2, ib2);
    const V k12 = dot(f.t1, m2) + dot(a1, ia2) + dot(b1, ib2), det = k11 * k22 - k12 * k12;
    const V inverse = select_greater(det, zero, one / det, zero);
    (k22 * inverse).store(k.friction_mass[0] + s);
    (zero - k12 * inverse).store(k.friction_mass[1] + s);
    (k11 * inverse).store(k.friction_mass[2] + s);
    const Vec<V> sum_n = sum * f.n;
    const V twist = dot(f.n, sum_n);
    select_greater(twist, zero, one / twist, zero).store(k.twist_mass + s);
    dot(f.n, ia1 + ib1).store(k.twist_coupling[0] + s);
    dot(f.n, ia2 + ib2).store(k.twist_coupling[1] + s);
}

/// Computes all values of the block that depend on the manifold and on the masses of the bodies; with `first` also
/// those that depend on their velocities at the beginning of the step.
template <class V, Sides sides, bool first> void prepare_lanes(ContactBlock& k, int s, const PassInput& in) {
    Velocities<V> u;
    u.gather(in.bodies, k.a + s, k.b + s);
    Inertia<V> inertia;
    inertia.template gather<sides>(in.masses, k, s, u.mass_a, u.mass_b);
    const Frame<V> f = Frame<V>::load(k, s);
    const Symmetric<V>&ia = inertia.a, &ib = inertia.b;
    const Symmetric<V> sum{ia.xx + ib.xx, ia.xy + ib.xy, ia.xz + ib.xz, ia.yy + ib.yy, ia.yz + ib.yz, ia.zz + ib.zz};
    const Vec<V> mass = inertia.mass_a + inertia.mass_b;
    const Coupling<V> coupling = normal_coupling(f, inertia, sum, mass);
    coupling.store(k, s);
    prepare_points<V, first>(k, s, coupling, normal_velocity(f, u));
    prepare_friction(k, s, f, inertia, sum, mass);
}

/// Marks the lanes in which a point approaches faster than `impact_speed` and would touch within the sub-step: where
/// the contact passes would stop it.
template <class V> void find_impact_lanes(ContactBlock& k, int s, const PassInput& in) {
    const V zero = V::set(0.0f), one = V::set(1.0f), h = V::set(in.sub_step);
    Velocities<V> u;
    u.gather(in.bodies, k.a + s, k.b + s);
    const Frame<V> f = Frame<V>::load(k, s);
    const Affine<V> velocity = normal_velocity(f, u), change = load_change<V>(k, s);
    const V slowest = V::set(in.impact_speed);
    V found = zero;
    for (int i = 0; i < 4; ++i) {
        const V x = V::load(k.x[i] + s), y = V::load(k.y[i] + s);
        const V speed = zero - velocity.at(x, y), separation = change.add_to(V::load(k.separation[i] + s), x, y);
        const V hits = select_greater(speed * h, separation, one, zero);
        found = max_of(found, select_greater(speed, slowest, hits, zero));
    }
    select_greater(V::load(k.restitution + s), zero, found, zero).store(k.impact + s);
}

/// Applies the impulses of the last step.
template <class V, Sides sides> void warm_start_lanes(ContactBlock& k, int s, const PassInput& in, HubVelocities& hub) {
    Velocities<V> u;
    u.gather(in.bodies, k.a + s, k.b + s);
    Inertia<V> inertia;
    inertia.template gather<sides>(in.masses, k, s, u.mass_a, u.mass_b);
    const Frame<V> f = Frame<V>::load(k, s);
    V sum = V::set(0.0f), sx = sum, sy = sum;
    for (int i = 0; i < 4; ++i) {
        const V impulse = V::load(k.impulse[i] + s);
        sum = sum + impulse;
        sx = sx + V::load(k.x[i] + s) * impulse;
        sy = sy + V::load(k.y[i] + s) * impulse;
    }
    const Vec<V> p = f.n * sum + f.t1 * V::load(k.friction_impulse[0] + s) + f.t2 * V::load(k.friction_impulse[1] + s);
    const Vec<V> turn = f.t1 * sy - f.t2 * sx + f.n * V::load(k.twist_impulse + s);
    u.template apply<sides>(p, turn, f, inertia);
    u.template scatter<sides>(in.bodies, k, s, hub);
}

/// The points of each lane's manifold in one pass. An impulse is corrected by -mass (scale v + bias) - decay impulse,
/// where v is the normal velocity.
template <class V> struct Points {
    V impulse[4], x[4], y[4], mass[4], bias[4], scale[4], decay[4];
    V known, hardening;  // see NormalSolver::borne()
    V max_impulse[4];    // of the relax pass

    template <bool biased>
    FASE_INLINE void load(const ContactBlock& k, int s, const PassInput& in, const Affine<V>& separation_change,
                          const Affine<V>& velocity) {
        const V zero = V::set(0.0f), one = V::set(1.0f), rate = V::set(1.0f / in.sub_step);
        const V bias_rate = V::set(in.softness.mass_scale * in.softness.bias_rate);
        const V mass_scale = V::set(in.softness.mass_scale), impulse_scale = V::set(in.softness.impulse_scale);
        const V fastest_out = V::set(-in.push_out_speed);
        const V impact_speed = V::set(in.impact_speed), far_away = V::set(1e9f), no_limit = V::set(3e38f);
        const V restitution = V::load(k.restitution + s);
        known = V::load(k.known_load + s);
        hardening = V::set(1.0f / in.softness.mass_scale);
        for (int i = 0; i < 4; ++i) {
            x[i] = V::load(k.x[i] + s);
            y[i] = V::load(k.y[i] + s);
            mass[i] = V::load(k.point_mass[i] + s);
            impulse[i] = V::load(k.impulse[i] + s);
            const V separation = separation_change.add_to(V::load(k.separation[i] + s), x[i], y[i]);
            if constexpr (biased) {
                const V push_out = max_of(bias_rate * separation, fastest_out);
                bias[i] = select_greater(separation, zero, separation * rate, push_out);
                scale[i] = select_greater(separation, zero, one, mass_scale);
                decay[i] = select_greater(separation, zero, zero, impulse_scale);
            } else {
                // A point that will bounce in the next sub-step keeps its speed until then.
                const V waits = select_greater(zero - velocity.at(x[i], y[i]), impact_speed, far_away, zero);
                bias[i] = max_of(separation, zero) * rate + select_greater(restitution, zero, waits, zero);
                scale[i] = one;
                decay[i] = zero;
                // The pass takes away what the spring added. Only a contact that is known to bear weight, or bounces,
                // may get more: else neighbours that squeeze each other wedge ever tighter, and walls buckle.
                max_impulse[i] = select_greater(known + restitution, zero, no_limit, impulse[i]);
            }
        }
    }
};

/// Solves the normal impulses of the points by Gauss-Seidel. The impulses change the normal velocity only through the
/// 3 x 3 coupling, so the bodies are updated once at the end.
template <class V, bool biased> struct NormalSolver {
    Points<V> points;
    Affine<V> velocity;
    Coupling<V> coupling;
    V sum, sum_x, sum_y;  // added impulse and its first moments in the tangent frame

    /// Returns scale v + bias of point i.
    FASE_INLINE V error(int i) const {
        return points.scale[i] * velocity.at(points.x[i], points.y[i]) + points.bias[i];
    }
    /// Sets the impulse of point i to `target`, clamped to what it may be, and updates the normal velocity.
    FASE_INLINE void set_impulse(int i, V target) {
        const V zero = V::set(0.0f);
        V next = select_greater(points.mass[i], zero, max_of(target, zero), zero);
        if constexpr (!biased) next = min_of(next, points.max_impulse[i]);
        const V d = next - points.impulse[i], dx = points.x[i] * d, dy = points.y[i] * d;
        points.impulse[i] = next;
        sum = sum + d;
        sum_x = sum_x + dx;
        sum_y = sum_y + dy;
        velocity.centre = velocity.centre + (coupling.m00 * d + coupling.m01 * dx + coupling.m02 * dy);
        velocity.slope_x = velocity.slope_x + (coupling.m01 * d + coupling.m11 * dx + coupling.m12 * dy);
        velocity.slope_y = velocity.slope_y + (coupling.m02 * d + coupling.m12 * dx + coupling.m22 * dy);
    }
    /// Returns the impulse that soft point i adds to its own answer: the spring does not decay below the load that the
    /// contact is known to bear, so stacks do not sag by their weight. It is limited by the answer of a hard contact,
    /// so it cannot push by itself.
    FASE_INLINE V borne(int i, V own) const {
        const V zero = V::set(0.0f);
        if constexpr (biased) return points.decay[i] * min_of(points.known, max_of(own, zero) * points.hardening);
        return zero;
    }
    /// First corrects all points by one common velocity, so that an even load stays even; then each point in turn.
    FASE_INLINE void solve() {
        const V zero = V::set(0.0f);
        V mass_sum = zero, residual = zero, scaled = zero, decayed = zero;
        for (int i = 0; i < 4; ++i) {
            const V lack = points.mass[i] * error(i) + points.decay[i] * points.impulse[i];
            mass_sum = mass_sum + points.mass[i];
            residual = residual + (lack - borne(i, points.impulse[i] - lack));
            scaled = scaled + points.mass[i] * points.scale[i];
            decayed = decayed + points.mass[i] * points.decay[i];
        }
        sum = sum_x = sum_y = zero;
        const V stiffness = mass_sum * (scaled * coupling.m00) + decayed;
        const V together = select_greater(stiffness, zero, residual / stiffness, zero);
        for (int i = 0; i < 4; ++i) set_impulse(i, points.impulse[i] - points.mass[i] * together);
        for (int i = 0; i < 4; ++i) {
            const V own = points.impulse[i] - points.mass[i] * error(i) - points.decay[i] * points.impulse[i];
            set_impulse(i, own + borne(i, own));
        }
    }
};

/// The friction limits of each lane, before the coefficient of friction.
template <class V> struct NormalLoad {
    V total;  // sum of the normal impulses
    V twist;  // sum of the normal impulses times their lever arms
};

/// Stores the normal impulses of the points, and returns their load for friction. The relax pass ends the sub-step: it
/// adds them to the totals of the step.
template <class V, bool biased>
FASE_INLINE NormalLoad<V> store_impulses(ContactBlock& k, int s, const Points<V>& points) {
    NormalLoad<V> load{V::set(0.0f), V::set(0.0f)};
    for (int i = 0; i < 4; ++i) {
        points.impulse[i].store(k.impulse[i] + s);
        if constexpr (!biased) (V::load(k.total[i] + s) + points.impulse[i]).store(k.total[i] + s);
        load.total = load.total + points.impulse[i];
        load.twist = load.twist + points.impulse[i] * V::load(k.lever[i] + s);
    }
    return load;
}

/// Each pass applies this share of the friction correction; later passes apply the rest. It keeps neighbouring contacts
/// in a wall from overshooting each other.
constexpr float friction_gain = 0.7f;

/// Solves friction at the centre of the manifold: first the twist about the normal, then both tangents together inside
/// the friction cone.
template <class V, Sides sides>
FASE_INLINE void solve_friction(ContactBlock& k, int s, const Frame<V>& f, const Inertia<V>& inertia,
                                const NormalLoad<V>& load, Velocities<V>& u) {
    const V zero = V::set(0.0f), one = V::set(1.0f), mu = V::load(k.friction + s), gain = V::set(friction_gain);
    const Vec<V> relative = u.relative(f), spin = u.wb - u.wa;
    const V old_twist = V::load(k.twist_impulse + s), limit = mu * load.twist;
    const V twist = min_of(max_of(old_twist - gain * V::load(k.twist_mass + s) * dot(f.n, spin), zero - limit), limit);
    twist.store(k.twist_impulse + s);
    const V d = twist - old_twist;
    const V u1 = dot(relative, f.t1) + V::load(k.twist_coupling[0] + s) * d;
    const V u2 = dot(relative, f.t2) + V::load(k.twist_coupling[1] + s) * d;
    const V f0 = V::load(k.friction_mass[0] + s), f1 = V::load(k.friction_mass[1] + s),
            f2 = V::load(k.friction_mass[2] + s);
    const V old1 = V::load(k.friction_impulse[0] + s), old2 = V::load(k.friction_impulse[1] + s);
    V new1 = old1 - gain * (f0 * u1 + f1 * u2), new2 = old2 - gain * (f1 * u1 + f2 * u2);
    const V max_impulse = mu * load.total, squared = new1 * new1 + new2 * new2;
    const V shrink = select_greater(squared, max_impulse * max_impulse, max_impulse / sqrt_of(squared), one);
    new1 = new1 * shrink;
    new2 = new2 * shrink;
    new1.store(k.friction_impulse[0] + s);
    new2.store(k.friction_impulse[1] + s);
    u.template apply<sides>(f.t1 * (new1 - old1) + f.t2 * (new2 - old2), f.n * d, f, inertia);
}

/// One Gauss-Seidel pass. `biased`: soft, with push-out of overlap; otherwise the relax pass: hard, without push-out.
template <class V, Sides sides, bool biased>
void solve_lanes(ContactBlock& k, int s, const PassInput& in, HubVelocities& hub) {
    Velocities<V> u;
    u.gather(in.bodies, k.a + s, k.b + s);
    Inertia<V> inertia;
    inertia.template gather<sides>(in.masses, k, s, u.mass_a, u.mass_b);
    const Frame<V> f = Frame<V>::load(k, s);

    NormalSolver<V, biased> normal;
    normal.velocity = normal_velocity(f, u);
    // The bodies move between the biased and the relax pass only.
    const Affine<V> change = biased ? load_change<V>(k, s) : update_change(k, s, f, in.bodies);
    normal.points.template load<biased>(k, s, in, change, normal.velocity);
    normal.coupling = Coupling<V>::load(k, s);
    normal.solve();
    const NormalLoad<V> load = store_impulses<V, biased>(k, s, normal.points);
    u.template apply<sides>(f.n * normal.sum, f.t1 * normal.sum_y - f.t2 * normal.sum_x, f, inertia);

    solve_friction<V, sides>(k, s, f, inertia, load, u);
    u.template scatter<sides>(in.bodies, k, s, hub);
}

/// Gives the bodies a of a hub's block the mean of the velocities of their lanes. The block has read them before any
/// lane wrote, so the order of the lanes does not depend on the SIMD width.
inline void merge_hub(const ContactBlock& k, const HubVelocities& hub, SolverBody* bodies) {
    for (int lane = 0; lane < block_lanes; ++lane) {
        bool first = true;
        for (int other = 0; other < lane; ++other) first &= k.a[other] != k.a[lane];
        if (!first) continue;
        float sum[6] = {};
        for (int other = lane; other < block_lanes; ++other)
            if (k.a[other] == k.a[lane])
                for (int i = 0; i < 6; ++i) sum[i] += hub.row[i][other];
        if (!(k.split[lane] > 0)) continue;
        SolverBody& body = bodies[k.a[lane]];
        for (int i = 0; i < 3; ++i) {
            body.velocity[i] = sum[i] / k.split[lane];
            body.spin[i] = sum[3 + i] / k.split[lane];
        }
    }
}

/// Solves blocks i and i + 1 together where V has a type for it, and returns how many it solved.
template <class V, Sides sides>
FASE_INLINE std::size_t solve_pair(Pass pass, ContactBlock* blocks, std::size_t i, std::size_t count,
                                   const PassInput& in, HubVelocities& hub) {
    if constexpr (sides != Sides::Hub && !std::is_void_v<PairOf<V>>) {
        if (i + 1 >= count) return 0;
        if (pass == Pass::Biased) return solve_lanes<PairOf<V>, sides, true>(blocks[i], 0, in, hub), 2;
        if (pass == Pass::Relax) return solve_lanes<PairOf<V>, sides, false>(blocks[i], 0, in, hub), 2;
    }
    return 0;
}

template <class V, Sides sides>
void run_sides(Pass pass, ContactBlock* blocks, std::size_t count, const PassInput& in) {
    HubVelocities hub;
    for (std::size_t i = 0; i < count; ++i) {
        while (const std::size_t solved = solve_pair<V, sides>(pass, blocks, i, count, in, hub)) i += solved;
        if (i == count) break;
        ContactBlock& k = blocks[i];
        for (int s = 0; s < block_lanes; s += V::lanes) switch (pass) {
                case Pass::Prepare: prepare_lanes<V, sides, true>(k, s, in); break;
                case Pass::PrepareAgain: prepare_lanes<V, sides, false>(k, s, in); break;
                case Pass::FindImpacts: find_impact_lanes<V>(k, s, in); break;
                case Pass::WarmStart: warm_start_lanes<V, sides>(k, s, in, hub); break;
                case Pass::Biased: solve_lanes<V, sides, true>(k, s, in, hub); break;
                case Pass::Relax: solve_lanes<V, sides, false>(k, s, in, hub); break;
            }
        const bool moves = pass == Pass::WarmStart || pass == Pass::Biased || pass == Pass::Relax;
        if (sides == Sides::Hub && moves) merge_hub(k, hub, in.bodies);
    }
}
template <class V>
void run_blocks(Pass pass, ContactBlock* blocks, std::size_t count, Sides sides, const PassInput& in) {
    switch (sides) {
        case Sides::Both: run_sides<V, Sides::Both>(pass, blocks, count, in); break;
        case Sides::OnlyB: run_sides<V, Sides::OnlyB>(pass, blocks, count, in); break;
        case Sides::Hub: run_sides<V, Sides::Hub>(pass, blocks, count, in); break;
    }
}
