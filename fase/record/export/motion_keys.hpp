#pragma once
/// Reduces a motion to the keys that linear interpolation needs.
#include <cstddef>
#include <vector>

#include "fase/math/pose.hpp"

namespace fase::record {

/// One key of a motion.
template <class Value> struct MotionKey {
    double time = 0;
    Value value;
};

/// Returns how far `value` is from the interpolation between `a` and `b` at `fraction` (0 … 1). Points: in metres,
/// linear interpolation.
[[nodiscard]] double distance_between(Vec3d a, Vec3d b, double fraction, Vec3d value);
/// Rotations: in radians, spherical linear interpolation along the shorter arc (glTF's linear interpolation).
[[nodiscard]] double distance_between(Quatd a, Quatd b, double fraction, Quatd value);

/// Receives samples in order and emits a key when interpolation from the last key to the newest sample would miss a
/// sample between them by more than `tolerance` (metres or radians). Buffers at most `max_pending` samples; a rest of
/// any length counts as one. Source: the sliding window of Keogh, Chu, Hart, Pazzani 2001, An online algorithm for
/// segmenting time series.
template <class Value> class MotionKeys {
public:
    static constexpr std::size_t max_pending = 120;

    explicit MotionKeys(double tolerance) : tolerance_(tolerance) {}
    /// Adds a sample. Times must be strictly ascending.
    void add(double time, Value value);
    /// Returns the keys; the last sample is the last key. Nothing can be added afterwards. A motion that always rests
    /// has one key.
    const std::vector<MotionKey<Value>>& finish();

private:
    [[nodiscard]] bool misses(double time, Value value) const;
    [[nodiscard]] bool rests() const;

    double tolerance_;
    std::vector<MotionKey<Value>> keys_, pending_;
};

extern template class MotionKeys<Vec3d>;
extern template class MotionKeys<Quatd>;

}  // namespace fase::record
