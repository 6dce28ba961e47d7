/// Bullet's broad phases in `fase bench pairs`.
#include <BulletCollision/BroadphaseCollision/btAxisSweep3.h>
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/BroadphaseCollision/btDispatcher.h>

#include "bench/pair_engine.hpp"

namespace fase::bench {
namespace {

btVector3 to_bullet(Vec3 v) { return {v.x, v.y, v.z}; }

/// Bullet keeps the pairs of fat AABBs; each is tested again with the exact boxes.
class BulletPairs final : public PairEngine {
public:
    BulletPairs(const PairScene& scene, const std::string& name) : name_(name) {
        Aabb world;
        for (const Aabb& box : scene.boxes) world = merge(world, box);
        if (name == "bullet_axis_sweep") {
            const Vec3 border = extent(world) * 0.25f + Vec3{1, 1, 1};
            broadphase_ =
                std::make_unique<bt32BitAxisSweep3>(to_bullet(world.lo - border), to_bullet(world.hi + border),
                                                    static_cast<unsigned>(scene.boxes.size()) + 2);
        } else {
            auto tree = std::make_unique<btDbvtBroadphase>();
            tree->m_deferedcollide = name == "bullet_dbvt_deferred";
            broadphase_ = std::move(tree);
        }
        boxes_.assign(scene.boxes.begin(), scene.boxes.end());
        for (std::size_t i = 0; i < boxes_.size(); ++i) {
            const bool is_static = scene.motion_states[i] == MotionState::Static;
            constexpr int static_group = 1, moving_group = 2;
            proxies_.push_back(
                broadphase_->createProxy(to_bullet(boxes_[i].lo), to_bullet(boxes_[i].hi), 0,
                                         reinterpret_cast<void*>(i), is_static ? static_group : moving_group,
                                         is_static ? moving_group : moving_group | static_group, nullptr));
        }
        broadphase_->calculateOverlappingPairs(nullptr);
    }
    ~BulletPairs() override {
        for (btBroadphaseProxy* proxy : proxies_) broadphase_->destroyProxy(proxy, nullptr);
    }
    void update(std::span<const Aabb> boxes) override {
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            if (boxes_[i] == boxes[i]) continue;
            boxes_[i] = boxes[i];
            broadphase_->setAabb(proxies_[i], to_bullet(boxes[i].lo), to_bullet(boxes[i].hi), nullptr);
        }
    }
    void find_pairs(std::vector<Pair>& out) override {
        broadphase_->calculateOverlappingPairs(nullptr);
        const btBroadphasePairArray& pairs = broadphase_->getOverlappingPairCache()->getOverlappingPairArray();
        for (int k = 0; k < pairs.size(); ++k) {
            const auto p = reinterpret_cast<std::size_t>(pairs[k].m_pProxy0->m_clientObject);
            const auto q = reinterpret_cast<std::size_t>(pairs[k].m_pProxy1->m_clientObject);
            if (overlaps(boxes_[p], boxes_[q]))
                out.push_back(broad::ordered_pair(static_cast<broad::Proxy>(p), static_cast<broad::Proxy>(q)));
        }
    }
    [[nodiscard]] std::string settings() const override {
        return "Bullet " + std::to_string(btGetVersion() / 100) + "." + std::to_string(btGetVersion() % 100) + ", " +
               (name_ == "bullet_axis_sweep" ? "bt32BitAxisSweep3" : "btDbvtBroadphase");
    }

private:
    std::string name_;
    std::unique_ptr<btBroadphaseInterface> broadphase_;
    std::vector<Aabb> boxes_;
    std::vector<btBroadphaseProxy*> proxies_;
};

}  // namespace

std::unique_ptr<PairEngine> make_bullet_pairs(const PairScene& scene, const std::string& name) {
    return std::make_unique<BulletPairs>(scene, name);
}

}  // namespace fase::bench
