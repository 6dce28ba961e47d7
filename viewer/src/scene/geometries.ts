/** The unit geometries of forms, three.js geometry of triangle meshes, and coarse triangles of both. */
import { BufferAttribute, BufferGeometry } from "three";
import type { Triangles } from "../model";
import { type Form, isTriangles } from "../shapes/traits";
import { simplify } from "./simplify";

/** Returns the geometry of a form, finer for small counts. */
export const unitGeometry = (form: Form, count: number): BufferGeometry =>
  form.geometry(count > 4000 ? 14 : count > 800 ? 20 : 32);

/** Returns a form or a mesh with at most `cells` vertices along each axis (simplify.ts); Infinity: a mesh as it is. */
export function coarseTriangles(form: Form | Triangles, cells: number): Triangles {
  if (isTriangles(form)) return cells === Infinity ? form : simplify(form, cells);
  const geometry = form.geometry(16);
  const made: Triangles = {
    vertices: Float32Array.from(geometry.getAttribute("position").array),
    normals: null,
    triangles: Uint32Array.from(geometry.index?.array ?? []),
  };
  geometry.dispose();
  return cells === Infinity ? made : simplify(made, cells);
}

/** Returns a mesh with its normals, or with flat normals (then triangles share no vertices). */
export function meshGeometry({ vertices, normals, triangles }: Triangles): BufferGeometry {
  const geometry = new BufferGeometry();
  if (normals) {
    geometry.setAttribute("position", new BufferAttribute(vertices, 3));
    geometry.setAttribute("normal", new BufferAttribute(normals, 3));
    geometry.setIndex(new BufferAttribute(triangles, 1));
    return geometry;
  }
  const corners = new Float32Array(3 * triangles.length);
  triangles.forEach((vertex, i) => corners.set(vertices.subarray(3 * vertex, 3 * vertex + 3), 3 * i));
  geometry.setAttribute("position", new BufferAttribute(corners, 3));
  geometry.setIndex(
    new BufferAttribute(
      Uint32Array.from(triangles, (_, i) => i),
      1,
    ),
  );
  geometry.computeVertexNormals();
  return geometry;
}
