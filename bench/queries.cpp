/// What `fase bench queries` measures: rays, overlaps and cameras a second, in each structure and in peers.
#include "bench/queries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <utility>

#include "bench/timing.hpp"
#include "fase/core/hash.hpp"

namespace fase::bench {
namespace {

/// What the processor worked for this program, all threads together: other programs hardly count.
class Stopwatch {
public:
    [[nodiscard]] double seconds() const { return static_cast<double>(std::clock() - begin_) / CLOCKS_PER_SEC; }

private:
    std::clock_t begin_ = std::clock();
};

/// What one contender answered to the first questions of one kind.
struct Answers {
    std::vector<query::Hit> hits;  // rays
    Lists lists;                   // the others
    double seconds = 0;
    [[nodiscard]] std::size_t count(QueryKind kind) const {
        return kind == QueryKind::Rays ? hits.size() : lists.ends.size();
    }
};

std::size_t question_count(const Questions& questions, QueryKind kind) {
    return kind == QueryKind::Rays    ? questions.rays.size()
           : kind == QueryKind::Boxes ? questions.boxes.size()
                                      : questions.frusta.size();
}

void ask(const QueryContender& contender, const Questions& questions, QueryKind kind, std::size_t first,
         std::size_t count, Answers& answers) {
    switch (kind) {
        case QueryKind::Rays: contender.rays(std::span(questions.rays).subspan(first, count), answers.hits); break;
        case QueryKind::Boxes: contender.boxes(std::span(questions.boxes).subspan(first, count), answers.lists); break;
        case QueryKind::Frusta:
            contender.frusta(std::span(questions.frusta).subspan(first, count), answers.lists);
            break;
    }
}

/// Asks as much as the time allows, `most` questions at most. Boxes that move are moved within the time.
void run(QueryContender& contender, const QueryScene& scene, QueryKind kind, std::size_t most, double seconds,
         Answers& answers) {
    answers.hits.clear();
    answers.lists.clear();
    answers.seconds = 0;
    const std::size_t all = question_count(scene.questions, kind);
    std::vector<broad::Move> moved;
    const std::size_t pieces = scene.moves() ? scene.frames : std::max<std::size_t>(all / 64, 1);
    for (std::size_t piece = 0; piece < pieces && answers.seconds < seconds; ++piece) {
        const std::size_t first = all * piece / pieces, end = all * (piece + 1) / pieces;
        if (end > most) break;
        if (scene.moves()) scene.place(piece, moved);
        const Stopwatch watch;
        if (scene.moves()) contender.move(moved);
        ask(contender, scene.questions, kind, first, end - first, answers);
        answers.seconds += watch.seconds();
    }
}

/// A number that does not depend on the order.
std::uint64_t digest(std::span<const broad::Proxy> proxies) {
    std::uint64_t sum = proxies.size();
    for (const broad::Proxy p : proxies) sum += mix_bits(p + 1ull);
    return sum;
}
std::span<const broad::Proxy> list(const Lists& lists, std::size_t i) {
    const std::size_t begin = i == 0 ? 0 : lists.ends[i - 1];
    return std::span(lists.proxies).subspan(begin, lists.ends[i] - begin);
}

bool same_hit(const query::Hit& a, const query::Hit& b, bool roughly) {
    if (!roughly) return a == b;
    if (!a.met() || !b.met()) return a.met() == b.met();
    return std::abs(a.at - b.at) <= 1e-4f * (1 + b.at);
}

/// How many of the answers are not those of the reference.
std::size_t differing(const Answers& answers, const Answers& reference, QueryKind kind, bool roughly) {
    const std::size_t count = std::min(answers.count(kind), reference.count(kind));
    std::size_t differ = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const bool same = kind == QueryKind::Rays ? same_hit(answers.hits[i], reference.hits[i], roughly)
                                                  : digest(list(answers.lists, i)) == digest(list(reference.lists, i));
        differ += same ? 0 : 1;
    }
    return differ;
}

std::size_t hits_in(const Answers& answers, QueryKind kind) {
    if (kind != QueryKind::Rays) return answers.lists.proxies.size();
    return static_cast<std::size_t>(
        std::count_if(answers.hits.begin(), answers.hits.end(), [](const query::Hit& hit) { return hit.met(); }));
}

Error unknown(const char* option, const std::string& found, const std::string& names) {
    return {Status::BadArgument, option, fmt::format("found \"{}\", need one of {}", found, names), {}};
}

Result<std::vector<const QueryContenderInfo*>> contenders_named(const std::string& names) {
    std::vector<const QueryContenderInfo*> chosen;
    if (names == "all") {
        for (const QueryContenderInfo& info : query_contenders()) chosen.push_back(&info);
        return chosen;
    }
    for (std::size_t begin = 0; begin <= names.size();) {
        const std::size_t end = std::min(names.find(',', begin), names.size());
        const std::string name = names.substr(begin, end - begin);
        const auto all = query_contenders();
        const auto found = std::find_if(all.begin(), all.end(), [&](const auto& info) { return info.name == name; });
        if (found == all.end()) {
            std::string known = "all";
            for (const QueryContenderInfo& info : all) known += ", " + info.name;
            return unknown("--contender", name, known);
        }
        chosen.push_back(&*found);
        begin = end + 1;
    }
    return chosen;
}

/// A contender of the list, which must be there.
std::unique_ptr<QueryContender> made(std::string_view name) {
    for (const QueryContenderInfo& info : query_contenders())
        if (info.name == name) return info.make(info.name);
    return nullptr;
}

/// One contender on one scene, with what it is asked.
struct Entry {
    const QueryContenderInfo* info = nullptr;
    std::unique_ptr<QueryContender> contender;
    double build_ms = 0;
    std::vector<QueryKind> kinds;
    std::vector<QueryRow> rows;              ///< by kind
    std::vector<std::vector<double>> rates;  ///< by kind and round
};

/// What all are held against: the wide tree, a part of whose answers brute force has confirmed.
Result<std::vector<Answers>> reference_answers(const QueryScene& scene) {
    const auto tree = made("wide_bvh"), judge = made("brute_force");
    std::vector<Answers> reference(std::size(all_query_kinds));
    constexpr double enough = 1e9;
    for (std::size_t k = 0; k < reference.size(); ++k) {
        const QueryKind kind = all_query_kinds[k];
        const std::size_t all = question_count(scene.questions, kind);
        tree->build(scene);
        run(*tree, scene, kind, all, enough, reference[k]);
        judge->build(scene);
        const std::size_t pieces = scene.moves() ? scene.frames : std::max<std::size_t>(all / 64, 1);
        Answers judged;
        run(*judge, scene, kind, std::max(all / pieces, std::min<std::size_t>(all, 100)), enough, judged);
        if (const std::size_t differ = differing(judged, reference[k], kind, false); differ != 0) {
            return Error{Status::BadArgument, "wide_bvh",
                         fmt::format("found {} answers to {} that are not those of brute force", differ, name_of(kind)),
                         "report it: a mistake of ours"};
        }
    }
    return reference;
}

}  // namespace

