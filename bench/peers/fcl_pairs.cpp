/// The collision managers of FCL, the Flexible Collision Library, in `fase bench pairs`.
#include <fcl/broadphase/broadphase_SaP.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>

#include "bench/pair_engine.hpp"

namespace fase::bench {
namespace {

/// A shape with the box as bounds.
class Bounds final : public fcl::CollisionGeometryf {
public:
    explicit Bounds(const Aabb& box) : box_(box) { computeLocalAABB(); }
    void computeLocalAABB() override {
        aabb_local =
            fcl::AABBf(fcl::Vector3f(box_.lo.x, box_.lo.y, box_.lo.z), fcl::Vector3f(box_.hi.x, box_.hi.y, box_.hi.z));
    }
    fcl::OBJECT_TYPE getObjectType() const override { return fcl::OT_GEOM; }

private:
    const Aabb& box_;
};

class FclPairs final : public PairEngine {
public:
    FclPairs(const PairScene& scene, const std::string& name)
        : scene_(scene), name_(name), boxes_(scene.boxes.begin(), scene.boxes.end()) {
        if (name == "fcl_sap") {
            manager_ = std::make_unique<fcl::SaPCollisionManagerf>();
        } else {
            manager_ = std::make_unique<fcl::DynamicAABBTreeCollisionManagerf>();
        }
        std::vector<fcl::CollisionObjectf*> all;
        for (std::size_t i = 0; i < boxes_.size(); ++i) {
            shapes_.push_back(std::make_shared<Bounds>(boxes_[i]));
            objects_.push_back(std::make_unique<fcl::CollisionObjectf>(shapes_.back()));
            objects_.back()->setUserData(reinterpret_cast<void*>(i));
            all.push_back(objects_.back().get());
        }
        manager_->registerObjects(all);
        manager_->setup();
    }
    void update(std::span<const Aabb> boxes) override {
        changed_.clear();
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            if (boxes_[i] == boxes[i]) continue;
            boxes_[i] = boxes[i];
            shapes_[i]->computeLocalAABB();
            objects_[i]->computeAABB();
            changed_.push_back(objects_[i].get());
        }
        if (changed_.size() * 4 > boxes.size()) {
            manager_->update();
        } else {
            manager_->update(changed_);
        }
    }
    void find_pairs(std::vector<Pair>& out) override {
        PairSink sink{scene_, out};
        manager_->collide(&sink, append);
    }
    [[nodiscard]] std::string settings() const override {
        return "FCL " FCL_VERSION ", " + std::string(name_ == "fcl_sap" ? "SaP" : "DynamicAABBTree");
    }

private:
    PairScene scene_;
    std::string name_;
    std::vector<Aabb> boxes_;
    std::vector<std::shared_ptr<Bounds>> shapes_;
    std::unique_ptr<fcl::BroadPhaseCollisionManagerf> manager_;
    std::vector<std::unique_ptr<fcl::CollisionObjectf>> objects_;
    std::vector<fcl::CollisionObjectf*> changed_;

    struct PairSink {
        const PairScene& scene;
        std::vector<Pair>& out;
    };
    static bool append(fcl::CollisionObjectf* one, fcl::CollisionObjectf* other, void* data) {
        const auto p = reinterpret_cast<std::size_t>(one->getUserData());
        const auto q = reinterpret_cast<std::size_t>(other->getUserData());
        const PairSink& sink = *static_cast<PairSink*>(data);
        if (!sink.scene.both_static(p, q) && one->getAABB().overlap(other->getAABB()))
            sink.out.push_back(broad::ordered_pair(static_cast<broad::Proxy>(p), static_cast<broad::Proxy>(q)));
        return false;
    }
};

}  // namespace

std::unique_ptr<PairEngine> make_fcl_pairs(const PairScene& scene, const std::string& name) {
    return std::make_unique<FclPairs>(scene, name);
}

}  // namespace fase::bench
