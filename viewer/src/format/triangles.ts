/** Reads triangles from a recording. */
import type { Triangles } from "../model";
import type { Reader } from "./bytes";

/** Fails when an index or a coordinate is invalid. */
export function readTriangles(read: Reader, vertexCount: number, triangleCount: number, hasNormals: boolean): Triangles {
  const bytes = vertexCount * (hasNormals ? 24 : 12) + triangleCount * 12;
  if (bytes > read.left) read.fail(`found a mesh of ${bytes} bytes, but only ${read.left} follow`);
  const vertices = read.floats(3 * vertexCount);
  const normals = hasNormals ? read.floats(3 * vertexCount) : null;
  const triangles = read.words(3 * triangleCount);
  if (!vertices.every(Number.isFinite)) read.fail("found a vertex that is not finite");
  if (triangles.some((vertex) => vertex >= vertexCount))
    read.fail(`found a triangle beyond the ${vertexCount} vertices`);
  return { vertices, normals, triangles };
}
