#pragma once
/// How many questions a second structures answer, and whether they answer right.
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/common/structure_choice.hpp"
#include "cli/query_set.hpp"

namespace fase::cli {

/// The right answers to the first questions of each kind.
struct JudgedQueries {
    struct Ray {
        float at = 0;
        broad::Proxy proxy = 0xffffffff;  ///< the largest: no hit
        friend bool operator==(const Ray&, const Ray&) = default;
    };
    struct Frustum {
        std::vector<broad::Proxy> whole, partly;  ///< ascending
        friend bool operator==(const Frustum&, const Frustum&) = default;
    };
    std::vector<Ray> rays;                         ///< the nearest box; of equally near ones that of the least place
    std::vector<std::vector<broad::Proxy>> boxes;  ///< ascending
    std::vector<Frustum> frusta;
};

/// What one structure made of the questions of one kind.
struct QueryRate {
    std::uint64_t asked = 0, hits = 0;  ///< rays that met a box; boxes that were found, or seen
    std::optional<double> per_second;   ///< questions; none when none was asked
};

/// What one structure made of all of them.
struct QueryFigures {
    std::string structure, chosen;
    double build_ms = 0;
    QueryRate rays, boxes, frusta;
    bool complete = true;   ///< false: stopped after the time that it had; the counts are of what was asked till then
    std::size_t bytes = 0;  ///< of the structure
    std::optional<bool> right;  ///< whether it gives the judged answers; none: not asked
};

/// Answers by trying all boxes, for the first 64 questions of each kind.
[[nodiscard]] JudgedQueries judge_queries(std::span<const Aabb> boxes, const QuerySet& set);

/// Fills a structure with the boxes and asks. Each kind of question gets a third of `max_seconds`. `go_on` is asked
/// now and then; false stops it.
[[nodiscard]] QueryFigures measure_queries(std::span<const Aabb> boxes, const QuerySet& set,
                                           const JudgedQueries* judged, const StructureChoice& choice,
                                           double max_seconds, const std::function<bool()>& go_on);

}  // namespace fase::cli
