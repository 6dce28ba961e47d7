/// The benchmark behind `fase bench queries`: the check of all answers, then alternating rounds.
#include "bench/queries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <utility>

#include "bench/split_list.hpp"
#include "bench/timing.hpp"
#include "fase/core/hash.hpp"

namespace fase::bench {
namespace {

/// Processor time of this process, all threads together; other programs hardly affect it.
class Stopwatch {
public:
    [[nodiscard]] double seconds() const { return static_cast<double>(std::clock() - begin_) / CLOCKS_PER_SEC; }

private:
    std::clock_t begin_ = std::clock();
};

/// The answers of one contender to the first queries of one kind.
struct Answers {
    std::vector<query::Hit> hits;  // rays
    AnswerLists lists;             // the others
    double seconds = 0;
    [[nodiscard]] std::size_t count(QueryKind kind) const {
        return kind == QueryKind::Rays ? hits.size() : lists.ends.size();
    }
};

std::size_t query_count(const SceneQueries& queries, QueryKind kind) {
    return kind == QueryKind::Rays    ? queries.rays.size()
           : kind == QueryKind::Boxes ? queries.boxes.size()
                                      : queries.frusta.size();
}

void answer(const QueryContender& contender, const SceneQueries& queries, QueryKind kind, std::size_t first,
            std::size_t count, Answers& answers) {
    switch (kind) {
        case QueryKind::Rays: contender.rays(std::span(queries.rays).subspan(first, count), answers.hits); break;
        case QueryKind::Boxes: contender.boxes(std::span(queries.boxes).subspan(first, count), answers.lists); break;
        case QueryKind::Frusta: contender.frusta(std::span(queries.frusta).subspan(first, count), answers.lists); break;
    }
}

/// Executes queries until the time is over, at most `max_queries`. The time includes moving the boxes.
void run(QueryContender& contender, const QueryScene& scene, QueryKind kind, std::size_t max_queries, double seconds,
         Answers& answers) {
    answers.hits.clear();
    answers.lists.clear();
    answers.seconds = 0;
    const std::size_t all = query_count(scene.queries, kind);
    std::vector<broad::Move> moved;
    const std::size_t pieces = scene.moves() ? scene.frames : std::max<std::size_t>(all / 64, 1);
    for (std::size_t piece = 0; piece < pieces && answers.seconds < seconds; ++piece) {
        const std::size_t first = all * piece / pieces, end = all * (piece + 1) / pieces;
        if (end > max_queries) break;
        if (scene.moves()) scene.boxes_at(piece, moved);
        const Stopwatch watch;
        if (scene.moves()) contender.move(moved);
        answer(contender, scene.queries, kind, first, end - first, answers);
        answers.seconds += watch.seconds();
    }
}

/// Returns a hash that does not depend on the order.
std::uint64_t digest(std::span<const broad::Proxy> proxies) {
    std::uint64_t sum = proxies.size();
    for (const broad::Proxy p : proxies) sum += mix_bits(p + 1ull);
    return sum;
}
/// Returns the i-th answer.
std::span<const broad::Proxy> list(const AnswerLists& lists, std::size_t i) {
    const std::size_t begin = i == 0 ? 0 : lists.ends[i - 1];
    return std::span(lists.proxies).subspan(begin, lists.ends[i] - begin);
}

bool same_hit(const query::Hit& a, const query::Hit& b, bool with_tolerance) {
    if (!with_tolerance) return a == b;
    if (!a.is_hit() || !b.is_hit()) return a.is_hit() == b.is_hit();
    return std::abs(a.distance - b.distance) <= 1e-4f * (1 + b.distance);
}

/// Returns the number of answers that differ from the reference.
std::size_t differing(const Answers& answers, const Answers& reference, QueryKind kind, bool with_tolerance) {
    const std::size_t count = std::min(answers.count(kind), reference.count(kind));
    std::size_t differ = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const bool same = kind == QueryKind::Rays ? same_hit(answers.hits[i], reference.hits[i], with_tolerance)
                                                  : digest(list(answers.lists, i)) == digest(list(reference.lists, i));
        differ += same ? 0 : 1;
    }
    return differ;
}

std::size_t hits_in(const Answers& answers, QueryKind kind) {
    if (kind != QueryKind::Rays) return answers.lists.proxies.size();
    return static_cast<std::size_t>(
        std::count_if(answers.hits.begin(), answers.hits.end(), [](const query::Hit& hit) { return hit.is_hit(); }));
}

Error unknown_name(const char* option, const std::string& found, const std::string& names) {
    return {Status::BadArgument, option, fmt::format("found \"{}\"; expected one of {}", found, names), {}};
}

Result<std::vector<const QueryContenderInfo*>> contenders_named(const std::string& names) {
    std::vector<const QueryContenderInfo*> chosen;
    if (names == "all") {
        for (const QueryContenderInfo& info : query_contenders()) chosen.push_back(&info);
        return chosen;
    }
    for (const std::string& name : split_list(names)) {
        const auto all = query_contenders();
        const auto found = std::find_if(all.begin(), all.end(), [&](const auto& info) { return info.name == name; });
        if (found == all.end()) {
            std::string known = "all";
            for (const QueryContenderInfo& info : all) known += ", " + info.name;
            return unknown_name("--contender", name, known);
        }
        chosen.push_back(&*found);
    }
    return chosen;
}

/// Creates a contender by a name that must be in the list.
std::unique_ptr<QueryContender> make_contender(std::string_view name) {
    for (const QueryContenderInfo& info : query_contenders())
        if (info.name == name) return info.make(info.name);
    return nullptr;
}

/// One contender on one scene.
struct Entry {
    const QueryContenderInfo* info = nullptr;
    std::unique_ptr<QueryContender> contender;
    double build_ms = 0;
    std::vector<QueryKind> kinds;
    std::vector<QueryRow> rows;              ///< by kind
    std::vector<std::vector<double>> rates;  ///< by kind and round
};

/// Returns the reference answers: those of the wide BVH, after some of them passed a comparison with brute force.
Result<std::vector<Answers>> reference_answers(const QueryScene& scene) {
    const auto tree = make_contender("wide_bvh"), brute_force = make_contender("brute_force");
    std::vector<Answers> reference(std::size(all_query_kinds));
    constexpr double no_limit = 1e9;
    for (std::size_t k = 0; k < reference.size(); ++k) {
        const QueryKind kind = all_query_kinds[k];
        const std::size_t all = query_count(scene.queries, kind);
        tree->build(scene);
        run(*tree, scene, kind, all, no_limit, reference[k]);
        brute_force->build(scene);
        const std::size_t pieces = scene.moves() ? scene.frames : std::max<std::size_t>(all / 64, 1);
        Answers exact;
        run(*brute_force, scene, kind, std::max(all / pieces, std::min<std::size_t>(all, 100)), no_limit, exact);
        if (const std::size_t differ = differing(exact, reference[k], kind, false); differ != 0) {
            return Error{Status::BadArgument, "wide_bvh",
                         fmt::format("found {} answers to {} that differ from brute force", differ, name_of(kind)),
                         "internal error; please report it"};
        }
    }
    return reference;
}

}  // namespace

