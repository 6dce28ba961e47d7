#pragma once
/// Measures how many queries per second structures answer, and checks the answers.
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/common/structure_choice.hpp"
#include "cli/query_set.hpp"
#include "fase/core/no_index.hpp"

namespace fase::cli {

/// The correct answers to the first queries of each kind.
struct ReferenceAnswers {
    struct Ray {
        float distance = 0;             ///< metres from the ray's origin
        broad::Proxy proxy = no_index;  ///< no_index: no hit
        friend bool operator==(const Ray&, const Ray&) = default;
    };
    struct Frustum {
        std::vector<broad::Proxy> whole, partly;  ///< ascending
        friend bool operator==(const Frustum&, const Frustum&) = default;
    };
    std::vector<Ray> rays;                         ///< the nearest box; among equally near ones the lowest proxy
    std::vector<std::vector<broad::Proxy>> boxes;  ///< ascending
    std::vector<Frustum> frusta;
};

/// The figures of one structure for one kind of query.
struct QueryRate {
    std::uint64_t queries = 0, hits = 0;  ///< hits: rays that hit a box; boxes that were found, or are visible
    std::optional<double> per_second;     ///< queries; none if there were none
};

/// The figures of one structure for all kinds.
struct QueryFigures {
    std::string structure, chosen;
    double build_ms = 0;
    QueryRate rays, boxes, frusta;
    bool complete = true;         ///< false: stopped at its time limit; the counts are those up to then
    std::size_t bytes = 0;        ///< of the structure
    std::optional<bool> correct;  ///< whether it gives the reference answers; none: not checked
};

/// Answers the first 64 queries of each kind by testing all boxes.
[[nodiscard]] ReferenceAnswers reference_answers(std::span<const Aabb> boxes, const QuerySet& set);

/// Builds a structure from the boxes and runs the queries. Each kind gets a third of `max_seconds`. `go_on` is called
/// from time to time; false stops the measurement.
[[nodiscard]] QueryFigures measure_queries(std::span<const Aabb> boxes, const QuerySet& set,
                                           const ReferenceAnswers* reference, const StructureChoice& choice,
                                           double max_seconds, const std::function<bool()>& go_on);

}  // namespace fase::cli
