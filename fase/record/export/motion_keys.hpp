#pragma once
/// Keeps of a motion only the keys that linear interpolation between them cannot do without.
#include <cstddef>
#include <vector>

#include "fase/math/pose.hpp"

namespace fase::record {

/// One key of a motion.
template <class Value> struct MotionKey {
    double time = 0;
    Value value;
};

/// How far `value` is from what lies between `a` and `b` at `share` (0 … 1) of the way: metres for points on the
/// straight line …
[[nodiscard]] double distance_between(Vec3d a, Vec3d b, double share, Vec3d value);
/// … radians for rotations on the shorter great arc, at even speed (glTF's linear interpolation of rotations).
[[nodiscard]] double distance_between(Quatd a, Quatd b, double share, Quatd value);

/// Takes samples one after the other and keeps a key when the line from the last key to the newest sample would miss
/// one between by more than `tolerance` (metres or radians). At most `max_waiting` samples are held back, unless
/// nothing moves. Source: the sliding window of Keogh, Chu, Hart, Pazzani 2001, An online algorithm for segmenting time
/// series.
template <class Value> class MotionKeys {
public:
    static constexpr std::size_t max_waiting = 120;

    explicit MotionKeys(double tolerance) : tolerance_(tolerance) {}
    /// Times must rise.
    void add(double time, Value value) {
        if (keys_.empty()) {
            keys_.push_back({time, value});
            return;
        }
        const bool rests = value == keys_.back().value;
        if (rests && waiting_.size() == 1 && waiting_[0].value == value) {
            waiting_[0].time = time;  // still at rest: its last moment is all that counts
            return;
        }
        if (!waiting_.empty() && (waiting_.size() >= max_waiting || misses(time, value))) {
            keys_.push_back(waiting_.back());
            waiting_.clear();
        }
        waiting_.push_back({time, value});
    }
    /// The keys; the last sample is the last of them. Nothing can be added afterwards. A motion that rests throughout
    /// has one.
    const std::vector<MotionKey<Value>>& finish() {
        if (!waiting_.empty() && !(keys_.size() == 1 && rests())) keys_.push_back(waiting_.back());
        waiting_.clear();
        return keys_;
    }

private:
    [[nodiscard]] bool misses(double time, Value value) const {
        const MotionKey<Value>& from = keys_.back();
        for (const MotionKey<Value>& sample : waiting_) {
            const double share = (sample.time - from.time) / (time - from.time);
            if (distance_between(from.value, value, share, sample.value) > tolerance_) return true;
        }
        return false;
    }
    [[nodiscard]] bool rests() const {
        for (const MotionKey<Value>& sample : waiting_) {
            if (!(sample.value == keys_.back().value)) return false;
        }
        return true;
    }
    double tolerance_;
    std::vector<MotionKey<Value>> keys_, waiting_;
};

}  // namespace fase::record
