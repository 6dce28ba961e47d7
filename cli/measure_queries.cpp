/// Measures how many queries per second structures answer, and checks the answers.
#include "cli/measure_queries.hpp"

#include <algorithm>
#include <chrono>

#include "fase/broad/auto_structure.hpp"
#include "fase/broad/measure.hpp"

namespace fase::cli {
namespace {

using broad::AnyStructure;
using broad::FrustumRegion;
using broad::Proxy;
using broad::RayMeasure;
using Clock = std::chrono::steady_clock;

constexpr std::size_t max_checked = 64;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Keeps the nearest box; among equally near ones the lowest proxy.
class NearestRay {
public:
    /// Adds a candidate; returns the new limit of the search.
    float add(Proxy p, float distance) {
        if (distance < hit_.distance || (distance == hit_.distance && p < hit_.proxy)) hit_ = {distance, p};
        return hit_.distance;
    }
    [[nodiscard]] ReferenceAnswers::Ray hit() const { return hit_; }

private:
    ReferenceAnswers::Ray hit_{broad::infinite_distance, no_index};
};

ReferenceAnswers::Ray nearest(const AnyStructure& structure, const Ray& ray) {
    NearestRay nearest;
    structure.nearest_first(RayMeasure(ray), ray.length,
                            [&](Proxy p, const Aabb&, float distance) { return nearest.add(p, distance); });
    return nearest.hit();
}

ReferenceAnswers::Frustum seen(const AnyStructure& structure, const Frustum& frustum) {
    ReferenceAnswers::Frustum seen;
    structure.cull(FrustumRegion(frustum), [&](std::span<const Proxy> proxies, bool whole) {
        std::vector<Proxy>& out = whole ? seen.whole : seen.partly;
        out.insert(out.end(), proxies.begin(), proxies.end());
    });
    for (auto* list : {&seen.whole, &seen.partly}) std::sort(list->begin(), list->end());
    return seen;
}

bool is_correct(const AnyStructure& structure, const QuerySet& set, const ReferenceAnswers& reference) {
    for (std::size_t i = 0; i < reference.rays.size(); ++i)
        if (!(nearest(structure, set.rays[i]) == reference.rays[i])) return false;
    for (std::size_t i = 0; i < reference.boxes.size(); ++i) {
        std::vector<Proxy> found;
        structure.overlapping(set.boxes[i], found);
        std::sort(found.begin(), found.end());
        if (found != reference.boxes[i]) return false;
    }
    for (std::size_t i = 0; i < reference.frusta.size(); ++i)
        if (!(seen(structure, set.frusta[i]) == reference.frusta[i])) return false;
    return true;
}

/// Runs all queries, repeatedly for at least 0.1 s, until the time limit. Reads the clock about every 10 ms.
template <class Queries, class Run>
QueryRate rate_of(const Queries& queries, double max_seconds, const std::function<bool()>& go_on, const Run& run) {
    constexpr double clock_interval = 0.01, min_seconds = 0.1;
    QueryRate rate;
    if (queries.empty()) return rate;
    std::uint64_t done = 0, hits = 0, next_reading = 1;
    double seconds = 0;
    const auto begin = Clock::now();
    while (seconds < min_seconds) {
        for (const auto& query : queries) {
            hits += run(query);
            if (++done < next_reading) continue;
            seconds = seconds_since(begin);
            if (seconds > max_seconds || !go_on()) break;
            const double each = seconds / static_cast<double>(done);
            next_reading = done + 1 + static_cast<std::uint64_t>(clock_interval / std::max(each, 1e-8));
        }
        seconds = seconds_since(begin);
        if (rate.queries == 0) {
            rate.queries = done;
            rate.hits = hits;
        }
        if (done % queries.size() != 0 || seconds > max_seconds) break;
    }
    rate.per_second = static_cast<double>(done) / std::max(seconds, 1e-9);
    return rate;
}

}  // namespace

ReferenceAnswers reference_answers(std::span<const Aabb> boxes, const QuerySet& set) {
    ReferenceAnswers reference;
    for (std::size_t i = 0; i < std::min(max_checked, set.rays.size()); ++i) {
        const RayMeasure measure(set.rays[i]);
        NearestRay nearest;
        for (Proxy p = 0; p < boxes.size(); ++p)
            if (const float distance = measure.distance(boxes[p], set.rays[i].length);
                distance < broad::infinite_distance)
                nearest.add(p, distance);
        reference.rays.push_back(nearest.hit());
    }
    for (std::size_t i = 0; i < std::min(max_checked, set.boxes.size()); ++i) {
        reference.boxes.emplace_back();
        for (Proxy p = 0; p < boxes.size(); ++p)
            if (overlaps(boxes[p], set.boxes[i])) reference.boxes.back().push_back(p);
    }
    for (std::size_t i = 0; i < std::min(max_checked, set.frusta.size()); ++i) {
        const FrustumRegion region(set.frusta[i]);
        reference.frusta.emplace_back();
        for (Proxy p = 0; p < boxes.size(); ++p) {
            if (!region.touches(boxes[p])) continue;
            (region.contains(boxes[p]) ? reference.frusta.back().whole : reference.frusta.back().partly).push_back(p);
        }
    }
    return reference;
}

QueryFigures measure_queries(std::span<const Aabb> boxes, const QuerySet& set, const ReferenceAnswers* reference,
                             const StructureChoice& choice, double max_seconds, const std::function<bool()>& go_on) {
    QueryFigures figures;
    figures.structure = choice.requested;
    figures.chosen = choice.chosen;
    std::vector<broad::Move> moves;
    moves.reserve(boxes.size());
    for (const Aabb& box : boxes) moves.push_back({static_cast<Proxy>(moves.size()), box});
    AnyStructure structure = choice.empty;
    if (choice.requested == "auto") {
        const broad::BoxStatistics statistics{.boxes = boxes.size(), .use = broad::BoxUse::AnswersQueries};
        structure = *AnyStructure::named(broad::choose_structure(statistics, {}));
        figures.chosen = structure.info().name;
    }
    const auto begin = Clock::now();
    structure.build(moves);
    figures.build_ms = seconds_since(begin) * 1000;
    figures.bytes = structure.bytes();
    if (reference != nullptr) figures.correct = is_correct(structure, set, *reference);

    const double share = max_seconds / 3;
    figures.rays = rate_of(set.rays, share, go_on, [&](const Ray& ray) {
        return nearest(structure, ray).distance < broad::infinite_distance ? std::uint64_t{1} : 0;
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
    figures.complete = figures.rays.queries == set.rays.size() && figures.boxes.queries == set.boxes.size() &&
                       figures.frusta.queries == set.frusta.size();
    return figures;
}

}  // namespace fase::cli
