// Broad phase and narrow phase: boxes give the pairs that may touch, exact shapes the pairs that do. A tree and brute
// force give the same result.
#include <cstdio>

#include "fase/broad/brute_force.hpp"
#include "fase/broad/dynamic_bvh.hpp"
#include "fase/core/random.hpp"
#include "fase/geometry/bounds.hpp"
#include "fase/narrow/dispatch.hpp"
#include "fase/query/index.hpp"

struct Thing {
    fase::Shape shape;
    fase::Pose pose;
};

/// Returns a sphere, capsule or box with a random pose, in a room of 24 m.
Thing random_thing(fase::Random& random, int kind) {
    const auto within = [&](float limit) { return random.between(-limit, limit); };
    const double x = within(12), y = within(12), z = within(12);
    const fase::Quat rotation = fase::normalized(fase::Quat{within(1), within(1), within(1), within(1)});
    if (kind == 0) return {fase::Sphere{.radius = 0.8f}, {{x, y, z}, rotation}};
    if (kind == 1) return {fase::Capsule{.radius = 0.4f, .half_length = 1.2f}, {{x, y, z}, rotation}};
    return {fase::Box{.half = {1.2f, 0.8f, 0.4f}}, {{x, y, z}, rotation}};
}

struct Count {
    int candidates = 0, touching = 0;
};

template <class Structure> Count count_pairs() {
    fase::Index<Thing, Structure> room;
    fase::Random random(3);
    for (int i = 0; i < 300; ++i) {
        const Thing thing = random_thing(random, i % 3);
        room.insert(fase::bounds(thing.shape, thing.pose), thing);  // the broad phase sees only boxes
    }
    room.commit();
    Count count;
    room.pairs([&](const Thing& a, const Thing& b) {
        ++count.candidates;
        const auto contact = fase::narrow::collide(a.shape, b.shape, fase::relative(a.pose, b.pose), 0);
        count.touching += contact.count > 0 ? 1 : 0;
    });
    return count;
}

int main() {
    const Count tree = count_pairs<fase::broad::DynamicBvh>(), brute = count_pairs<fase::broad::BruteForce>();
    std::printf("pairs of 300 things:   %d\n", 300 * 299 / 2);
    std::printf("pairs of boxes:        %d by a tree, %d by brute force\n", tree.candidates, brute.candidates);
    std::printf("pairs of shapes:       %d and %d\n", tree.touching, brute.touching);
    return tree.candidates == brute.candidates && tree.touching == brute.touching ? 0 : 1;
}
