/// Nearest-first searches for rays and points. Included inside the namespace of each SIMD target.
///
/// Rounding. The exact tests use double; these tests use float and must accept every box that the exact tests accept.
/// The origin of the ray is represented by two floats, below and above it; entry and exit use the one that makes the
/// entry earlier and the exit later. Each entry and exit then has three rounding errors (subtraction, product,
/// reciprocal), relative 3 * 2^-24; signs are exact. One factor on the exits covers all of them, and the raised limit
/// of the exact test.

constexpr float ray_slack = 1 + 0x1p-19f;
constexpr float least = std::numeric_limits<float>::min();  // below it, floats lose relative precision

/// Tests a ray against eight boxes. `Careful`: a component of the direction is 0 or has no finite reciprocal in float,
/// so 0 times infinity may occur; such planes are ignored.
template <bool Careful> class RayTest {
public:
    explicit RayTest(const RayMeasure& measure) : length_(measure.ray().length) {
        const Ray& ray = measure.ray();
        const Vec3 o = to_float(ray.origin), before = measure.before(), after = measure.after();
        // For a swept box, the exact test rounds its sums with the stored box outward to float.
        const bool is_swept = !(before == Vec3{} && after == Vec3{});
        const float relative_error = is_swept ? 0x1p-19f : 0x1p-22f;
        for (int axis = 0; axis < 3; ++axis) {
            const float d = ray.direction[axis] + 0.0f;  // -0 becomes 0
            const float margin = relative_error * (std::abs(o[axis]) + (after[axis] - before[axis])) + least;
            const float ends[2] = {o[axis] + after[axis] + margin, o[axis] + before[axis] - margin};
            // Selects by index, as the direction is unpredictable and a branch would be slow.
            const std::size_t backward = std::bit_cast<std::uint32_t>(d) >> 31;
            in_row_[axis] = width * (static_cast<std::size_t>(axis) + 3 * backward);
            out_row_[axis] = width * (static_cast<std::size_t>(axis) + 3 * (backward ^ 1));
            in_from_[axis] = ends[backward];
            out_from_[axis] = ends[backward ^ 1];
            in_inverse_[axis] = 1.0f / d;
            out_inverse_[axis] = in_inverse_[axis] * ray_slack;
        }
    }
    static bool needs_careful_test(const Ray& ray) {
        for (int axis = 0; axis < 3; ++axis) {
            const float d = std::abs(ray.direction[axis]);
            if (!(d >= 0x1p-100f && d <= 4)) return true;
        }
        return false;
    }
    void set_limit(float limit) {
        const float farthest = limit < length_ ? limit : length_;
        max_entry_ = farthest * ray_slack + 4 * least;
    }
    [[nodiscard]] HWY_INLINE bool within(float at) const { return at <= max_entry_; }
    /// Returns the children that the ray enters before the limit, one bit each, and the entry distances in `at`.
    HWY_INLINE std::uint32_t test(const Node& node, float* at) const {
        const float* const planes = node.plane[0];
        std::uint32_t bits = 0;
        for (std::size_t i = 0; i < width; i += lanes) {
            V near = hn::Zero(Floats()), far = splat(max_entry_);
            clip(planes + i, 0, near, far);
            clip(planes + i, 1, near, far);
            clip(planes + i, 2, near, far);
            hn::Store(near, Floats(), at + i);
            bits |= bits_of(hn::Le(near, far)) << i;
        }
        return bits;
    }

private:
    std::size_t in_row_[3], out_row_[3];  // offsets from the first plane of a node
    float in_from_[3], out_from_[3], in_inverse_[3], out_inverse_[3];
    float length_, max_entry_ = 0;

    HWY_INLINE void clip(const float* planes, int axis, V& near, V& far) const {
        const V in = (load(planes + in_row_[axis]) - splat(in_from_[axis])) * splat(in_inverse_[axis]);
        const V out = (load(planes + out_row_[axis]) - splat(out_from_[axis])) * splat(out_inverse_[axis]);
        if constexpr (Careful) {
            near = hn::IfThenElse(hn::Gt(in, near), in, near);
            far = hn::IfThenElse(hn::Lt(out, far), out, far);
        } else {
            near = hn::Max(near, in);
            far = hn::Min(far, out);
        }
    }
};

