#pragma once
/// Encodes poses as small integers: positions in quanta, rotations as the three smallest components of the quaternion.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "fase/math/pose.hpp"

namespace fase::record {

/// A rotation in 44 bits: the index of the largest component, and the codes of the others in the order x y z w.
/// Codes are 1 … 16383: up to 8191 steps on either side of 8192.
struct RotationCode {
    std::array<std::uint16_t, 3> small{8192, 8192, 8192};
    std::uint8_t largest = 3;
    friend bool operator==(const RotationCode&, const RotationCode&) = default;
};
/// A pose as stored in the recording. The position is in quanta from the world's origin.
struct PoseCode {
    std::array<std::int64_t, 3> position{};
    RotationCode rotation;
    friend bool operator==(const PoseCode&, const PoseCode&) = default;
};

inline constexpr double rotation_steps = 8191 * 1.4142135623730950488;  ///< code steps for a component value of 1

/// Encodes a rotation with an error of at most 0.02°. `q` must be a unit quaternion within float rounding; q and -q
/// give the same code.
[[nodiscard]] inline RotationCode encode_rotation(Quat q) {
    const std::array<double, 4> parts{q.x, q.y, q.z, q.w};
    std::size_t largest = 3;
    for (std::size_t i = 0; i < 3; ++i) {
        if (std::abs(parts[i]) > std::abs(parts[largest])) largest = i;
    }
    const double sign = parts[largest] < 0 ? -1 : 1;
    RotationCode code;
    code.largest = static_cast<std::uint8_t>(largest);
    for (std::size_t i = 0, k = 0; i < 4; ++i) {
        if (i == largest) continue;
        const double steps = std::round(sign * parts[i] * rotation_steps);
        code.small[k++] = static_cast<std::uint16_t>(8192 + std::clamp(steps, -8191.0, 8191.0));
    }
    return code;
}
/// Returns the unit quaternion of a code; any code is valid.
[[nodiscard]] inline Quat decode_rotation(const RotationCode& code) {
    std::array<double, 4> parts{};
    double squares = 0;
    for (std::size_t i = 0, k = 0; i < 4; ++i) {
        if (i == code.largest) continue;
        parts[i] = (double(code.small[k++]) - 8192) / rotation_steps;
        squares += parts[i] * parts[i];
    }
    parts[code.largest & 3] = squares < 1 ? std::sqrt(1 - squares) : 0;
    const Quatd q = normalized(Quatd{parts[0], parts[1], parts[2], parts[3]});
    return to_float(q);
}
/// Encodes a pose; the position error is at most half a quantum per axis. Positions must be finite and within 2^52
/// quanta.
[[nodiscard]] inline PoseCode encode_pose(const Pose& pose, double quanta_per_metre) {
    const Vec3d p = pose.position * quanta_per_metre;
    return {{std::llround(p.x), std::llround(p.y), std::llround(p.z)}, encode_rotation(pose.rotation)};
}
[[nodiscard]] inline Vec3d decode_position(const std::array<std::int64_t, 3>& quanta, double quanta_per_metre) {
    return {double(quanta[0]) / quanta_per_metre, double(quanta[1]) / quanta_per_metre,
            double(quanta[2]) / quanta_per_metre};
}
[[nodiscard]] inline Pose decode_pose(const PoseCode& code, double quanta_per_metre) {
    return {decode_position(code.position, quanta_per_metre), decode_rotation(code.rotation)};
}

/// Wraps a difference of 14-bit codes into -8192 … 8191.
[[nodiscard]] constexpr int wrap14(int difference) { return ((difference + 8192) & 16383) - 8192; }

}  // namespace fase::record
