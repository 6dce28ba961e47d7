/// Embree's rtcCollide in `fase bench pairs`.
#include <embree3/rtcore.h>

#include "bench/pair_engine.hpp"

namespace fase::bench {
namespace {

/// One user geometry with one primitive per box. Rebuilds the tree in each frame with Embree's fast build for dynamic
/// scenes.
class EmbreePairs final : public PairEngine {
public:
    explicit EmbreePairs(const PairScene& scene) : scene_(scene), boxes_(scene.boxes.begin(), scene.boxes.end()) {
        device_ = rtcNewDevice("threads=1");
        tree_ = rtcNewScene(device_);
        rtcSetSceneFlags(tree_, RTC_SCENE_FLAG_DYNAMIC);
        rtcSetSceneBuildQuality(tree_, RTC_BUILD_QUALITY_LOW);
        geometry_ = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(geometry_, static_cast<unsigned>(boxes_.size()));
        rtcSetGeometryUserData(geometry_, this);
        rtcSetGeometryBoundsFunction(geometry_, bounds_of, nullptr);
        rtcCommitGeometry(geometry_);
        rtcAttachGeometry(tree_, geometry_);
        rtcCommitScene(tree_);
    }
    ~EmbreePairs() override {
        rtcReleaseGeometry(geometry_);
        rtcReleaseScene(tree_);
        rtcReleaseDevice(device_);
    }
    void update(std::span<const Aabb> boxes) override {
        boxes_.assign(boxes.begin(), boxes.end());
        rtcCommitGeometry(geometry_);
        rtcCommitScene(tree_);
    }
    void find_pairs(std::vector<Pair>& out) override {
        out_ = &out;
        rtcCollide(tree_, tree_, append, this);
    }
    [[nodiscard]] std::string settings() const override {
        const auto version = rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_VERSION);
        return "Embree " + std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." +
               std::to_string(version % 100) + ", rtcCollide, low build quality";
    }

private:
    PairScene scene_;
    std::vector<Aabb> boxes_;
    RTCDevice device_ = nullptr;
    RTCScene tree_ = nullptr;
    RTCGeometry geometry_ = nullptr;
    std::vector<Pair>* out_ = nullptr;

    static void bounds_of(const RTCBoundsFunctionArguments* call) {
        const Aabb& box = static_cast<const EmbreePairs*>(call->geometryUserPtr)->boxes_[call->primID];
        call->bounds_o->lower_x = box.lo.x;
        call->bounds_o->lower_y = box.lo.y;
        call->bounds_o->lower_z = box.lo.z;
        call->bounds_o->upper_x = box.hi.x;
        call->bounds_o->upper_y = box.hi.y;
        call->bounds_o->upper_z = box.hi.z;
    }
    /// Embree reports pairs of leaves in both orders: keeps one order, and tests the exact boxes.
    static void append(void* data, RTCCollision* found, unsigned count) {
        EmbreePairs& self = *static_cast<EmbreePairs*>(data);
        for (unsigned k = 0; k < count; ++k) {
            const unsigned p = found[k].primID0, q = found[k].primID1;
            if (p < q && overlaps(self.boxes_[p], self.boxes_[q]) && !self.scene_.both_static(p, q))
                self.out_->push_back({p, q});
        }
    }
};

}  // namespace

std::unique_ptr<PairEngine> make_embree_pairs(const PairScene& scene, const std::string&) {
    return std::make_unique<EmbreePairs>(scene);
}

}  // namespace fase::bench
