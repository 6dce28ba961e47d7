/// Random sequences of operations on small sets of boxes: compares all queries of every structure with loops over the
/// boxes. Rapidcheck shrinks a failing sequence to the shortest one.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <optional>
#include <ostream>
#include <tuple>

#include "fase/query/cast_box.hpp"
#include "fase/query/cast_ray.hpp"
#include "fase/query/cull.hpp"
#include "fase/query/nearest.hpp"
#include "fase/query/overlap.hpp"
#include "tests/conformance/lives.hpp"

namespace fase::conformance {
namespace {

using query::Hit;

/// One operation. `share` and `seed` select the affected boxes and the changes.
struct Command {
    enum Kind { Insert, Leap, Nudge, Erase, Rest, Wake } kind = Insert;
    std::uint32_t share = 1;  // of 16 boxes; for Insert: the count
    std::uint32_t seed = 0;
    bool commits = true;  // commit afterwards and check all queries
};
std::ostream& operator<<(std::ostream& out, const Command& c) {
    constexpr const char* names[]{"insert", "leap", "nudge", "erase", "rest", "wake"};
    return out << names[c.kind] << ' ' << c.share << " seed " << c.seed << (c.commits ? ", commit" : "");
}

struct Sequence {
    std::vector<std::uint32_t> initial_seeds;  // one seed per initial box
    std::vector<Command> commands;
};
std::ostream& operator<<(std::ostream& out, const Sequence& run) {
    out << run.initial_seeds.size() << " boxes of seeds";
    for (const std::uint32_t seed : run.initial_seeds) out << ' ' << seed;
    for (const Command& c : run.commands) out << "; " << c;
    return out;
}

rc::Gen<Sequence> any_sequence() {
    const auto seed = rc::gen::resize(100, rc::gen::inRange<std::uint32_t>(0, 1u << 24));
    const auto kind =
        rc::gen::element(Command::Insert, Command::Leap, Command::Nudge, Command::Erase, Command::Rest, Command::Wake);
    const auto share = rc::gen::resize(100, rc::gen::inRange<std::uint32_t>(1, 17));
    const auto command = rc::gen::construct<Command>(kind, share, rc::gen::noShrink(seed), rc::gen::arbitrary<bool>());
    return rc::gen::construct<Sequence>(
        rc::gen::resize(60, rc::gen::container<std::vector<std::uint32_t>>(rc::gen::noShrink(seed))),
        rc::gen::resize(8, rc::gen::container<std::vector<Command>>(command)));
}

/// A structure under test, with an array of the same boxes as the reference.
class CheckedStructure {
public:
    CheckedStructure(const std::string& structure, const Scene& scene)
        : tested_(*AnyStructure::named(structure)), scene_(scene) {}

    void run_sequence(const Sequence& run) {
        for (const std::uint32_t seed : run.initial_seeds) insert(seed);
        tested_.commit();
        check_everything(1);
        for (const Command& command : run.commands) {
            apply(command);
            if (!command.commits) continue;
            tested_.commit();
            check_everything(command.seed);
        }
        tested_.commit();
        check_everything(2);
    }

private:
    struct Stored {
        Aabb box;
        bool awake = true;
    };
    AnyStructure tested_;
    Scene scene_;
    std::vector<std::optional<Stored>> boxes_;  // by proxy
    std::vector<Proxy> free_;

