/// Frustum culling, branch by branch. Included inside the namespace of each SIMD target.
///
/// Planes are tested in float with a margin that covers all rounding errors: a child is definitely outside, definitely
/// inside, or undecided. The exact test decides undecided boxes.

/// Passes ranges of ids to the caller; merges adjacent ranges.
class Runs {
public:
    Runs(const Forest& forest, TakeRange take) : forest_(forest), take_(take) {}
    HWY_INLINE void add(std::uint32_t first, std::uint32_t end, bool inside) {
        if (first == end_ && inside == inside_) {
            end_ = end;
            return;
        }
        flush();
        first_ = first;
        end_ = end;
        inside_ = inside;
    }
    void flush() {
        if (first_ == end_) return;
        std::uint32_t from = first_;
        if (!forest_.free_slots.empty()) {
            const auto& free_slots = forest_.free_slots;
            for (auto slot = std::lower_bound(free_slots.begin(), free_slots.end(), first_);
                 slot != free_slots.end() && *slot < end_; ++slot) {
                emit(from, *slot);
                from = *slot + 1;
            }
        }
        emit(from, end_);
        first_ = end_ = 0;
    }

private:
    const Forest& forest_;
    TakeRange take_;
    std::uint32_t first_ = 0, end_ = 0;
    bool inside_ = false;

    HWY_INLINE void emit(std::uint32_t from, std::uint32_t to) {
        if (from < to) take_({forest_.ids.data() + from, to - from}, inside_);
    }
};

struct CullPlane {
    float normal[3];
    float offset, margin_offset, margin_size;  // margin: margin_offset + margin_size * (magnitude of coordinates)
    std::size_t near_row[3], far_row[3];       // planes of the corners nearest and farthest along the normal
};

struct BranchToCull {
    std::uint32_t node;
    std::uint32_t planes;  // one bit per plane that the node is not definitely inside; bounds_bit for the bounds
};
constexpr std::uint32_t bounds_bit = 64;

/// Test results of eight children, one bit each.
struct PlaneTests {
    std::uint8_t visible = 0xff;   // not definitely outside
    std::uint8_t inside = 0xff;    // definitely inside all planes
    std::uint8_t touching = 0xff;  // definitely not outside any plane
    std::uint8_t cut = 0;          // definitely not inside all planes
    std::uint8_t inside_of[7];     // by plane, and the bounds; set only for tested planes
};
struct TestedBranch {
    BranchToCull branch;
    PlaneTests tests;
};

