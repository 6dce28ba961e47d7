// Ghosts that bounce off each other in a yard: a quadtree that is refilled in each frame, unique pairs, impulses.
#include <cstdio>
#include <vector>

#include "fase/broad/quadtree.hpp"
#include "fase/core/random.hpp"
#include "fase/query/index.hpp"

struct Ghost {
    fase::Vec3 position, velocity;
    int bumps = 0;
};
constexpr float radius = 0.5f, yard = 32, frame_seconds = 1.0f / 60;

fase::Aabb box_of(const Ghost& g) { return fase::enlarged({g.position, g.position}, radius); }

void reflect_at_walls(float position, float& velocity) {
    if ((position < radius && velocity < 0) || (position > yard - radius && velocity > 0)) velocity = -velocity;
}

/// An elastic collision of equal masses: they exchange their velocities along the line between them.
void bounce(Ghost& a, Ghost& b) {
    const fase::Vec3 between = b.position - a.position, normal = fase::normalized(between);
    const float approach = fase::dot(a.velocity - b.velocity, normal);
    if (fase::length_squared(between) > 4 * radius * radius || approach <= 0) return;
    a.velocity -= normal * approach;
    b.velocity += normal * approach;
    ++a.bumps, ++b.bumps;
}

int main() {
    using fase::broad::Quadtree;
    fase::Random random(7);
    std::vector<Ghost> ghosts(120);
    for (Ghost& g : ghosts) {
        g.position = {random.between(1, yard - 1), 0.5f, random.between(1, yard - 1)};
        g.velocity = {random.between(-3, 3), 0, random.between(-3, 3)};
    }
    fase::Index<Ghost*, Quadtree> tree(Quadtree({.capacity = 4, .plane = Quadtree::Plane::xz}));
    for (int frame = 1; frame <= 300; ++frame) {
        tree.clear();
        for (Ghost& g : ghosts) {
            g.position += g.velocity * frame_seconds;
            reflect_at_walls(g.position.x, g.velocity.x);
            reflect_at_walls(g.position.z, g.velocity.z);
            tree.insert(box_of(g), &g);
        }
        tree.commit();
        tree.pairs([](Ghost* a, Ghost* b) { bounce(*a, *b); });
        if (frame % 100 != 0) continue;
        int bumps = 0;
        double energy = 0;
        for (const Ghost& g : ghosts) bumps += g.bumps, energy += 0.5 * fase::length_squared(g.velocity);
        std::printf("%.2f s: %d bumps, energy %.3f J\n", frame * double(frame_seconds), bumps / 2, energy);
    }
}
