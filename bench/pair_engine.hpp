#pragma once
/// The interface of a broad phase that `fase bench pairs` measures, from Fase or another library.
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fase/pairs/pair_finder.hpp"

namespace fase::bench {

using broad::Pair;

/// Finds the pairs of a fixed number of boxes, frame by frame. A box is identified by its index. The constructor does
/// the one-time work (memory, size of the world) with the first frame.
class PairEngine {
public:
    PairEngine() = default;
    PairEngine(const PairEngine&) = delete;
    PairEngine& operator=(const PairEngine&) = delete;
    virtual ~PairEngine() = default;
    /// Updates the boxes to the next frame.
    virtual void update(std::span<const Aabb> boxes) = 0;
    /// Appends each current pair once, smaller index first; skips pairs of two static boxes.
    virtual void find_pairs(std::vector<Pair>& out) = 0;
    /// The settings in a few words, for tables.
    [[nodiscard]] virtual std::string settings() const = 0;
    /// Memory in use; 0: unknown.
    [[nodiscard]] virtual std::size_t bytes() const { return 0; }
};

/// The input of an engine. The data must outlive the engine.
struct PairScene {
    std::span<const Aabb> boxes;  ///< first frame; finite, not empty
    std::span<const MotionState> motion_states;
    [[nodiscard]] bool both_static(std::size_t p, std::size_t q) const {
        return motion_states[p] == MotionState::Static && motion_states[q] == MotionState::Static;
    }
};

struct PairEngineInfo {
    std::string name;
    std::unique_ptr<PairEngine> (*make)(const PairScene& scene, const std::string& name);
    bool peer = false;  ///< from another library
};

/// THE list: all structures of Fase, then the broad phases of the peers found.
[[nodiscard]] const std::vector<PairEngineInfo>& pair_engines();

// Peers, one function per library; each is defined only when its library is found.
std::unique_ptr<PairEngine> make_bullet_pairs(const PairScene& scene, const std::string& name);
std::unique_ptr<PairEngine> make_ode_pairs(const PairScene& scene, const std::string& name);
std::unique_ptr<PairEngine> make_fcl_pairs(const PairScene& scene, const std::string& name);
std::unique_ptr<PairEngine> make_cgal_pairs(const PairScene& scene, const std::string& name);
std::unique_ptr<PairEngine> make_embree_pairs(const PairScene& scene, const std::string& name);
std::unique_ptr<PairEngine> make_boost_pairs(const PairScene& scene, const std::string& name);

}  // namespace fase::bench
