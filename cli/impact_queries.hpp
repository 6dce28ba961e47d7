#pragma once
/// Files of queries for times of impact, with known answers.
#include <array>
#include <string>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/narrow/impact.hpp"

namespace fase::cli {

/// Four points that move: two edges (a0, a1, b0, b1), or a vertex and the corners of a face.
struct ImpactQuery {
    std::array<narrow::MovingPoint, 4> points;
    bool meets = false;  ///< the known answer
};

/// The queries of one file.
struct ImpactFile {
    std::string name;  ///< relative to the folder
    bool edges = false;
    std::vector<ImpactQuery> queries;
};

/// Reads all files FOLDER/**/edge-edge/*.csv and FOLDER/**/vertex-face/*.csv, sorted by name. Coordinates are rounded
/// to double. Io when the folder or a file cannot be read; Format when there is none, or one has another content.
Result<std::vector<ImpactFile>> read_impact_files(const std::string& folder);

}  // namespace fase::cli
