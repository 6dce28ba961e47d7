/** Simplifies triangle meshes, for pictures that must be fast. */
import type { Triangles } from "../model";

const boxTriangles = 12;
/** so many that only equal vertices are joined */
const fineCells = 1024;

/**
 * Returns the mesh with at most `cells` vertices along each axis of its box, without normals: vertices in the same cell
 * become the one that is farthest from the centre; triangles that collapse or repeat are removed. Meshes with no more
 * triangles than a box keep them. Source: Rossignac and Borrel 1993, "Multi-resolution 3D approximations
 * for rendering complex scenes".
 */
export function simplify(mesh: Triangles, cells: number): Triangles {
  const { vertices } = mesh;
  const keys = cellsOf(vertices, mesh.triangles.length <= 3 * boxTriangles ? fineCells : cells);
  const { rowOf, kept } = farthestInCells(vertices, keys);
  const triangles = joinCorners(mesh.triangles, (vertex) => rowOf.get(keys[vertex]) as number);
  if (triangles.length === 0) return mesh; // flat
  const points = new Float32Array(3 * kept.length);
  kept.forEach((vertex, row) => points.set(vertices.subarray(3 * vertex, 3 * vertex + 3), 3 * row));
  return { vertices: points, normals: null, triangles: Uint32Array.from(triangles) };
}

/** Returns the number of the cell that each vertex is in. */
function cellsOf(vertices: Float32Array, cells: number): Uint32Array {
  const keys = new Uint32Array(vertices.length / 3);
  for (let axis = 0; axis < 3; ++axis) {
    let lo = Infinity;
    let hi = -Infinity;
    for (let at = axis; at < vertices.length; at += 3) {
      lo = Math.min(lo, vertices[at]);
      hi = Math.max(hi, vertices[at]);
    }
    const perMetre = hi > lo ? cells / (hi - lo) : 0;
    for (let v = 0; v < keys.length; ++v)
      keys[v] = keys[v] * cells + Math.min(cells - 1, Math.floor((vertices[3 * v + axis] - lo) * perMetre));
  }
  return keys;
}

/** Returns, for each cell in use, its row and the vertex farthest from the mean of all vertices. */
function farthestInCells(vertices: Float32Array, keys: Uint32Array): { rowOf: Map<number, number>; kept: number[] } {
  const middle = [0, 0, 0];
  vertices.forEach((x, i) => (middle[i % 3] += x / keys.length));
  const distances = Array.from(keys, (_, v) => Math.hypot(...middle.map((x, axis) => vertices[3 * v + axis] - x)));
  const rowOf = new Map<number, number>();
  const kept: number[] = [];
  keys.forEach((key, vertex) => {
    const row = rowOf.get(key);
    if (row === undefined) rowOf.set(key, kept.push(vertex) - 1);
    else if (distances[vertex] > distances[kept[row]]) kept[row] = vertex;
  });
  return { rowOf, kept };
}

/** Maps the corners of triangles; leaves out triangles that collapse or repeat. */
function joinCorners(triangles: Uint32Array, rowOf: (vertex: number) => number): number[] {
  const seen = new Set<string>();
  const corners: number[] = [];
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [rowOf(triangles[t]), rowOf(triangles[t + 1]), rowOf(triangles[t + 2])];
    if (a === b || b === c || c === a) continue;
    const name = (a < b && a < c ? [a, b, c] : b < c ? [b, c, a] : [c, a, b]).join();
    if (seen.has(name)) continue;
    seen.add(name);
    corners.push(a, b, c);
  }
  return corners;
}
