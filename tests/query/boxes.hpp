#pragma once
/// Generators of boxes and rays for rapidcheck, and structures filled with such boxes.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

#include "fase/broad/any_structure.hpp"
#include "fase/broad/registry.hpp"

namespace fase {

inline std::ostream& operator<<(std::ostream& out, const Aabb& b) {
    return out << '[' << b.lo.x << ' ' << b.lo.y << ' ' << b.lo.z << " to " << b.hi.x << ' ' << b.hi.y << ' ' << b.hi.z
               << ']';
}

}  // namespace fase

namespace fase::query::test {

using broad::AnyStructure;
using broad::Move;
using broad::Proxy;

/// A multiple of 0.25 m from -range to range.
inline rc::Gen<float> quarters(int range) {
    return rc::gen::map(rc::gen::resize(100, rc::gen::inRange(-4 * range, 4 * range + 1)),
                        [](int quarter) { return 0.25f * static_cast<float>(quarter); });
}
inline rc::Gen<Vec3> any_point(int range = 6) {
    return rc::gen::construct<Vec3>(quarters(range), quarters(range), quarters(range));
}
/// A box on a grid of 0.25 m, so that faces often touch; some boxes are flat.
inline rc::Gen<Aabb> any_box() {
    return rc::gen::map(rc::gen::pair(any_point(), any_point(1)), [](const std::pair<Vec3, Vec3>& corner_and_size) {
        const Vec3 half = abs(corner_and_size.second);
        return Aabb{corner_and_size.first - half, corner_and_size.first + half};
    });
}
inline rc::Gen<std::vector<Aabb>> any_boxes() {
    return rc::gen::resize(40, rc::gen::container<std::vector<Aabb>>(any_box()));
}

/// Returns a structure with box i as proxy i, after several inserts, moves, an erase and commits.
inline AnyStructure filled(const std::string& name, const std::vector<Aabb>& boxes) {
    AnyStructure structure = *AnyStructure::named(name);
    std::vector<Move> moves;
    for (Proxy p = 0; p < boxes.size(); ++p) moves.push_back({p, boxes[p]});
    std::vector<Move> elsewhere = moves;
    for (Move& m : elsewhere) m.box = {m.box.hi, m.box.hi + Vec3{1, 2, 3}};
    const std::size_t half = moves.size() / 2;
    structure.insert(std::span(elsewhere).first(half));
    structure.commit();
    structure.insert(std::span(elsewhere).subspan(half));
    const Move temporary{static_cast<Proxy>(boxes.size() + 3), {{0, 0, 0}, {1, 1, 1}}};
    structure.insert(std::span(&temporary, 1));
    structure.commit();
    structure.move(moves);
    structure.erase(std::span(&temporary.proxy, 1));
    structure.commit();
    return structure;
}

inline std::vector<std::string> structure_names() {
    std::vector<std::string> names;
    broad::for_each_structure([&]<broad::Structure S>() { names.emplace_back(S::info.name); });
    return names;
}
class EveryStructure : public ::testing::TestWithParam<std::string> {};
inline std::string name_of(const ::testing::TestParamInfo<std::string>& structure) { return structure.param; }

/// Returns the proxies of the boxes for which `matches(box)` holds, ascending.
template <class Matches> std::vector<Proxy> proxies_where(const std::vector<Aabb>& boxes, Matches&& matches) {
    std::vector<Proxy> found;
    for (Proxy p = 0; p < boxes.size(); ++p)
        if (matches(boxes[p])) found.push_back(p);
    return found;
}

/// Metres along a ray to where it enters and leaves a box, in long double; enter > leave when it misses.
struct Passage {
    long double enter = 0, leave = 0;
};
inline Passage passage(const Ray& ray, const Aabb& box) {
    Passage passage{0, ray.length};
    for (int axis = 0; axis < 3; ++axis) {
        const long double o = ray.origin[axis], d = ray.direction[axis];
        if (d == 0) {
            if (o < static_cast<long double>(box.lo[axis]) || o > static_cast<long double>(box.hi[axis])) return {1, 0};
            continue;
        }
        const long double a = (box.lo[axis] - o) / d, b = (box.hi[axis] - o) / d;
        passage.enter = std::max(passage.enter, std::min(a, b));
        passage.leave = std::min(passage.leave, std::max(a, b));
    }
    return passage;
}

/// A ray along an axis, along a diagonal, or in any direction.
inline rc::Gen<Ray> any_ray() {
    const auto length = rc::gen::element(0.0f, 1.5f, 4.0f, 100.0f, Aabb::infinity);
    return rc::gen::map(rc::gen::tuple(any_point(10), any_point(2), length),
                        [](const std::tuple<Vec3, Vec3, float>& origin_direction_length) {
                            const auto& [origin, any_direction, ray_length] = origin_direction_length;
                            Vec3 direction = normalized(any_direction);
                            if (direction == Vec3{}) direction = {0, 1, 0};
                            return Ray{to_double(origin), direction, ray_length};
                        });
}

}  // namespace fase::query::test

namespace fase {

inline std::ostream& operator<<(std::ostream& out, const Ray& r) {
    return out << "from " << r.origin.x << ' ' << r.origin.y << ' ' << r.origin.z << " along " << r.direction.x << ' '
               << r.direction.y << ' ' << r.direction.z << " for " << r.length;
}

}  // namespace fase