Result<std::vector<QueryScene>> query_scenes(const QueryOptions& options) {
    if (!options.scene.empty() && options.scene != "level" && options.scene != "static" && options.scene != "pile")
        return unknown("--scene", options.scene, "level, static, pile");
    const auto wanted = [&](std::string_view name) { return options.scene.empty() || options.scene == name; };
    std::vector<QueryScene> scenes;
    if (wanted("level")) {
        for (const std::string& mesh : options.meshes) {
            Result<QueryScene> level = level_from(mesh, options.counts);
            if (!level) return level.error();
            scenes.push_back(*std::move(level));
        }
        if (options.meshes.empty()) scenes.push_back(generated_level(options.counts));
    }
    if (wanted("static")) scenes.push_back(static_boxes(options.counts));
    if (wanted("pile")) scenes.push_back(stirred_pile(options.counts));
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
    for (std::size_t round = 0; round <= rounds; ++round) {  // the first is for the check
        for (Entry& entry : entries) {
            if (!progress(done++, total, scene.name, entry.info->name)) return rows;
            entry.rates.resize(entry.kinds.size());
            for (std::size_t k = 0; k < entry.kinds.size(); ++k) {
                const QueryKind kind = entry.kinds[k];
                if (scene.moves()) entry.contender->build(scene);
                run(*entry.contender, scene, kind, question_count(scene.questions, kind), options.seconds, answers);
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
                row.things = scene.boxes.size();
                row.rounds = options.rounds;
                row.asked = row.compared = answers.count(kind);
                row.hits = hits_in(answers, kind);
                row.build_ms = entry.build_ms;
                row.bytes = entry.contender->bytes();
                row.differ = differing(answers, (*reference)[static_cast<std::size_t>(kind)], kind,
                                       entry.contender->rounds_its_own_way(scene));
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
