/// THE list of measured broad phases, and the adapter for Fase's structures.
#include <fmt/format.h>

#include "bench/pair_engine.hpp"
#include "fase/broad/registry.hpp"
#include "fase/core/tasks.hpp"

namespace fase::bench {
namespace {

class FasePairs final : public PairEngine {
public:
    FasePairs(const PairScene& scene, const std::string& name)
        : name_(name), finder_(*broad::AnyStructure::named(name)) {
        finder_.build(*tasks_, scene.boxes, scene.motion_states);
    }
    void update(std::span<const Aabb> boxes) override { finder_.update(*tasks_, boxes); }
    void find_pairs(std::vector<Pair>& out) override { finder_.find_pairs(*tasks_, out); }
    [[nodiscard]] std::string settings() const override { return "Fase, " + name_; }
    [[nodiscard]] std::size_t bytes() const override { return finder_.stats().bytes; }

private:
    std::string name_;
    std::unique_ptr<TaskRunner> tasks_ = make_serial_runner();
    pairs::PairFinder finder_;
};

std::unique_ptr<PairEngine> make_fase_pairs(const PairScene& scene, const std::string& name) {
    return std::make_unique<FasePairs>(scene, name);
}

std::vector<PairEngineInfo> all_pair_engines() {
    std::vector<PairEngineInfo> all;
    broad::for_each_structure([&]<broad::Structure S>() {
        all.push_back({std::string(S::info.name), make_fase_pairs, false});
    });
#ifdef FASE_PEER_BULLET_PAIRS
    for (const char* name : {"bullet_dbvt", "bullet_dbvt_deferred", "bullet_axis_sweep"})
        all.push_back({name, make_bullet_pairs, true});
#endif
#ifdef FASE_PEER_ODE_PAIRS
    for (const char* name : {"ode_hash", "ode_quadtree", "ode_sap"}) all.push_back({name, make_ode_pairs, true});
#endif
#ifdef FASE_PEER_FCL_PAIRS
    for (const char* name : {"fcl_dynamic_tree", "fcl_sap"}) all.push_back({name, make_fcl_pairs, true});
#endif
#ifdef FASE_PEER_CGAL_PAIRS
    all.push_back({"cgal_box_intersection", make_cgal_pairs, true});
#endif
#ifdef FASE_PEER_EMBREE_PAIRS
    all.push_back({"embree_collide", make_embree_pairs, true});
#endif
#ifdef FASE_PEER_BOOST_PAIRS
    all.push_back({"boost_rtree", make_boost_pairs, true});
#endif
    return all;
}

}  // namespace

const std::vector<PairEngineInfo>& pair_engines() {
    static const std::vector<PairEngineInfo> all = all_pair_engines();
    return all;
}

}  // namespace fase::bench
