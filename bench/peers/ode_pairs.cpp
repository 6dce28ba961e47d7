/// The spaces of ODE, the Open Dynamics Engine, in `fase bench pairs`.
#include <ode/ode.h>

#include <algorithm>
#include <cmath>

#include "bench/pair_engine.hpp"

namespace fase::bench {
namespace {

/// The bounds of a custom geometry class: the exact box, without rounding.
void bounds_of(dGeomID geom, dReal out[6]) {
    const Aabb& box = **static_cast<const Aabb**>(dGeomGetClassData(geom));
    const float bounds[6] = {box.lo.x, box.hi.x, box.lo.y, box.hi.y, box.lo.z, box.hi.z};
    std::copy_n(bounds, 6, out);
}
int no_contacts(dGeomID, dGeomID, int, dContactGeom*, int) { return 0; }
dColliderFn* no_collider(int) { return no_contacts; }

int box_class() {
    static const int number = [] {
        dInitODE2(0);
        dGeomClass kind{};
        kind.bytes = sizeof(const Aabb*);
        kind.collider = no_collider;
        kind.aabb = bounds_of;
        return dCreateGeomClass(&kind);
    }();
    return number;
}

class OdePairs final : public PairEngine {
public:
    OdePairs(const PairScene& scene, const std::string& name)
        : kind_(box_class()), name_(name), boxes_(scene.boxes.begin(), scene.boxes.end()) {
        Aabb world;
        float smallest = Aabb::infinity, largest = 0;
        for (const Aabb& box : boxes_) {
            world = merge(world, box);
            const Vec3 sides = extent(box);
            const float side = std::max({sides.x, sides.y, sides.z});
            smallest = std::min(smallest, side);
            largest = std::max(largest, side);
        }
        if (name == "ode_quadtree") {
            const Vec3 middle = centre(world), half = extent(world) * 0.6f;
            const dVector3 position{middle.x, middle.y, middle.z}, extents{half.x, half.y, half.z};
            // About four boxes per cell of the lowest level for uniformly distributed boxes.
            const int depth = std::clamp(static_cast<int>(std::log2(static_cast<double>(boxes_.size())) / 2) - 1, 2, 9);
            space_ = dQuadTreeSpaceCreate(nullptr, position, extents, depth);
        } else if (name == "ode_sap") {
            space_ = dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XZY);
        } else {
            space_ = dHashSpaceCreate(nullptr);
            dHashSpaceSetLevels(space_, static_cast<int>(std::floor(std::log2(std::max(smallest, 1e-6f)))),
                                static_cast<int>(std::ceil(std::log2(std::max(largest, 1e-6f)))));
        }
        dSpaceSetCleanup(space_, 1);
        for (std::size_t i = 0; i < boxes_.size(); ++i) {
            const dGeomID geom = dCreateGeom(kind_);
            *static_cast<const Aabb**>(dGeomGetClassData(geom)) = &boxes_[i];
            dGeomSetData(geom, reinterpret_cast<void*>(i));
            const bool is_static = scene.motion_states[i] == MotionState::Static;
            constexpr unsigned long static_bit = 1, moving_bit = 2;
            dGeomSetCategoryBits(geom, is_static ? static_bit : moving_bit);
            dGeomSetCollideBits(geom, is_static ? moving_bit : moving_bit | static_bit);
            mark_moved(geom, boxes_[i]);
            dSpaceAdd(space_, geom);
            geoms_.push_back(geom);
        }
    }
    ~OdePairs() override { dSpaceDestroy(space_); }
    void update(std::span<const Aabb> boxes) override {
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            if (boxes_[i] == boxes[i]) continue;
            boxes_[i] = boxes[i];
            mark_moved(geoms_[i], boxes[i]);
        }
    }
    void find_pairs(std::vector<Pair>& out) override { dSpaceCollide(space_, &out, append); }
    [[nodiscard]] std::string settings() const override { return "ODE " + name_.substr(4) + " space"; }

private:
    int kind_;
    std::string name_;
    std::vector<Aabb> boxes_;
    dSpaceID space_ = nullptr;
    std::vector<dGeomID> geoms_;

    /// Marks the bounds of a geometry as changed.
    static void mark_moved(dGeomID geom, const Aabb& box) { dGeomSetPosition(geom, box.lo.x, box.lo.y, box.lo.z); }
    static void append(void* data, dGeomID one, dGeomID other) {
        const auto p = reinterpret_cast<std::size_t>(dGeomGetData(one));
        const auto q = reinterpret_cast<std::size_t>(dGeomGetData(other));
        static_cast<std::vector<Pair>*>(data)->push_back(
            broad::ordered_pair(static_cast<broad::Proxy>(p), static_cast<broad::Proxy>(q)));
    }
};

}  // namespace

std::unique_ptr<PairEngine> make_ode_pairs(const PairScene& scene, const std::string& name) {
    return std::make_unique<OdePairs>(scene, name);
}

}  // namespace fase::bench
