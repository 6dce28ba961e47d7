#pragma once
/// Reads the triangles of Wavefront OBJ files.
#include <cstddef>
#include <span>
#include <string>

#include "fase/core/result.hpp"
#include "fase/geometry/mesh.hpp"

namespace fase::scene {

/// Reads the vertices (`v`) and faces (`f`) of an OBJ text. Triangulates faces by ear clipping, also concave ones;
/// faces of more than 512 corners, and self-intersecting ones, become fans. Ignores objects, groups, normals,
/// materials, lines and curves. Supports negative indices (counted from the end) and lines continued with a `\`. `name`
/// is the file name in errors: Format with "name:line" for invalid numbers or numbers that are not finite as floats, a
/// vertex that is not defined (yet), a face of fewer than three corners, NUL bytes. A text without faces gives an empty
/// mesh. Memory: at most 8 times the text. Source of the format: Wavefront 1995, Advanced Visualizer, appendix B1.
Result<TriangleMesh> parse_obj(const std::string& name, std::span<const std::byte> bytes);

/// Reads and parses a regular file of at most 1 GiB. Errors of read_file() and parse_obj().
Result<TriangleMesh> read_obj(const std::string& path);

}  // namespace fase::scene
