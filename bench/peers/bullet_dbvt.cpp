/// Bullet's dynamic tree of boxes (btDbvt) in `fase bench queries`.
#include "bench/peers/bullet_dbvt.hpp"

#include <BulletCollision/BroadphaseCollision/btDbvt.h>
#include <fmt/format.h>

#include <cstdint>

namespace fase::bench {
namespace {

using broad::Proxy;

btVector3 to_bullet(Vec3 v) { return {v.x, v.y, v.z}; }
btVector3 to_bullet(Vec3d v) { return {btScalar(v.x), btScalar(v.y), btScalar(v.z)}; }
btDbvtVolume to_bullet(const Aabb& box) { return btDbvtVolume::FromMM(to_bullet(box.lo), to_bullet(box.hi)); }
Proxy proxy_of(const btDbvtNode* leaf) { return static_cast<Proxy>(reinterpret_cast<std::uintptr_t>(leaf->data)); }

/// Calls `visit(proxy)` for each leaf.
template <class Visit> class LeafVisitor : public btDbvt::ICollide {
public:
    explicit LeafVisitor(Visit visit) : visit_(std::move(visit)) {}
    void Process(const btDbvtNode* leaf) override { visit_(proxy_of(leaf)); }

private:
    Visit visit_;
};

class BulletDbvt final : public QueryContender {
public:
    [[nodiscard]] bool offers(QueryKind, const QueryScene&) const override { return true; }
    void build(const QueryScene& scene) override {
        scene_ = &scene;
        boxes_ = scene.boxes;
        tree_.clear();
        leaves_.clear();
        for (const broad::Move& m : boxes_) {
            void* const data = reinterpret_cast<void*>(static_cast<std::uintptr_t>(m.proxy));
            leaves_.push_back(tree_.insert(to_bullet(m.box), data));
        }
        tree_.optimizeTopDown();
    }
    void move(std::span<const broad::Move> boxes) override {
        for (const broad::Move& m : boxes) {
            boxes_[m.proxy].box = m.box;
            btDbvtVolume volume = to_bullet(m.box);
            tree_.update(leaves_[m.proxy], volume);
        }
        tree_.optimizeIncremental(static_cast<int>(boxes.size() / 100));  // as Bullet's broad phase does in every step
    }
    void rays(std::span<const Ray> rays, std::vector<query::Hit>& out) const override {
        btAlignedObjectArray<const btDbvtNode*> stack;
        for (const Ray& ray : rays) {
            const broad::RayMeasure measure(ray);
            query::Hit best;
            LeafVisitor visitor([&](Proxy p) {
                float distance = measure.distance(boxes_[p].box, best.distance);
                if (!(distance < broad::infinite_distance)) return;
                if (!scene_->mesh.indices.empty())
                    distance = std::max(distance, distance_to_triangle(scene_->mesh, p, ray));
                if (distance < broad::infinite_distance) best = std::min(best, query::Hit{distance, p});
            });
            const btVector3 from = to_bullet(ray.origin), direction = to_bullet(ray.direction);
            btVector3 inverse;
            unsigned signs[3];
            for (int axis = 0; axis < 3; ++axis) {
                inverse[axis] = direction[axis] == 0 ? btScalar(BT_LARGE_FLOAT) : btScalar(1) / direction[axis];
                signs[axis] = inverse[axis] < 0 ? 1 : 0;
            }
            const btScalar reach = ray.length < BT_LARGE_FLOAT ? ray.length : btScalar(BT_LARGE_FLOAT);
            const btVector3 none(0, 0, 0);
            tree_.rayTestInternal(tree_.m_root, from, from + direction, inverse, signs, reach, none, none, stack,
                                  visitor);
            out.push_back(best);
        }
    }
    void boxes(std::span<const Aabb> boxes, AnswerLists& out) const override {
        for (const Aabb& box : boxes) {
            LeafVisitor visitor([&](Proxy p) { out.proxies.push_back(p); });
            tree_.collideTV(tree_.m_root, to_bullet(box), visitor);
            out.ends.push_back(out.proxies.size());
        }
    }
    void frusta(std::span<const Frustum> frusta, AnswerLists& out) const override {
        for (const Frustum& frustum : frusta) {
            const broad::FrustumRegion region(frustum);
            btVector3 normals[6];
            btScalar offsets[6];
            for (int i = 0; i < 6; ++i) {
                const Frustum::Side& side = frustum.sides[static_cast<std::size_t>(i)];
                normals[i] = to_bullet(side.normal * -1);
                offsets[i] = btScalar(side.offset);
            }
            LeafVisitor visitor([&](Proxy p) {
                if (region.touches(boxes_[p].box)) out.proxies.push_back(p);
            });
            btDbvt::collideKDOP(tree_.m_root, normals, offsets, 6, visitor);
            out.ends.push_back(out.proxies.size());
        }
    }
    [[nodiscard]] std::string settings() const override {
        return fmt::format("Bullet {}.{:02} btDbvt", btGetVersion() / 100, btGetVersion() % 100);
    }

private:
    const QueryScene* scene_ = nullptr;
    std::vector<broad::Move> boxes_;
    std::vector<btDbvtNode*> leaves_;
    btDbvt tree_;
};

}  // namespace

std::unique_ptr<QueryContender> make_bullet_dbvt(std::string_view) { return std::make_unique<BulletDbvt>(); }

}  // namespace fase::bench