/// Tests a point against eight boxes, with squared distances. The squared limit is rounded up by more than their
/// errors.
class PointTest {
public:
    explicit PointTest(const PointMeasure& measure) : radius_(measure.radius()) {
        const Vec3d p = measure.point();
        const Aabb rounded = rounded_outward(p, p);
        for (int axis = 0; axis < 3; ++axis) {
            low_[axis] = rounded.lo[axis];
            high_[axis] = rounded.hi[axis];
        }
    }
    void set_limit(float limit) {
        const double farthest = double(limit < radius_ ? limit : radius_);
        const double square = farthest * farthest * (1 + 0x1p-19) + 4 * double(least);
        max_square_ = square < 3e38 ? static_cast<float>(square) : std::numeric_limits<float>::infinity();
    }
    [[nodiscard]] HWY_INLINE bool within(float at) const { return at <= max_square_; }
    HWY_INLINE std::uint32_t test(const Node& node, float* at) const {
        std::uint32_t bits = 0;
        const V zero = hn::Zero(Floats()), max_square = splat(max_square_);
        for (int i = 0; i < width; i += lanes) {
            V sum = zero;
            for (int axis = 0; axis < 3; ++axis) {
                const V below = load(node.plane[axis] + i) - splat(high_[axis]);
                const V above = splat(low_[axis]) - load(node.plane[axis + 3] + i);
                const V gap = hn::Max(zero, hn::Max(below, above));
                sum = sum + gap * gap;
            }
            hn::Store(sum, Floats(), at + i);
            bits |= bits_of(hn::Le(sum, max_square)) << i;
        }
        return bits;
    }

private:
    float low_[3], high_[3];
    float radius_, max_square_ = 0;
};

struct Branch {
    std::uint32_t link;  // a node, or leaf_bit | Place
    float at;            // entry distance, or squared distance
};

/// Returns the nearest child of the nonempty `bits`; pushes the others, farthest first.
HWY_INLINE Branch take_nearest(LocalStack<Branch, 256>& open, const Node& node, std::uint32_t node_index,
                               std::uint32_t bits, const float* at) {
    const auto branch_to = [&](std::uint32_t child) {
        const std::uint32_t link = node.link[child];
        return Branch{(link & leaf_bit) != 0 ? leaf_bit | place_of(node_index, child) : link, at[child]};
    };
    Branch nearest = branch_to(take_bit(bits));
    if (bits == 0) return nearest;
    Branch next = branch_to(take_bit(bits));
    if (next.at < nearest.at) std::swap(nearest, next);
    open.reserve_more(width);
    const std::size_t base = open.size();
    open.push_if(true, next);
    while (bits != 0) {
        next = branch_to(take_bit(bits));
        if (next.at < nearest.at) std::swap(nearest, next);
        open.push_if(true, next);
        Branch* const data = open.data();
        std::size_t k = open.size() - 1;
        for (; k > base && data[k - 1].at < next.at; --k) data[k] = data[k - 1];
        data[k] = next;
    }
    return nearest;
}

/// Requests the node that a search visits next, after the branch that it is in.
HWY_INLINE void prefetch_node(const Node* nodes, std::uint32_t link) {
    if ((link & leaf_bit) == 0) detail::prefetch(nodes[link]);
}

template <class Test, class Measure>
void search(const Forest& forest, Test test, const Measure& measure, float limit, VisitNear visit) {
    LocalStack<Branch, 256> open;
    for (std::size_t i = forest.roots.size(); i-- > 0;) open.push({forest.roots[i], 0});
    test.set_limit(limit);
    const Node* const nodes = forest.nodes.data();
    alignas(64) float at[width];
    while (!open.empty()) {
        Branch branch = open.pop();
        if (!test.within(branch.at)) continue;
        bool hit = true;
        while (hit && (branch.link & leaf_bit) == 0) {
            const Node& node = nodes[branch.link];
            const std::uint32_t bits = test.test(node, at);
            hit = bits != 0;
            if (hit) {
                branch = take_nearest(open, node, branch.link, bits, at);
                if (!open.empty()) prefetch_node(nodes, open.data()[open.size() - 1].link);
            }
        }
        if (!hit) continue;
        const Place place = branch.link & ~leaf_bit;
        const Node& node = nodes[place / width];
        const std::uint32_t link = node.link[place % width];
        const Aabb box = node.box(place % width);
        const float exact = measure.distance(box, limit);
        if (link == no_index || !(exact < infinite_distance)) continue;
        const float new_limit = visit(link & ~leaf_bit, box, exact);
        if (!(new_limit < limit)) continue;
        limit = new_limit;
        if (limit < 0) return;
        test.set_limit(limit);
    }
}

void nearest_to_ray(const Forest& forest, const RayMeasure& measure, float limit, VisitNear visit) {
    if (RayTest<true>::needs_careful_test(measure.ray())) {
        search(forest, RayTest<true>(measure), measure, limit, visit);
    } else {
        search(forest, RayTest<false>(measure), measure, limit, visit);
    }
}
void nearest_to_point(const Forest& forest, const PointMeasure& measure, float limit, VisitNear visit) {
    search(forest, PointTest(measure), measure, limit, visit);
}
