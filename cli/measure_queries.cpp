/// How many questions a second structures answer, and whether they answer right.
#include "cli/measure_queries.hpp"

#include <algorithm>
#include <chrono>

#include "fase/broad/measure.hpp"

namespace fase::cli {
namespace {

using broad::AnyStructure;
using broad::FrustumRegion;
using broad::Proxy;
using broad::RayMeasure;
using Clock = std::chrono::steady_clock;

constexpr std::size_t max_judged = 64;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Keeps the nearest, of equally near ones the least place.
class NearestRay {
public:
    /// The limit from there on.
    float see(Proxy p, float at) {
        if (at < hit_.at || (at == hit_.at && p < hit_.proxy)) hit_ = {at, p};
        return hit_.at;
    }
    [[nodiscard]] JudgedQueries::Ray hit() const { return hit_; }

private:
    JudgedQueries::Ray hit_{broad::beyond, 0xffffffff};
};

JudgedQueries::Ray nearest(const AnyStructure& structure, const Ray& ray) {
    NearestRay nearest;
    structure.nearest_first(RayMeasure(ray), ray.length,
                            [&](Proxy p, const Aabb&, float at) { return nearest.see(p, at); });
    return nearest.hit();
}

JudgedQueries::Frustum seen(const AnyStructure& structure, const Frustum& frustum) {
    JudgedQueries::Frustum seen;
    structure.cull(FrustumRegion(frustum), [&](std::span<const Proxy> proxies, bool whole) {
        std::vector<Proxy>& out = whole ? seen.whole : seen.partly;
        out.insert(out.end(), proxies.begin(), proxies.end());
    });
    for (auto* list : {&seen.whole, &seen.partly}) std::sort(list->begin(), list->end());
    return seen;
}

bool is_right(const AnyStructure& structure, const QuerySet& set, const JudgedQueries& judged) {
    for (std::size_t i = 0; i < judged.rays.size(); ++i)
        if (!(nearest(structure, set.rays[i]) == judged.rays[i])) return false;
    for (std::size_t i = 0; i < judged.boxes.size(); ++i) {
        std::vector<Proxy> found;
        structure.overlapping(set.boxes[i], found);
        std::sort(found.begin(), found.end());
        if (found != judged.boxes[i]) return false;
    }
    for (std::size_t i = 0; i < judged.frusta.size(); ++i)
        if (!(seen(structure, set.frusta[i]) == judged.frusta[i])) return false;
    return true;
}

/// Asks all questions, again and again when that is soon done, until the time is over; the clock is looked at after
/// some of them.
template <class Questions, class Ask>
QueryRate rate_of(const Questions& questions, double max_seconds, const std::function<bool()>& go_on, const Ask& ask) {
    constexpr double between_looks = 0.01, min_seconds = 0.1;
    QueryRate rate;
    if (questions.empty()) return rate;
    std::uint64_t asked = 0, hits = 0, next_look = 1;
    double seconds = 0;
    const auto begin = Clock::now();
    while (seconds < min_seconds) {
        for (const auto& question : questions) {
            hits += ask(question);
            if (++asked < next_look) continue;
            seconds = seconds_since(begin);
            if (seconds > max_seconds || !go_on()) break;
            const double each = seconds / static_cast<double>(asked);
            next_look = asked + 1 + static_cast<std::uint64_t>(between_looks / std::max(each, 1e-8));
        }
        seconds = seconds_since(begin);
        if (rate.asked == 0) {
            rate.asked = asked;
            rate.hits = hits;
        }
        if (asked % questions.size() != 0 || seconds > max_seconds) break;
    }
    rate.per_second = static_cast<double>(asked) / std::max(seconds, 1e-9);
    return rate;
}

}  // namespace

JudgedQueries judge_queries(std::span<const Aabb> boxes, const QuerySet& set) {
    JudgedQueries judged;
    for (std::size_t i = 0; i < std::min(max_judged, set.rays.size()); ++i) {
        const RayMeasure measure(set.rays[i]);
        NearestRay nearest;
        for (Proxy p = 0; p < boxes.size(); ++p)
            if (const float at = measure.at(boxes[p], set.rays[i].length); at < broad::beyond) nearest.see(p, at);
        judged.rays.push_back(nearest.hit());
    }
    for (std::size_t i = 0; i < std::min(max_judged, set.boxes.size()); ++i) {
        judged.boxes.emplace_back();
        for (Proxy p = 0; p < boxes.size(); ++p)
            if (overlaps(boxes[p], set.boxes[i])) judged.boxes.back().push_back(p);
    }
    for (std::size_t i = 0; i < std::min(max_judged, set.frusta.size()); ++i) {
        const FrustumRegion region(set.frusta[i]);
        judged.frusta.emplace_back();
        for (Proxy p = 0; p < boxes.size(); ++p) {
            if (!region.touches(boxes[p])) continue;
            (region.contains(boxes[p]) ? judged.frusta.back().whole : judged.frusta.back().partly).push_back(p);
        }
    }
    return judged;
}

QueryFigures measure_queries(std::span<const Aabb> boxes, const QuerySet& set, const JudgedQueries* judged,
                             const StructureChoice& choice, double max_seconds, const std::function<bool()>& go_on) {
    QueryFigures figures;
    figures.structure = choice.asked;
    figures.chosen = choice.chosen;
    std::vector<broad::Move> moves;
    moves.reserve(boxes.size());
    for (const Aabb& box : boxes) moves.push_back({static_cast<Proxy>(moves.size()), box});
    AnyStructure structure = choice.empty;
    const auto begin = Clock::now();
    structure.build(moves);
    figures.build_ms = seconds_since(begin) * 1000;
    figures.bytes = structure.bytes();
    if (judged != nullptr) figures.right = is_right(structure, set, *judged);

    const double share = max_seconds / 3;
    figures.rays = rate_of(set.rays, share, go_on, [&](const Ray& ray) {
        return nearest(structure, ray).at < broad::beyond ? std::uint64_t{1} : 0;
    });
    std::vector<Proxy> found;
    figures.boxes = rate_of(set.boxes, share, go_on, [&](const Aabb& box) {
        found.clear();
        structure.overlapping(box, found);
        return std::uint64_t{found.size()};
    });
    figures.frusta = rate_of(set.frusta, share, go_on, [&](const Frustum& frustum) {
        found.clear();
        structure.cull(FrustumRegion(frustum), [&](std::span<const Proxy> proxies, bool) {
            found.insert(found.end(), proxies.begin(), proxies.end());
        });
        return std::uint64_t{found.size()};
    });
    figures.complete = figures.rays.asked == set.rays.size() && figures.boxes.asked == set.boxes.size() &&
                       figures.frusta.asked == set.frusta.size();
    return figures;
}

}  // namespace fase::cli
