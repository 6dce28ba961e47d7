/// What a camera sees, whole branches at a time. Included inside the namespace of each target.
///
/// A plane is tested in float with a margin that covers all roundings: a child is surely outside it, surely inside, or
/// neither. For boxes where that leaves the answer open, the exact test decides.

/// Ranges of ids on their way to the caller, merged where they meet.
class Runs {
public:
    Runs(const Forest& forest, Take take) : forest_(forest), take_(take) {}
    HWY_INLINE void add(std::uint32_t first, std::uint32_t end, bool whole) {
        if (first == end_ && whole == whole_) {
            end_ = end;
            return;
        }
        flush();
        first_ = first;
        end_ = end;
        whole_ = whole;
    }
    void flush() {
        if (first_ == end_) return;
        std::uint32_t from = first_;
        if (!forest_.holes.empty()) {
            const auto& holes = forest_.holes;
            for (auto hole = std::lower_bound(holes.begin(), holes.end(), first_); hole != holes.end() && *hole < end_;
                 ++hole) {
                hand_over(from, *hole);
                from = *hole + 1;
            }
        }
        hand_over(from, end_);
        first_ = end_ = 0;
    }

private:
    const Forest& forest_;
    Take take_;
    std::uint32_t first_ = 0, end_ = 0;
    bool whole_ = false;

    HWY_INLINE void hand_over(std::uint32_t from, std::uint32_t to) {
        if (from < to) take_({forest_.ids.data() + from, to - from}, whole_);
    }
};

struct CullPlane {
    float normal[3];
    float offset, margin_offset, margin_size;  // the margin: margin_offset + margin_size * (size of coordinates)
    int near_row[3], far_row[3];               // the corners least and most far along the normal
};

struct BranchToCull {
    std::uint32_t node;
    std::uint32_t planes;  // a bit for each plane that not all of the node is surely inside of
};

class Culling {
public:
    Culling(const Forest& forest, const FrustumRegion& region, Take take)
        : forest_(forest),
          region_(region),
          runs_(forest, take),
          bounds_(region.bounds()),
          bounds_box_(clamped(bounds_)) {
        for (const Frustum::Side& side : region.frustum().sides) {
            const bool bounds_nothing = side.normal == Vec3d{} && side.offset >= 0;
            if (!bounds_nothing) planes_[plane_count_++] = plane_of(side);
        }
    }
    void run() {
        for (std::size_t i = forest_.roots.size(); i-- > 0;) open_.push({forest_.roots[i], (1u << plane_count_) - 1});
        while (!open_.empty()) visit(open_.pop());
        runs_.flush();
    }

private:
    const Forest& forest_;
    const FrustumRegion& region_;
    Runs runs_;
    Aabb bounds_;
    WideBox bounds_box_;
    CullPlane planes_[6];
    std::uint32_t plane_count_ = 0;
    LocalStack<BranchToCull, 256> open_;

    /// Finite, so that unused children do not overlap it.
    static Aabb clamped(const Aabb& box) {
        const float most = std::numeric_limits<float>::max();
        return {max(box.lo, {-most, -most, -most}), min(box.hi, {most, most, most})};
    }
    static CullPlane plane_of(const Frustum::Side& side) {
        constexpr double share = 0x1p-20;  // of all that is summed; at most 5 * 2^-24 is lost
        CullPlane plane;
        double largest = 0;
        for (int axis = 0; axis < 3; ++axis) {
            plane.normal[axis] = static_cast<float>(side.normal[axis]);
            largest = std::max(largest, std::abs(side.normal[axis]));
            const bool up = side.normal[axis] > 0;
            plane.near_row[axis] = up ? axis : axis + 3;
            plane.far_row[axis] = up ? axis + 3 : axis;
        }
        plane.offset = static_cast<float>(side.offset);
        plane.margin_offset = static_cast<float>(share * std::abs(side.offset) + 1e-36);
        plane.margin_size = static_cast<float>(share * largest);
        return plane;
    }

