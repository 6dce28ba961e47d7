#pragma once
/// One frame of a recording, as written and as read.
#include <array>
#include <cstdint>
#include <vector>

#include "fase/math/pose.hpp"

namespace fase::record {

/// The state of one body. `row` is its row in the recording's table of bodies.
struct BodyFrame {
    std::uint32_t row = 0;
    std::uint8_t kind = 2;  ///< 0 static, 1 kinematic, 2 dynamic
    bool awake = false;
    bool quarantined = false;  ///< removed from the simulation because its state was no longer finite
    std::uint32_t island = 0;  ///< 0: none; k + 1: the island whose lowest body slot is k
    Pose pose;
};
/// Two colliders, as rows.
struct ColliderPair {
    std::uint32_t a = 0, b = 0;
    friend bool operator==(ColliderPair, ColliderPair) = default;
};
/// A hit event.
struct HitFrame {
    std::uint32_t a = 0, b = 0;  ///< collider rows
    Vec3d point;                 ///< world
    Vec3 normal;                 ///< unit, from a to b
    float speed = 0;             ///< m/s, speed of approach
    float impulse = 0;           ///< N s
};
/// A contact manifold.
struct ContactFrame {
    std::uint32_t a = 0, b = 0;          ///< collider rows
    Vec3 normal;                         ///< unit, from a to b
    int count = 0;                       ///< 0 to 4
    std::array<Vec3d, 4> points;         ///< world
    std::array<float, 4> separations{};  ///< metres; below 0: penetration
    std::array<float, 4> impulses{};     ///< N s
};

/// The recorded state and events of one step. A frame that is read has positions within half a quantum and rotations
/// within 0.02° of the written ones; everything else is exact.
struct Frame {
    std::uint64_t number = 0;             ///< 0 is the first of the recording; ignored when writing
    std::uint64_t step = 0;               ///< step count of the world
    double time = 0;                      ///< simulated seconds
    float total_ms = 0;                   ///< wall-clock time of the step
    std::vector<float> stage_ms;          ///< one per stage name of the head
    std::vector<std::uint64_t> counters;  ///< one per counter name of the head; below 2^53
    std::vector<BodyFrame> bodies;        ///< all existing bodies, in ascending order of rows
    std::vector<ColliderPair> contacts_begun, contacts_ended, sensors_begun, sensors_ended;
    std::vector<HitFrame> hits;
    std::vector<ContactFrame> contacts;  ///< only if the head says that frames list them
};

}  // namespace fase::record