Result<std::vector<QueryScene>> query_scenes(const QueryOptions& options) {
    if (!options.scene.empty() && options.scene != "level" && options.scene != "static" && options.scene != "pile")
        return unknown_name("--scene", options.scene, "level, static, pile");
    const auto selected = [&](std::string_view name) { return options.scene.empty() || options.scene == name; };
    std::vector<QueryScene> scenes;
    if (selected("level")) {
        for (const std::string& mesh : options.meshes) {
            Result<QueryScene> level = level_from(mesh, options.counts);
            if (!level) return level.error();
            scenes.push_back(*std::move(level));
        }
        if (options.meshes.empty()) scenes.push_back(generated_level(options.counts));
    }
    if (selected("static")) scenes.push_back(static_boxes(options.counts));
    if (selected("pile")) scenes.push_back(stirred_pile(options.counts));
    return scenes;
}

Result<std::vector<QueryRow>> measure_queries(const QueryScene& scene, const QueryOptions& options,
                                              const QueryProgress& progress) {
    const Result<std::vector<const QueryContenderInfo*>> named = contenders_named(options.contender);
    if (!named) return named.error();
    std::vector<QueryRow> rows;
    const auto rounds = static_cast<std::size_t>(options.rounds);
    const std::uint64_t total = named->size() * (2 + rounds) + 1;
    std::uint64_t done = 0;
    if (!progress(done++, total, scene.name, "brute_force")) return rows;
    const Result<std::vector<Answers>> reference = reference_answers(scene);
    if (!reference) return reference.error();

    std::vector<Entry> entries;
    for (const QueryContenderInfo* info : *named) {
        if (!progress(done++, total, scene.name, info->name)) return rows;
        Entry& entry = entries.emplace_back();
        entry.info = info;
        entry.contender = info->make(info->name);
        for (const QueryKind kind : all_query_kinds)
            if (entry.contender->offers(kind, scene)) entry.kinds.push_back(kind);
        if (entry.kinds.empty()) continue;
        const Stopwatch watch;
        entry.contender->build(scene);
        entry.build_ms = 1000 * watch.seconds();
    }
    Answers answers;
    for (std::size_t round = 0; round <= rounds; ++round) {  // round 0 is the check
        for (Entry& entry : entries) {
            if (!progress(done++, total, scene.name, entry.info->name)) return rows;
            entry.rates.resize(entry.kinds.size());
            for (std::size_t k = 0; k < entry.kinds.size(); ++k) {
                const QueryKind kind = entry.kinds[k];
                if (scene.moves()) entry.contender->build(scene);
                run(*entry.contender, scene, kind, query_count(scene.queries, kind), options.seconds, answers);
                if (round > 0) {
                    entry.rates[k].push_back(static_cast<double>(answers.count(kind)) /
                                             std::max(answers.seconds, 1e-6));
                    continue;
                }
                QueryRow& row = entry.rows.emplace_back();
                row.scene = scene.name;
                row.contender = entry.info->name;
                row.settings = entry.contender->settings();
                row.kind = name_of(kind);
                row.items = scene.boxes.size();
                row.rounds = options.rounds;
                row.queries = row.compared = answers.count(kind);
                row.hits = hits_in(answers, kind);
                row.build_ms = entry.build_ms;
                row.bytes = entry.contender->bytes();
                row.differ = differing(answers, (*reference)[static_cast<std::size_t>(kind)], kind,
                                       entry.contender->rounds_differently(scene));
            }
        }
    }
    for (const QueryKind kind : all_query_kinds) {
        for (Entry& entry : entries) {
            for (std::size_t k = 0; k < entry.kinds.size(); ++k) {
                if (entry.kinds[k] != kind) continue;
                const auto [low, high] = std::minmax_element(entry.rates[k].begin(), entry.rates[k].end());
                entry.rows[k].per_second = median_of(entry.rates[k]);
                entry.rows[k].low = *low;
                entry.rows[k].high = *high;
                rows.push_back(entry.rows[k]);
            }
        }
    }
    return rows;
}

}  // namespace fase::bench