    void insert(std::uint32_t seed) {
        Random random(seed);
        if (free_.empty()) {
            free_.push_back(static_cast<Proxy>(boxes_.size()));
            boxes_.emplace_back();
        }
        const Move added{free_.back(), scene_.draw(random)};
        free_.pop_back();
        boxes_[added.proxy] = Stored{added.box, true};
        tested_.insert(std::span(&added, 1));
    }
    void move(Proxy p, const Aabb& box) {
        const Move moved{p, box};
        boxes_[p]->box = box;
        tested_.move(std::span(&moved, 1));
    }
    void apply(const Command& command) {
        Random random(command.seed + 77);
        if (command.kind == Command::Insert) {
            for (std::uint32_t i = 0; i < command.share; ++i) insert(command.seed + i);
            return;
        }
        for (Proxy p = 0; p < boxes_.size(); ++p) {
            if (!boxes_[p] || random.below(16) >= command.share) continue;
            const Aabb old = boxes_[p]->box;
            const Vec3 by = point_in(random, -0.2f, 0.2f);
            switch (command.kind) {
                case Command::Leap: move(p, scene_.draw(random)); break;
                case Command::Nudge: move(p, {old.lo + by, old.hi + by}); break;
                case Command::Erase:
                    boxes_[p].reset();
                    free_.push_back(p);
                    tested_.erase(std::span(&p, 1));
                    break;
                default:
                    boxes_[p]->awake = command.kind == Command::Wake;
                    tested_.set_awake(std::span(&p, 1), command.kind == Command::Wake);
            }
        }
    }

    static bool overlapping(const Aabb& a, const Aabb& b) {
        for (int axis = 0; axis < 3; ++axis)
            if (!(a.lo[axis] <= b.hi[axis] && b.lo[axis] <= a.hi[axis])) return false;
        return true;
    }
    template <class F> void for_each(F&& f) const {
        for (Proxy p = 0; p < boxes_.size(); ++p)
            if (boxes_[p]) f(p, *boxes_[p]);
    }
    template <class Condition> std::vector<Proxy> proxies_where(Condition&& condition) const {
        std::vector<Proxy> found;
        for_each([&](Proxy p, const Stored& stored) {
            if (condition(stored.box)) found.push_back(p);
        });
        return found;
    }

    void check_everything(std::uint64_t seed) {
        RC_ASSERT(tested_.broken_invariant() == "");
        Random random(seed * 3 + 5);
        check_pairs();
        check_overlaps(random);
        check_rays(random);
        check_nearest(random);
        check_frustum(random);
    }

    void check_pairs() {
        std::vector<Pair> all, awake;
        for_each([&](Proxy p, const Stored& a) {
            for_each([&](Proxy q, const Stored& b) {
                if (p >= q || !overlapping(a.box, b.box)) return;
                all.push_back({p, q});
                if (a.awake || b.awake) awake.push_back({p, q});
            });
        });
        RC_ASSERT(all_pairs(tested_) == all);
        RC_ASSERT(sorted_pairs([&](auto& out) { tested_.find_awake_pairs(out); }) == awake);
    }

    template <class R> void check_region(const R& region) {
        std::vector<Proxy> found;
        query::overlapping(tested_, region, found);
        RC_ASSERT(found == proxies_where([&](const Aabb& box) {
                      if constexpr (query::TwoStepRegion<R>) {
                          return region.touches(box) && region.touches_exactly(box);
                      } else {
                          return region.touches(box);
                      }
                  }));
    }
    void check_overlaps(Random& random) {
        const Aabb query_box = scene_.draw(random);
        std::vector<Proxy> found;
        query::overlapping(tested_, query_box, found);
        RC_ASSERT(found == proxies_where([&](const Aabb& box) { return overlapping(box, query_box); }));
        const Vec3d a = random_point(random), b = random_point(random);
        const float radius = std::ldexp(1.0f, static_cast<int>(random.below(8)) - 4);
        check_region(query::SphereRegion(a, radius));
        check_region(query::CapsuleRegion(a, b, radius));
        check_region(query::PointRegion(a));
    }

    template <class Query, class M> void check_hits(const Query& request, const M& measure, float length) {
        std::vector<Hit> all, found;
        for_each([&](Proxy p, const Stored& stored) {
            const float at = measure.distance(stored.box, length);
            if (at < broad::infinite_distance) all.push_back({at, p});
        });
        std::sort(all.begin(), all.end());
        query::all_hits(tested_, request, found);
        RC_ASSERT(found == all);
        RC_ASSERT(query::any_hit(tested_, request) == !all.empty());
        const auto nearest = query::nearest_hit(tested_, request);
        RC_ASSERT(nearest.value_or(Hit{}) == (all.empty() ? Hit{} : all.front()));
    }
    void check_rays(Random& random) {
        Ray ray{random_point(random), {0, 0, 1}, 4};
        if (random.below(3) != 0) {
            const Vec3d offset = random_point(random) - ray.origin;
            if (length(offset) > 0) ray.direction = to_float(offset * (1 / length(offset)));
            ray.length = random.below(2) == 0 ? Aabb::infinity : static_cast<float>(length(offset));
        }
        check_hits(ray, broad::RayMeasure(ray), ray.length);
        const query::SweptBox swept{ray, {-0.5f, -1, 0}, {0.25f, 0, 1}};
        check_hits(swept, broad::RayMeasure(ray, swept.lo, swept.hi), ray.length);
    }

