#pragma once
/// One frame of a recording: what is written of a step, and what is read back.
#include <array>
#include <cstdint>
#include <vector>

#include "fase/math/pose.hpp"

namespace fase::record {

/// One body in a frame. `row` is its row in the recording's table of bodies.
struct BodyFrame {
    std::uint32_t row = 0;
    std::uint8_t kind = 2;  ///< 0 static, 1 kinematic, 2 dynamic
    bool awake = false;
    bool broken = false;       ///< taken out of play because its numbers became infinite
    std::uint32_t island = 0;  ///< 0: none; k + 1: the island whose least body slot is k
    Pose pose;
};
/// Two colliders, by their rows.
struct ColliderPair {
    std::uint32_t a = 0, b = 0;
    friend bool operator==(ColliderPair, ColliderPair) = default;
};
struct HitFrame {
    std::uint32_t a = 0, b = 0;  ///< collider rows
    Vec3d point;                 ///< world
    Vec3 normal;                 ///< unit, from a to b
    float speed = 0;             ///< m/s of approach
    float impulse = 0;           ///< N s
};
struct ContactFrame {
    std::uint32_t a = 0, b = 0;  ///< collider rows
    Vec3 normal;                 ///< unit, from a to b
    int count = 0;               ///< 0 to 4
    std::array<Vec3d, 4> points;
    std::array<float, 4> separations{}, impulses{};
};

/// Everything of one step. A frame that was read has positions within half a quantum and rotations within 0.02° of what
/// was written, all else exactly.
struct Frame {
    std::uint64_t number = 0;  ///< 0 is the first of the recording; not looked at when writing
    std::uint64_t step = 0;    ///< of the world
    double time = 0;           ///< seconds simulated
    float total_ms = 0;
    std::vector<float> stage_ms;          ///< as many as the head has stage names
    std::vector<std::uint64_t> counters;  ///< as many as the head has counter names; below 2^53
    std::vector<BodyFrame> bodies;        ///< all that live, by rising row
    std::vector<ColliderPair> contacts_begun, contacts_ended, sensors_begun, sensors_ended;
    std::vector<HitFrame> hits;
    std::vector<ContactFrame> contacts;  ///< only where the head says so
};

}  // namespace fase::record
