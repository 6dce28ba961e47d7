/// THE list of generators, and the way in.
#include <array>

#include "fase/scene/generate/builder.hpp"

namespace fase::scene {
namespace {

constexpr std::size_t max_bodies = 1000000;

constexpr std::array<Generator, 9> all_generators{{
    {"castle",
     "a castle of stone blocks under fire: walls, towers, a gate arch, a keep; heavy balls arrive in a volley", 3000,
     make_castle},
    {"large_pyramid", "one wall of unit boxes, a box less in each row", 5050, make_large_pyramid},
    {"many_pyramids", "walls of 55 unit boxes each, standing in a square", 10780, make_many_pyramids},
    {"hull_pile", "random convex rocks that fall into a pit", 1000, make_hull_pile},
    {"washer", "a block of cubes in a drum that turns at 25 degrees a second", 8000, make_washer},
    {"stack", "boxes in one stack", 20, make_stack},
    {"pile", "all shapes mixed, raining into a walled yard", 2000, make_pile},
    {"sleepers", "small stacks that are asleep, and a few balls that roll among them", 10000, make_sleepers},
    {"domino", "dominoes along a spiral; a ball pushes the first", 1000, make_domino},
}};

}  // namespace

std::span<const Generator> generators() { return all_generators; }

Result<Scene> generate(std::string_view kind, const GenerateOptions& options) {
    std::string known;
    for (const Generator& generator : all_generators) {
        known += (known.empty() ? "" : ", ") + std::string(generator.name);
        if (generator.name != kind) continue;
        if (options.count > max_bodies) {
            return Error{Status::OutOfRange,
                         "count",
                         "found " + std::to_string(options.count) + ", need at most " + std::to_string(max_bodies),
                         {}};
        }
        GenerateOptions filled = options;
        if (filled.count == 0) filled.count = generator.default_count;
        return generator.make(filled);
    }
    return Error{Status::BadArgument, "kind", "found \"" + std::string(kind) + "\", need one of " + known, {}};
}

}  // namespace fase::scene
