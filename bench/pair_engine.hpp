#pragma once
/// A broad phase that `fase bench pairs` can measure: one of Fase, or one of another library.
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fase/pairs/pair_finder.hpp"

namespace fase::bench {

using broad::Pair;

/// Boxes frame by frame, as many in each, known by their place in the list. What is set up once (memory, the choice of
/// a world's size) is set up when it is made, with the first frame.
class PairEngine {
public:
    PairEngine() = default;
    PairEngine(const PairEngine&) = delete;
    PairEngine& operator=(const PairEngine&) = delete;
    virtual ~PairEngine() = default;
    /// Takes the boxes of the next frame.
    virtual void update(std::span<const Aabb> boxes) = 0;
    /// Appends each current pair once, smaller place first, but for those of two static boxes.
    virtual void find_pairs(std::vector<Pair>& out) = 0;
    /// In words, for the tables.
    [[nodiscard]] virtual std::string settings() const = 0;
    /// 0: cannot say.
    [[nodiscard]] virtual std::size_t bytes() const { return 0; }
};

/// What an engine is made of. All is kept by the caller for as long as the engine lives.
struct PairScene {
    std::span<const Aabb> boxes;  ///< of the first frame; finite, not empty
    std::span<const MotionState> motion_states;
    [[nodiscard]] bool both_static(std::size_t p, std::size_t q) const {
        return motion_states[p] == MotionState::Static && motion_states[q] == MotionState::Static;
    }
};

struct PairEngineInfo {
    std::string name;
    std::unique_ptr<PairEngine> (*make)(const PairScene& scene, const std::string& name);
    bool peer = false;  ///< of another library
};

/// All structures of Fase, then what there is of other libraries.
[[nodiscard]] const std::vector<PairEngineInfo>& pair_engines();

// Peers, one function a way of finding pairs; each is there when its library is.
std::unique_ptr<PairEngine> make_bullet_pairs(const PairScene& scene, const std::string& name);
std::unique_ptr<PairEngine> make_ode_pairs(const PairScene& scene, const std::string& name);
std::unique_ptr<PairEngine> make_fcl_pairs(const PairScene& scene, const std::string& name);
std::unique_ptr<PairEngine> make_cgal_pairs(const PairScene& scene, const std::string& name);
std::unique_ptr<PairEngine> make_embree_pairs(const PairScene& scene, const std::string& name);
std::unique_ptr<PairEngine> make_boost_pairs(const PairScene& scene, const std::string& name);

}  // namespace fase::bench
