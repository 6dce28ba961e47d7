#pragma once
/// The scenes of `fase bench queries` and their queries.
#include <span>
#include <string>
#include <vector>

#include "fase/broad/structure.hpp"
#include "fase/core/result.hpp"
#include "fase/geometry/frustum.hpp"
#include "fase/geometry/mesh.hpp"

namespace fase::bench {

/// The queries on a scene, in execution order.
struct SceneQueries {
    std::vector<Ray> rays;        ///< nearest hit
    std::vector<Aabb> boxes;      ///< all overlapping boxes
    std::vector<Frustum> frusta;  ///< all boxes that a camera may see
};

/// A set of items with boxes: triangles, or the boxes themselves. Static, or moving in each frame.
struct QueryScene {
    std::string name;                ///< "static", "pile", "level", or "level: " and the file name
    std::vector<broad::Move> boxes;  ///< proxies 0, 1, 2 …
    TriangleMesh mesh;               ///< empty: the boxes are the items; else box i bounds triangle i
    std::size_t frames = 1;          ///< above 1: all boxes move; each frame executes a share of each kind of query
    SceneQueries queries;

    [[nodiscard]] bool moves() const { return frames > 1; }
    /// Sets `out` to the boxes in a frame. Only for moving scenes.
    void boxes_at(std::size_t frame, std::vector<broad::Move>& out) const;
};

struct QueryCounts {
    std::size_t items = 0;  ///< boxes of "static"; 0: a million; "pile" has a fiftieth of it
    std::size_t rays = 100000, boxes = 100000, frusta = 200;
};

/// Boxes of 0.2 to 2 m, uniformly distributed; eight of ten rays hit one.
[[nodiscard]] QueryScene static_boxes(const QueryCounts& counts);
/// A conical pile of boxes that rotates about its axis, more slowly farther out, so that neighbours separate; 60
/// frames.
[[nodiscard]] QueryScene stirred_pile(const QueryCounts& counts);
/// Reads the triangles of a Wavefront OBJ file; polygons become fans. Errors: Io; Format with the line.
[[nodiscard]] Result<QueryScene> level_from(const std::string& obj_file, const QueryCounts& counts);
/// A generated level: uneven ground with towers, 45,000 triangles.
[[nodiscard]] QueryScene generated_level(const QueryCounts& counts);

}  // namespace fase::bench
