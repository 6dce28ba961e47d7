/// Random lives of small sets of boxes, which shrink to the shortest that fails: every structure against loops over the
/// boxes, in all that can be asked.
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

/// One thing that happens. Which boxes it happens to, and how, follows from `share` and `seed`.
struct Command {
    enum Kind { Insert, Leap, Nudge, Erase, Rest, Wake } kind = Insert;
    std::uint32_t share = 1;  // of 16 boxes; of Insert: how many
    std::uint32_t seed = 0;
    bool commits = true;  // afterwards, and everything is asked
};
std::ostream& operator<<(std::ostream& out, const Command& c) {
    constexpr const char* names[]{"insert", "leap", "nudge", "erase", "rest", "wake"};
    return out << names[c.kind] << ' ' << c.share << " seed " << c.seed << (c.commits ? ", commit" : "");
}

struct Life {
    std::vector<std::uint32_t> births;  // the seed of each box that is there from the start
    std::vector<Command> commands;
};
std::ostream& operator<<(std::ostream& out, const Life& life) {
    out << life.births.size() << " boxes of seeds";
    for (const std::uint32_t seed : life.births) out << ' ' << seed;
    for (const Command& c : life.commands) out << "; " << c;
    return out;
}

rc::Gen<Life> any_life() {
    const auto seed = rc::gen::resize(100, rc::gen::inRange<std::uint32_t>(0, 1u << 24));
    const auto kind =
        rc::gen::element(Command::Insert, Command::Leap, Command::Nudge, Command::Erase, Command::Rest, Command::Wake);
    const auto share = rc::gen::resize(100, rc::gen::inRange<std::uint32_t>(1, 17));
    const auto command = rc::gen::construct<Command>(kind, share, rc::gen::noShrink(seed), rc::gen::arbitrary<bool>());
    return rc::gen::construct<Life>(
        rc::gen::resize(60, rc::gen::container<std::vector<std::uint32_t>>(rc::gen::noShrink(seed))),
        rc::gen::resize(8, rc::gen::container<std::vector<Command>>(command)));
}

/// A structure, and beside it the boxes in a row, asked by loops.
class Judged {
public:
    Judged(const std::string& structure, const Scene& scene)
        : tested_(*AnyStructure::named(structure)), scene_(scene) {}

