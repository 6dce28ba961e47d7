/// Embree in `fase bench queries`: rays against triangles and boxes.
#include "bench/peers/embree.hpp"

#include <embree3/rtcore.h>

#include <algorithm>

namespace fase::bench {
namespace {

using broad::Move;

/// The context that Embree passes to the callbacks.
struct RayContext {
    RTCIntersectContext context;  // must be the first member
    const broad::RayMeasure* measure;
};

void bounds_of_box(const RTCBoundsFunctionArguments* arguments) {
    const Aabb& box = (*static_cast<const std::vector<Move>*>(arguments->geometryUserPtr))[arguments->primID].box;
    *arguments->bounds_o = {box.lo.x, box.lo.y, box.lo.z, 0, box.hi.x, box.hi.y, box.hi.z, 0};
}

void intersect_box(const RTCIntersectFunctionNArguments* arguments) {
    if (arguments->valid[0] == 0) return;
    const Aabb& box = (*static_cast<const std::vector<Move>*>(arguments->geometryUserPtr))[arguments->primID].box;
    auto& found = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
    const auto& context = *reinterpret_cast<const RayContext*>(arguments->context);
    const float distance = context.measure->distance(box, found.ray.tfar);
    const bool nearer =
        distance < found.ray.tfar || (distance == found.ray.tfar && arguments->primID < found.hit.primID);
    if (!(distance < broad::infinite_distance) || !nearer) return;
    found.ray.tfar = distance;
    found.hit.primID = arguments->primID;
    found.hit.geomID = arguments->geomID;
}

class Embree final : public QueryContender {
public:
    Embree() : device_(rtcNewDevice("threads=1,user_threads=1")) {}
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;
    ~Embree() override {
        release();
        rtcReleaseDevice(device_);
    }

    [[nodiscard]] bool offers(QueryKind kind, const QueryScene&) const override { return kind == QueryKind::Rays; }
    void build(const QueryScene& scene) override {
        release();
        boxes_ = scene.boxes;
        of_triangles_ = !scene.mesh.indices.empty();
        scene_ = rtcNewScene(device_);
        if (scene.moves()) rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
        geometry_ = rtcNewGeometry(device_, of_triangles_ ? RTC_GEOMETRY_TYPE_TRIANGLE : RTC_GEOMETRY_TYPE_USER);
        if (of_triangles_) {
            rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
            auto* const corners =
                static_cast<float*>(rtcSetNewGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                            3 * sizeof(float), scene.mesh.positions.size()));
            for (std::size_t i = 0; i < scene.mesh.positions.size(); ++i)
                for (int axis = 0; axis < 3; ++axis)
                    corners[3 * i + static_cast<std::size_t>(axis)] = scene.mesh.positions[i][axis];
            auto* const indices = static_cast<std::uint32_t*>(
                rtcSetNewGeometryBuffer(geometry_, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                        3 * sizeof(std::uint32_t), scene.mesh.indices.size() / 3));
            std::copy(scene.mesh.indices.begin(), scene.mesh.indices.end(), indices);
        } else {
            rtcSetGeometryUserPrimitiveCount(geometry_, static_cast<unsigned>(boxes_.size()));
            rtcSetGeometryUserData(geometry_, &boxes_);
            rtcSetGeometryBoundsFunction(
                geometry_, [](const RTCBoundsFunctionArguments* arguments) { bounds_of_box(arguments); }, nullptr);
            rtcSetGeometryIntersectFunction(geometry_, intersect_box);
            if (scene.moves()) rtcSetGeometryBuildQuality(geometry_, RTC_BUILD_QUALITY_REFIT);
        }
        rtcCommitGeometry(geometry_);
        rtcAttachGeometry(scene_, geometry_);
        rtcCommitScene(scene_);
    }
    void move(std::span<const Move> boxes) override {
        std::copy(boxes.begin(), boxes.end(), boxes_.begin());
        rtcCommitGeometry(geometry_);
        rtcCommitScene(scene_);
    }
    void rays(std::span<const Ray> rays, std::vector<query::Hit>& out) const override {
        for (const Ray& ray : rays) out.push_back(nearest(ray));
    }
    void boxes(std::span<const Aabb>, AnswerLists&) const override {}
    void frusta(std::span<const Frustum>, AnswerLists&) const override {}
    [[nodiscard]] bool rounds_differently(const QueryScene&) const override { return true; }
    [[nodiscard]] std::string settings() const override {
        return std::string("Embree " RTC_VERSION_STRING
                           ", one ray at a time, robust; boxes as user geometry, refitted");
    }

private:
    RTCDevice device_;
    RTCScene scene_ = nullptr;
    RTCGeometry geometry_ = nullptr;
    std::vector<Move> boxes_;
    bool of_triangles_ = false;

    void release() {
        if (scene_ == nullptr) return;
        rtcReleaseGeometry(geometry_);
        rtcReleaseScene(scene_);
        scene_ = nullptr;
    }
    [[nodiscard]] query::Hit nearest(const Ray& ray) const {
        RayContext context;
        rtcInitIntersectContext(&context.context);
        RTCRayHit found{};
        found.ray.org_x = static_cast<float>(ray.origin.x);
        found.ray.org_y = static_cast<float>(ray.origin.y);
        found.ray.org_z = static_cast<float>(ray.origin.z);
        found.ray.dir_x = ray.direction.x;
        found.ray.dir_y = ray.direction.y;
        found.ray.dir_z = ray.direction.z;
        found.ray.tfar = ray.length;
        found.ray.mask = 0xffffffff;
        found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        found.hit.primID = RTC_INVALID_GEOMETRY_ID;
        found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        if (of_triangles_) {
            rtcIntersect1(scene_, &context.context, &found);
        } else {
            const broad::RayMeasure measure(ray);
            context.measure = &measure;
            rtcIntersect1(scene_, &context.context, &found);
        }
        if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
        return {found.ray.tfar, found.hit.primID};
    }
};

}  // namespace

std::unique_ptr<QueryContender> make_embree(std::string_view) { return std::make_unique<Embree>(); }

}  // namespace fase::bench
