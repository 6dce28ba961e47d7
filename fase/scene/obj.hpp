#pragma once
/// Reads the triangles of Wavefront OBJ files.
#include <cstddef>
#include <span>
#include <string>

#include "fase/core/result.hpp"
#include "fase/geometry/mesh.hpp"

namespace fase::scene {

/// The corners (`v`) and faces (`f`) of a text; faces of more corners are cut into triangles by
/// ears, concave ones too; those of more than 512, and those that cross themselves, become fans. Objects, groups,
/// normals, materials, lines and curves are passed over. Counting from the end with negative numbers, and lines that go
/// on behind a `\`, are understood. `name` is the file, for errors: Format with "name:line" for numbers that are none
/// or not finite as floats, a corner that does not exist (yet), a face of fewer than three, NUL bytes. A text without
/// faces is an empty mesh. Memory: at most 8 times the text. Source of the format: Wavefront 1995, Advanced Visualizer,
/// appendix B1.
Result<TriangleMesh> parse_obj(const std::string& name, std::span<const std::byte> bytes);

/// Reads and parses a regular file of at most 1 GiB; errors of read_file() and parse_obj().
Result<TriangleMesh> read_obj(const std::string& path);

}  // namespace fase::scene