    void live(const Life& life) {
        for (const std::uint32_t seed : life.births) insert(seed);
        tested_.commit();
        ask_everything(1);
        for (const Command& command : life.commands) {
            obey(command);
            if (!command.commits) continue;
            tested_.commit();
            ask_everything(command.seed);
        }
        tested_.commit();
        ask_everything(2);
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
        const Move born{free_.back(), scene_.draw(random)};
        free_.pop_back();
        boxes_[born.proxy] = Stored{born.box, true};
        tested_.insert(std::span(&born, 1));
    }
    void move(Proxy p, const Aabb& box) {
        const Move moved{p, box};
        boxes_[p]->box = box;
        tested_.move(std::span(&moved, 1));
    }
    void obey(const Command& command) {
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

    static bool touch(const Aabb& a, const Aabb& b) {
        for (int axis = 0; axis < 3; ++axis)
            if (!(a.lo[axis] <= b.hi[axis] && b.lo[axis] <= a.hi[axis])) return false;
        return true;
    }
    template <class F> void each(F&& f) const {
        for (Proxy p = 0; p < boxes_.size(); ++p)
            if (boxes_[p]) f(p, *boxes_[p]);
    }
    template <class Counts> std::vector<Proxy> those(Counts&& counts) const {
        std::vector<Proxy> found;
        each([&](Proxy p, const Stored& stored) {
            if (counts(stored.box)) found.push_back(p);
        });
        return found;
    }

    void ask_everything(std::uint64_t seed) {
        RC_ASSERT(tested_.broken_invariant() == "");
        Random random(seed * 3 + 5);
        ask_for_pairs();
        ask_for_overlaps(random);
        ask_on_a_ray(random);
        ask_near_a_point(random);
        ask_for_a_camera(random);
    }

    void ask_for_pairs() {
        std::vector<Pair> all, awake;
        each([&](Proxy p, const Stored& a) {
            each([&](Proxy q, const Stored& b) {
                if (p >= q || !touch(a.box, b.box)) return;
                all.push_back({p, q});
                if (a.awake || b.awake) awake.push_back({p, q});
            });
        });
        RC_ASSERT(all_pairs(tested_) == all);
        RC_ASSERT(sorted_pairs([&](auto& out) { tested_.find_awake_pairs(out); }) == awake);
    }

    template <class R> void ask_for(const R& region) {
        std::vector<Proxy> found;
        query::overlapping(tested_, region, found);
        RC_ASSERT(found == those([&](const Aabb& box) {
                      if constexpr (query::TwoStepRegion<R>) {
                          return region.touches(box) && region.meets(box);
                      } else {
                          return region.touches(box);
                      }
                  }));
    }
    void ask_for_overlaps(Random& random) {
        const Aabb asked = scene_.draw(random);
        std::vector<Proxy> found;
        query::overlapping(tested_, asked, found);
        RC_ASSERT(found == those([&](const Aabb& box) { return touch(box, asked); }));
        const Vec3d a = place(random), b = place(random);
        const float radius = std::ldexp(1.0f, static_cast<int>(random.below(8)) - 4);
        ask_for(query::SphereRegion(a, radius));
        ask_for(query::CapsuleRegion(a, b, radius));
        ask_for(query::PointRegion(a));
    }

    template <class Question, class M> void ask_along(const Question& question, const M& measure, float length) {
        std::vector<Hit> all, found;
        each([&](Proxy p, const Stored& stored) {
            const float at = measure.at(stored.box, length);
            if (at < broad::beyond) all.push_back({at, p});
        });
        std::sort(all.begin(), all.end());
        query::all_hits(tested_, question, found);
        RC_ASSERT(found == all);
        RC_ASSERT(query::any_hit(tested_, question) == !all.empty());
        const auto nearest = query::nearest_hit(tested_, question);
        RC_ASSERT(nearest.value_or(Hit{}) == (all.empty() ? Hit{} : all.front()));
    }
    void ask_on_a_ray(Random& random) {
        Ray ray{place(random), {0, 0, 1}, 4};
        if (random.below(3) != 0) {
            const Vec3d way = place(random) - ray.origin;
            if (length(way) > 0) ray.direction = to_float(way * (1 / length(way)));
            ray.length = random.below(2) == 0 ? Aabb::infinity : static_cast<float>(length(way));
        }
        ask_along(ray, broad::RayMeasure(ray), ray.length);
        const query::SweptBox carried{ray, {-0.5f, -1, 0}, {0.25f, 0, 1}};
        ask_along(carried, broad::RayMeasure(ray, carried.before, carried.after), ray.length);
    }

    void ask_near_a_point(Random& random) {
        const Vec3d point = place(random);
        const float radius = random.below(2) == 0 ? Aabb::infinity : 3;
        const broad::PointMeasure measure(point, radius);
        std::vector<Hit> all, found;
        each([&](Proxy p, const Stored& stored) {
            const float at = measure.at(stored.box, radius);
            if (at < broad::beyond) all.push_back({at, p});
        });
        std::sort(all.begin(), all.end());
        const std::size_t k = random.below(9);
        all.resize(std::min(all.size(), k));
        query::nearest(tested_, point, k, radius, found);
        RC_ASSERT(found == all);
    }

    /// What a camera sees that stands anywhere and looks anywhere.
    Frustum camera(Random& random) {
        const Vec3d eye = place(random);
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
    void ask_for_a_camera(Random& random) {
        const Frustum frustum = camera(random);
        const broad::FrustumRegion region(frustum);
        std::vector<Proxy> inside, partly;
        query::cull(tested_, frustum, inside, &partly);
        std::sort(inside.begin(), inside.end());
        std::sort(partly.begin(), partly.end());
        RC_ASSERT(inside == those([&](const Aabb& box) { return region.touches(box); }));
        RC_ASSERT(partly == those([&](const Aabb& box) { return region.touches(box) && !region.contains(box); }));
    }

    /// A corner of some box as the scene draws them.
    Vec3d place(Random& random) {
        const auto finite = [](float x) { return std::isfinite(x) && std::abs(x) < 1e18f ? x : 3.0f; };
        const Aabb box = scene_.draw(random);
        return {finite(box.lo.x), finite(box.hi.y), finite(box.lo.z)};
    }
};

class EveryLife : public ::testing::TestWithParam<std::tuple<std::string, Scene>> {};

TEST_P(EveryLife, IsToldAsTheBoxesTellIt) {
    const auto& [structure, scene] = GetParam();
    EXPECT_TRUE(rc::check(structure + " on " + scene.name, [&] { Judged(structure, scene).live(*any_life()); }));
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryLife,
                         ::testing::Combine(::testing::ValuesIn(structure_names()), ::testing::ValuesIn(all_scenes())),
                         [](const ::testing::TestParamInfo<EveryLife::ParamType>& life) {
                             return std::get<0>(life.param) + "_on_" + std::get<1>(life.param).name;
                         });

}  // namespace
}  // namespace fase::conformance
