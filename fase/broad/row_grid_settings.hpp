#pragma once
/// The settings of a row grid and of FramePairs.
#include <cstdint>

namespace fase::broad {

/// Tuning parameters of a row grid. They affect the order of the results and the time, never which pairs and hits are
/// reported.
struct RowGridSettings {
    /// How the rows of a level are looked up: a table has an entry for every cell, a list only rows that hold a box.
    enum class Rows : std::uint8_t { Chosen, Table, List };
    Rows rows = Rows::Chosen;
    float cell = 0;                  ///< side of the finest cells, metres; 0: chosen from the boxes
    float side_share = 1.2f;         ///< a chosen side, divided by the 98th percentile of the longest sides
    float cells_along = 5;           ///< max number of cells along a row per cell side; rows are one side apart
    float level_ratio = 3;           ///< cell side divided by that of the next finer level; at least 1.5
    float cells_per_box = 0.8f;      ///< max mean number of table cells per box; five times that in crowded scenes
    std::uint32_t max_fit_age = 64;  ///< max number of commits between two choices of levels and cells
    std::uint32_t sample = 1024;     ///< number of boxes sampled for that choice
};

}  // namespace fase::broad
