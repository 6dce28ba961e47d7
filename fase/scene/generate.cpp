/// The list of generators and their entry point.
#include <array>

#include "fase/scene/generate/builder.hpp"

namespace fase::scene {
namespace {

constexpr std::size_t max_bodies = 1000000;

constexpr std::array<Generator, 12> all_generators{{
    {"castle",
     "a castle of stone blocks under fire: walls, towers, a gate arch, a keep; heavy balls arrive in a volley", 3000,
     make_castle},
    {"large_pyramid", "one wall of unit boxes, each row one box shorter", 5050, make_large_pyramid},
    {"many_pyramids", "a square of walls of 55 unit boxes each", 10780, make_many_pyramids},
    {"hull_pile", "random convex rocks that fall into a pit", 1000, make_hull_pile},
    {"washer", "a block of cubes in a drum that rotates at 25 degrees per second", 8000, make_washer},
    {"stack", "one stack of boxes", 20, make_stack},
    {"pile", "a mix of all shapes that falls into a walled yard", 2000, make_pile},
    {"sleepers", "small sleeping stacks and a few balls that roll into them", 10000, make_sleepers},
    {"hills", "a mix of all shapes that rolls over a triangle mesh of hills in a basin", 500, make_hills},
    {"trees", "trees of 22 hulls each that fall over on a wavy triangle mesh of 60,000 triangles", 50, make_trees},
    {"junkyard", "a heap of rocks in a walled yard; a roller of 4 m radius on a circle of 35 m drives into it", 10584,
     make_junkyard},
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
                         "found " + std::to_string(options.count) + "; expected at most " + std::to_string(max_bodies),
                         {}};
        }
        GenerateOptions filled = options;
        if (filled.count == 0) filled.count = generator.default_count;
        return generator.make(filled);
    }
    return Error{Status::BadArgument, "kind", "found \"" + std::string(kind) + "\"; expected one of " + known, {}};
}

}  // namespace fase::scene