    void visit(BranchToCull branch) {
        const Node& node = forest_.nodes[branch.node];
        std::uint32_t outside = ~bounds_box_.overlaps(node) & 0xff;
        std::uint32_t inside = 0xff;    // surely inside of all planes
        std::uint32_t touching = 0xff;  // surely not outside of any
        std::uint32_t cut = 0;          // surely not inside of all
        std::uint32_t inside_plane[6] = {};
        alignas(64) float size[width];
        for (int i = 0; i < width; i += lanes) {
            V sum = hn::Zero(Floats());
            for (int axis = 0; axis < 3; ++axis)
                sum = sum + hn::Max(hn::Abs(load(node.plane[axis] + i)), hn::Abs(load(node.plane[axis + 3] + i)));
            hn::Store(sum, Floats(), size + i);
        }
        for (std::uint32_t left = branch.planes; left != 0;) {
            const std::uint32_t p = take_bit(left);
            const CullPlane& plane = planes_[p];
            const V x = splat(plane.normal[0]), y = splat(plane.normal[1]), z = splat(plane.normal[2]);
            std::uint32_t is_out = 0, is_in = 0, is_touching = 0, is_cut = 0;
            for (int i = 0; i < width; i += lanes) {
                const V margin = splat(plane.margin_offset) + splat(plane.margin_size) * load(size + i);
                const V beyond_plane = splat(plane.offset) + margin, before_plane = splat(plane.offset) - margin;
                const V least_far = load(node.plane[plane.near_row[0]] + i) * x +
                                    load(node.plane[plane.near_row[1]] + i) * y +
                                    load(node.plane[plane.near_row[2]] + i) * z;
                const V most_far = load(node.plane[plane.far_row[0]] + i) * x +
                                   load(node.plane[plane.far_row[1]] + i) * y +
                                   load(node.plane[plane.far_row[2]] + i) * z;
                is_out |= bits_of(hn::Gt(least_far, beyond_plane)) << i;
                is_touching |= bits_of(hn::Lt(least_far, before_plane)) << i;
                is_cut |= bits_of(hn::Gt(most_far, beyond_plane)) << i;
                is_in |= bits_of(hn::Lt(most_far, before_plane)) << i;
            }
            outside |= is_out;
            inside &= is_in;
            touching &= is_touching;
            cut |= is_cut;
            inside_plane[p] = is_in;
        }
        sort_out(branch, node, ~outside & 0xff, inside, touching, cut, inside_plane);
    }

    void sort_out(BranchToCull branch, const Node& node, std::uint32_t met, std::uint32_t inside,
                  std::uint32_t touching, std::uint32_t cut, const std::uint32_t* inside_plane) {
        BranchToCull below[width];
        std::uint32_t below_count = 0;
        while (met != 0) {
            const std::uint32_t child = take_bit(met), bit = 1u << child, link = node.link[child];
            if (link == none) continue;
            const std::uint32_t first = node.first[child];
            if ((link & leaf_bit) != 0) {
                if ((inside & bit) != 0) {
                    runs_.add(first, first + 1, true);
                } else if ((touching & cut & bit) != 0) {
                    runs_.add(first, first + 1, false);
                } else if (const Aabb box = node.box(child); region_.touches(box)) {
                    runs_.add(first, first + 1, region_.contains(box));
                }
            } else if ((inside & bit) != 0 && contains(bounds_, node.box(child))) {
                runs_.add(first, forest_.end_of(branch.node, child), true);
            } else {
                std::uint32_t planes = 0;
                for (std::uint32_t p = 0; p < plane_count_; ++p)
                    planes |= (branch.planes >> p & 1) & ~(inside_plane[p] >> child & 1) ? 1u << p : 0;
                below[below_count++] = {link, planes};
            }
        }
        open_.make_room(width);
        while (below_count != 0) open_.push_if(true, below[--below_count]);
    }
};

void cull_frustum(const Forest& forest, const FrustumRegion& region, Take take) { Culling(forest, region, take).run(); }
