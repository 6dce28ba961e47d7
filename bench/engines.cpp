/// THE list of engines, and the adapter for Fase.
#include <fmt/format.h>

#include "bench/engine.hpp"
#include "fase/world/world.hpp"
#ifdef FASE_PEER_BULLET
#include "bench/peers/bullet.hpp"
#endif

namespace fase::bench {
namespace {

class FaseEngine final : public Engine {
public:
    FaseEngine(World world, int threads) : world_(std::move(world)), threads_(threads) {}

    Result<void> step() override {
        const Result<StepReport> report = world_.step();
        if (!report) return report.error();
        return {};
    }
    [[nodiscard]] std::size_t contacts() const override { return world_.last_report().manifolds; }
    void read_centres(std::vector<Vec3d>& out) const override {
        std::vector<BodyState> bodies;
        world_.read_bodies(bodies);
        for (const BodyState& body : bodies) {
            if (body.kind == BodyKind::Dynamic) out.push_back(body.centre);
        }
    }
    [[nodiscard]] std::optional<std::uint64_t> hash() const override { return world_.hash(); }
    [[nodiscard]] int threads() const override { return threads_; }
    [[nodiscard]] std::string settings() const override {
        const std::string_view structure = world_.last_report().structure;
        return fmt::format("{} sub-steps, {}, float with double positions", world_.settings().sub_steps, structure);
    }

private:
    World world_;
    int threads_;
};

Result<std::unique_ptr<Engine>> make_fase(const scene::Scene& scene, const EngineOptions& options) {
    Result<World> world = World::create(options.settings, {.threads = options.threads});
    if (!world) return world.error();
    if (const auto ids = scene::instantiate(scene, *world); !ids) return ids.error();
    return std::unique_ptr<Engine>(std::make_unique<FaseEngine>(*std::move(world), options.threads));
}

constexpr EngineInfo all_engines[]{
    {"fase", make_fase},
#ifdef FASE_PEER_BULLET
    {"bullet", make_bullet},
    {"bullet_50", make_bullet_50},
#endif
};

}  // namespace

std::span<const EngineInfo> engines() { return all_engines; }

}  // namespace fase::bench
