/** The shapes that are stored as triangles: convex hulls, and meshes for all shapes that have no kind of their own. */
import { readTriangles } from "../format/triangles";
import type { Triangles, Vec3 } from "../model";
import { cross, dot, sub } from "../scene/maths";
import type { Ray, ShapeTraits } from "./traits";

type TriangleShape<K extends string> = { kind: K; mesh: Triangles };

function makeTraits<K extends string>(kind: K, describe: (mesh: Triangles) => string): ShapeTraits<TriangleShape<K>> {
  return {
    kind,
    read: (read) => {
      const vertices = read.u32();
      const triangles = read.u32();
      return { kind, mesh: readTriangles(read, vertices, triangles, false) };
    },
    extent: ({ mesh: { vertices } }, x, y, z, out) => {
      let lo = Infinity;
      let hi = -Infinity;
      for (let v = 0; v < vertices.length; v += 3) {
        const at = x * vertices[v] + y * vertices[v + 1] + z * vertices[v + 2];
        if (at < lo) lo = at;
        if (at > hi) hi = at;
      }
      out[0] = lo;
      out[1] = hi;
    },
    radius: ({ mesh: { vertices } }) => {
      let radius = 0;
      for (let v = 0; v < vertices.length; v += 3)
        radius = Math.max(radius, Math.hypot(vertices[v], vertices[v + 1], vertices[v + 2]));
      return radius;
    },
    intersect: ({ mesh }, ray) => intersectTriangles(ray, mesh),
    pieces: ({ mesh }) => [{ form: mesh, size: [1, 1, 1] }],
    isGround: false,
    describe: ({ mesh }) => describe(mesh),
  };
}

export const convexHull = makeTraits("convex hull", ({ vertices }) => `hull of ${vertices.length / 3} points`);
export const mesh = makeTraits("mesh", ({ triangles }) => `mesh of ${triangles.length / 3} triangles`);

/** Source: Möller and Trumbore 1997, "Fast, minimum storage ray/triangle intersection". */
function intersectTriangles({ origin, direction }: Ray, { vertices, triangles }: Triangles): number | null {
  let best: number | null = null;
  const corner = (i: number): Vec3 => [
    vertices[3 * triangles[i]],
    vertices[3 * triangles[i] + 1],
    vertices[3 * triangles[i] + 2],
  ];
  for (let t = 0; t < triangles.length; t += 3) {
    const a = corner(t);
    const ab = sub(corner(t + 1), a);
    const ac = sub(corner(t + 2), a);
    const p = cross(direction, ac);
    const det = dot(ab, p);
    if (Math.abs(det) < 1e-14) continue;
    const s = sub(origin, a);
    const u = dot(s, p) / det;
    const q = cross(s, ab);
    const v = dot(direction, q) / det;
    const distance = dot(ac, q) / det;
    if (u < 0 || v < 0 || u + v > 1 || distance < 0) continue;
    if (best === null || distance < best) best = distance;
  }
  return best;
}