    void check_nearest(Random& random) {
        const Vec3d point = random_point(random);
        const float radius = random.below(2) == 0 ? Aabb::infinity : 3;
        const broad::PointMeasure measure(point, radius);
        std::vector<Hit> all, found;
        for_each([&](Proxy p, const Stored& stored) {
            const float at = measure.distance(stored.box, radius);
            if (at < broad::infinite_distance) all.push_back({at, p});
        });
        std::sort(all.begin(), all.end());
        const std::size_t k = random.below(9);
        all.resize(std::min(all.size(), k));
        query::nearest(tested_, point, k, radius, found);
        RC_ASSERT(found == all);
    }

    /// A frustum at a random position with a random direction.
    Frustum random_frustum(Random& random) {
        const Vec3d eye = random_point(random);
        const Vec3d ahead = normalized(Vec3d{random.between(-1, 1), random.between(-1, 1), random.between(0.1f, 1)});
        const Vec3d right = any_perpendicular(ahead), up = cross(right, ahead);
        const double slope = random.between(0.2f, 2), reach = std::ldexp(1.0, static_cast<int>(random.below(10)) - 2);
        Frustum frustum;
        const auto side = [&](std::size_t i, Vec3d normal, Vec3d on) {
            frustum.sides[i] = {normalized(normal), dot(normalized(normal), on)};
        };
        side(0, right * -1 - ahead * slope, eye);
        side(1, right - ahead * slope, eye);
        side(2, up * -1 - ahead * slope, eye);
        side(3, up - ahead * slope, eye);
        side(4, ahead * -1, eye + ahead * (reach * 0.01));
        side(5, ahead, eye + ahead * reach);
        if (random.below(8) == 0) frustum.sides[5] = {Vec3d{}, 1};
        return frustum;
    }
    void check_frustum(Random& random) {
        const Frustum frustum = random_frustum(random);
        const broad::FrustumRegion region(frustum);
        std::vector<Proxy> inside, partly;
        query::cull(tested_, frustum, inside, &partly);
        std::sort(inside.begin(), inside.end());
        std::sort(partly.begin(), partly.end());
        RC_ASSERT(inside == proxies_where([&](const Aabb& box) { return region.touches(box); }));
        RC_ASSERT(partly ==
                  proxies_where([&](const Aabb& box) { return region.touches(box) && !region.contains(box); }));
    }

    /// A corner of a random box of the scene.
    Vec3d random_point(Random& random) {
        const auto finite = [](float x) { return std::isfinite(x) && std::abs(x) < 1e18f ? x : 3.0f; };
        const Aabb box = scene_.draw(random);
        return {finite(box.lo.x), finite(box.hi.y), finite(box.lo.z)};
    }
};

class EverySequence : public ::testing::TestWithParam<std::tuple<std::string, Scene>> {};

TEST_P(EverySequence, GivesTheResultsOfTheReference) {
    const auto& [structure, scene] = GetParam();
    EXPECT_TRUE(rc::check(structure + " on " + scene.name,
                          [&] { CheckedStructure(structure, scene).run_sequence(*any_sequence()); }));
}

INSTANTIATE_TEST_SUITE_P(Registry, EverySequence,
                         ::testing::Combine(::testing::ValuesIn(structure_names()), ::testing::ValuesIn(all_scenes())),
                         [](const ::testing::TestParamInfo<EverySequence::ParamType>& run) {
                             return std::get<0>(run.param) + "_on_" + std::get<1>(run.param).name;
                         });

}  // namespace
}  // namespace fase::conformance
