#pragma once
/// The sets that `fase bench queries` asks about, and what it asks.
#include <span>
#include <string>
#include <vector>

#include "fase/broad/structure.hpp"
#include "fase/core/result.hpp"
#include "fase/geometry/frustum.hpp"
#include "fase/geometry/mesh.hpp"

namespace fase::bench {

/// What is asked about a set of things, in the order in which it is asked.
struct Questions {
    std::vector<Ray> rays;        ///< the nearest thing
    std::vector<Aabb> boxes;      ///< all boxes that overlap
    std::vector<Frustum> frusta;  ///< all boxes that a camera may see
};

/// Things in boxes: triangles, or the boxes themselves. They stand still, or move from frame to frame.
struct QueryScene {
    std::string name;                ///< "static", "pile", or "level: " and the file's name
    std::vector<broad::Move> boxes;  ///< proxies 0, 1, 2 …
    TriangleMesh mesh;               ///< empty: the boxes are the things; else box i is that of triangle i
    std::size_t frames = 1;          ///< above 1: all boxes move; the questions of each kind are shared among frames
    Questions questions;

    [[nodiscard]] bool moves() const { return frames > 1; }
    /// Where all boxes are in a frame; for scenes that move.
    void place(std::size_t frame, std::vector<broad::Move>& out) const;
};

struct QueryCounts {
    std::size_t things = 0;  ///< boxes of "static", 0: a million; a fiftieth of it in "pile"
    std::size_t rays = 100000, boxes = 100000, frusta = 200;
};

/// Boxes of 0.2 to 2 m, strewn evenly; eight of ten rays meet one.
[[nodiscard]] QueryScene static_boxes(const QueryCounts& counts);
/// A heap of boxes that is stirred: what is farther out turns more slowly, so that neighbours part; 60 frames.
[[nodiscard]] QueryScene stirred_pile(const QueryCounts& counts);
/// The triangles of a file in Wavefront's OBJ format (polygons are cut into fans). Errors: Io; Format with the line.
[[nodiscard]] Result<QueryScene> level_from(const std::string& obj_file, const QueryCounts& counts);
/// A level of our own: hilly ground, with towers.
[[nodiscard]] QueryScene generated_level(const QueryCounts& counts);

}  // namespace fase::bench
