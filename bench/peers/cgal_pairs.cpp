/// CGAL's intersection of box sequences in `fase bench pairs`.
#include <CGAL/box_intersection_d.h>
#include <CGAL/version.h>

#include "bench/pair_engine.hpp"

namespace fase::bench {
namespace {

namespace box_d = CGAL::Box_intersection_d;
using CgalBox = box_d::Box_with_handle_d<float, 3, const std::size_t*, box_d::ID_FROM_HANDLE>;

class CgalPairs final : public PairEngine {
public:
    explicit CgalPairs(const PairScene& scene) : scene_(scene) {
        for (std::size_t i = 0; i < scene.boxes.size(); ++i) indices_.push_back(i);
        update(scene.boxes);
    }
    void update(std::span<const Aabb> boxes) override { boxes_.assign(boxes.begin(), boxes.end()); }
    void find_pairs(std::vector<Pair>& out) override {
        moving_.clear();
        static_.clear();
        for (std::size_t i = 0; i < boxes_.size(); ++i) {
            const Aabb& box = boxes_[i];
            float lo[3] = {box.lo.x, box.lo.y, box.lo.z}, hi[3] = {box.hi.x, box.hi.y, box.hi.z};
            (scene_.motion_states[i] == MotionState::Static ? static_ : moving_).emplace_back(lo, hi, &indices_[i]);
        }
        const auto append = [&out](const CgalBox& a, const CgalBox& b) {
            out.push_back(
                broad::ordered_pair(static_cast<broad::Proxy>(*a.handle()), static_cast<broad::Proxy>(*b.handle())));
        };
        // Both calls reorder the boxes; the second does not depend on the order.
        CGAL::box_self_intersection_d(moving_.begin(), moving_.end(), append);
        if (!static_.empty())
            CGAL::box_intersection_d(moving_.begin(), moving_.end(), static_.begin(), static_.end(), append);
    }
    [[nodiscard]] std::string settings() const override { return "CGAL " CGAL_VERSION_STR ", box_self_intersection_d"; }

private:
    PairScene scene_;
    std::vector<std::size_t> indices_;
    std::vector<Aabb> boxes_;
    std::vector<CgalBox> moving_, static_;
};

}  // namespace

std::unique_ptr<PairEngine> make_cgal_pairs(const PairScene& scene, const std::string&) {
    return std::make_unique<CgalPairs>(scene);
}

}  // namespace fase::bench
