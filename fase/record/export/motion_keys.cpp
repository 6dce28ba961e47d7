/// Chooses the keys of a motion by distances from interpolated values.
#include "fase/record/export/motion_keys.hpp"

#include <cmath>

namespace fase::record {
namespace {

double dot4(Quatd a, Quatd b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
Quatd mix4(Quatd a, double s, Quatd b, double t) {
    return {a.x * s + b.x * t, a.y * s + b.y * t, a.z * s + b.z * t, a.w * s + b.w * t};
}

}  // namespace

double distance_between(Vec3d a, Vec3d b, double fraction, Vec3d value) {
    return length(a + (b - a) * fraction - value);
}

double distance_between(Quatd a, Quatd b, double fraction, Quatd value) {
    double cosine = dot4(a, b);
    if (cosine < 0) {
        b = {-b.x, -b.y, -b.z, -b.w};
        cosine = -cosine;
    }
    Quatd between = mix4(a, 1 - fraction, b, fraction);
    if (cosine < 0.9999) {
        const double angle = std::acos(cosine);
        between = mix4(a, std::sin((1 - fraction) * angle), b, std::sin(fraction * angle));
    }
    const Quatd difference = conjugate(normalized(between)) * value;
    return 2 * std::atan2(length(difference.vector()), std::abs(difference.w));
}

template <class Value> void MotionKeys<Value>::add(double time, Value value) {
    if (keys_.empty()) {
        keys_.push_back({time, value});
        return;
    }
    const bool rests = value == keys_.back().value;
    if (rests && pending_.size() == 1 && pending_[0].value == value) {
        pending_[0].time = time;  // still at rest: only the last such time matters
        return;
    }
    if (!pending_.empty() && (pending_.size() >= max_pending || misses(time, value))) {
        keys_.push_back(pending_.back());
        pending_.clear();
    }
    pending_.push_back({time, value});
}

template <class Value> const std::vector<MotionKey<Value>>& MotionKeys<Value>::finish() {
    if (!pending_.empty() && !(keys_.size() == 1 && rests())) keys_.push_back(pending_.back());
    pending_.clear();
    return keys_;
}

template <class Value> bool MotionKeys<Value>::misses(double time, Value value) const {
    const MotionKey<Value>& from = keys_.back();
    for (const MotionKey<Value>& sample : pending_) {
        const double fraction = (sample.time - from.time) / (time - from.time);
        if (distance_between(from.value, value, fraction, sample.value) > tolerance_) return true;
    }
    return false;
}

template <class Value> bool MotionKeys<Value>::rests() const {
    for (const MotionKey<Value>& sample : pending_) {
        if (!(sample.value == keys_.back().value)) return false;
    }
    return true;
}

template class MotionKeys<Vec3d>;
template class MotionKeys<Quatd>;

}  // namespace fase::record