/// `OneMargin`: coordinates are small enough for one constant margin per plane.
template <bool OneMargin> class Culling {
public:
    Culling(const Forest& forest, const FrustumRegion& region, float largest, TakeRange take)
        : forest_(forest), region_(region), runs_(forest, take), bounds_(finite(region.bounds())) {
        for (const Frustum::Side& side : region.frustum().sides) {
            const bool bounds_nothing = side.normal == Vec3d{} && side.offset >= 0;
            if (!bounds_nothing) planes_[plane_count_++] = plane_of(side, largest);
        }
    }
    void run() {
        const std::uint32_t all = ((1u << plane_count_) - 1) | bounds_bit;
        for (std::size_t i = forest_.roots.size(); i-- > 0;)
            open_.push({{forest_.roots[i], all}, test_planes(forest_.nodes[forest_.roots[i]], all)});
        while (!open_.empty()) {
            const TestedBranch next = open_.pop();
            classify(next.branch, next.tests);
        }
        runs_.flush();
    }

private:
    const Forest& forest_;
    const FrustumRegion& region_;
    Runs runs_;
    Aabb bounds_;
    CullPlane planes_[6];
    std::uint32_t plane_count_ = 0;
    LocalStack<TestedBranch, 256> open_;  // tested with their siblings, after their children are prefetched

    /// Makes a box finite, so that unused children do not overlap it.
    static Aabb finite(const Aabb& box) {
        const float most = std::numeric_limits<float>::max();
        return {max(box.lo, {-most, -most, -most}), min(box.hi, {most, most, most})};
    }
    static CullPlane plane_of(const Frustum::Side& side, float largest) {
        constexpr double relative_margin = 0x1p-20;  // of the sum of magnitudes; the error is at most 5 * 2^-24
        CullPlane plane;
        double steepest = 0;
        for (int axis = 0; axis < 3; ++axis) {
            plane.normal[axis] = static_cast<float>(side.normal[axis]);
            steepest = std::max(steepest, std::abs(side.normal[axis]));
            const bool up = side.normal[axis] > 0;
            plane.near_row[axis] = width * static_cast<std::size_t>(up ? axis : axis + 3);
            plane.far_row[axis] = width * static_cast<std::size_t>(up ? axis + 3 : axis);
        }
        plane.offset = static_cast<float>(side.offset);
        const double sizes = OneMargin ? 3 * steepest * double(largest) : 0.0;
        plane.margin_offset = static_cast<float>(relative_margin * (std::abs(side.offset) + sizes) + 1e-36);
        plane.margin_size = static_cast<float>(relative_margin * steepest);
        return plane;
    }
    /// Dot products of a normal with one corner of each of eight children; `rows` selects the corners.
    static HWY_INLINE V along(const CullPlane& plane, const float* planes, const std::size_t* rows) {
        return load(planes + rows[0]) * splat(plane.normal[0]) + load(planes + rows[1]) * splat(plane.normal[1]) +
               load(planes + rows[2]) * splat(plane.normal[2]);
    }
    static HWY_INLINE V size_of(const float* planes) {
        V sum = hn::Zero(Floats());
        for (std::size_t axis = 0; axis < 3; ++axis) {
            sum = sum + hn::Max(hn::Abs(load(planes + width * axis)), hn::Abs(load(planes + width * (axis + 3))));
        }
        return sum;
    }

    HWY_INLINE PlaneTests test_planes(const Node& node, std::uint32_t to_test) const {
        PlaneTests tests;
        if ((to_test & bounds_bit) != 0) {
            const WideBox box(bounds_);
            tests.visible = static_cast<std::uint8_t>(box.overlaps(node));
            tests.inside_of[6] = static_cast<std::uint8_t>(box.contains(node));
        }
        for (std::uint32_t left = to_test & (bounds_bit - 1); left != 0;) {
            const std::uint32_t p = take_bit(left);
            const CullPlane& plane = planes_[p];
            std::uint32_t out = 0, in = 0, touching = 0, cut = 0;
            for (std::size_t i = 0; i < width; i += lanes) {
                const float* const planes = node.plane[0] + i;
                V margin = splat(plane.margin_offset);
                if constexpr (!OneMargin) margin = margin + splat(plane.margin_size) * size_of(planes);
                const V past = splat(plane.offset) + margin, before = splat(plane.offset) - margin;
                const V min_far = along(plane, planes, plane.near_row), max_far = along(plane, planes, plane.far_row);
                out |= bits_of(hn::Gt(min_far, past)) << i;
                touching |= bits_of(hn::Lt(min_far, before)) << i;
                cut |= bits_of(hn::Gt(max_far, past)) << i;
                in |= bits_of(hn::Lt(max_far, before)) << i;
            }
            tests.visible = static_cast<std::uint8_t>(tests.visible & ~out);
            tests.inside = static_cast<std::uint8_t>(tests.inside & in);
            tests.touching = static_cast<std::uint8_t>(tests.touching & touching);
            tests.cut = static_cast<std::uint8_t>(tests.cut | cut);
            tests.inside_of[p] = static_cast<std::uint8_t>(in);
        }
        for (std::uint32_t open = tests.visible & ~tests.inside & 0xffu; open != 0;) {
            const std::uint32_t link = node.link[take_bit(open)];
            if ((link & leaf_bit) != 0) continue;
            const auto* const bytes = reinterpret_cast<const std::uint8_t*>(&forest_.nodes[link]);
            for (std::size_t line = 0; line < sizeof(Node); line += 64) hwy::Prefetch(bytes + line);
        }
        return tests;
    }

    void classify(BranchToCull branch, const PlaneTests& tests) {
        const Node& node = forest_.nodes[branch.node];
        TestedBranch below[width];
        std::uint32_t below_count = 0;
        for (std::uint32_t visible = tests.visible; visible != 0;) {
            const std::uint32_t child = take_bit(visible), bit = 1u << child, link = node.link[child];
            if (link == no_index) continue;
            const std::uint32_t first = node.first[child];
            if ((link & leaf_bit) != 0) {
                if ((tests.inside & bit) != 0) {
                    runs_.add(first, first + 1, true);
                } else if ((tests.touching & tests.cut & bit) != 0) {
                    runs_.add(first, first + 1, false);
                } else if (const Aabb box = node.box(child); region_.touches(box)) {
                    runs_.add(first, first + 1, region_.contains(box));
                }
                continue;
            }
            std::uint32_t planes = 0;
            for (std::uint32_t left = branch.planes; left != 0;) {
                const std::uint32_t p = take_bit(left);
                planes |= (~static_cast<std::uint32_t>(tests.inside_of[p]) >> child & 1) << p;
            }
            if (planes == 0) {
                runs_.add(first, forest_.end_of(branch.node, child), true);
            } else {
                below[below_count++].branch = {link, planes};
            }
        }
        for (std::uint32_t i = 0; i < below_count; ++i)
            below[i].tests = test_planes(forest_.nodes[below[i].branch.node], below[i].branch.planes);
        open_.reserve_more(width);
        while (below_count != 0) open_.push_if(true, below[--below_count]);
    }
};

void cull_frustum(const Forest& forest, const FrustumRegion& region, TakeRange take) {
    float largest = 0;
    for (const std::uint32_t root : forest.roots) {
        const Aabb all = forest.nodes[root].merged();
        if (is_empty(all)) continue;
        for (int axis = 0; axis < 3; ++axis)
            largest = std::max(largest, std::max(std::abs(all.lo[axis]), std::abs(all.hi[axis])));
    }
    constexpr float small = 20000;  // metres: the margin is then at most 6 cm
    if (largest < small) {
        Culling<true>(forest, region, largest, take).run();
    } else {
        Culling<false>(forest, region, largest, take).run();
    }
}
