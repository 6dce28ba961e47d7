/** The unit geometries of forms, and three.js geometry of triangle meshes. */
import { BoxGeometry, BufferAttribute, BufferGeometry, CylinderGeometry, SphereGeometry } from "three";
import type { Triangles } from "../model";
import type { Form } from "./parts";

/** Unit geometry, finer when few are drawn. */
export function unitGeometry(form: Exclude<Form, "mesh">, count: number): BufferGeometry {
  const around = count > 4000 ? 14 : count > 800 ? 20 : 32;
  switch (form) {
    case "ball":
      return new SphereGeometry(1, around, around * 0.625);
    case "block":
      return new BoxGeometry(2, 2, 2);
    case "drum":
      return new CylinderGeometry(1, 1, 2, around);
    case "tube":
      return new CylinderGeometry(1, 1, 2, around, 1, true);
    case "cap":
      return new SphereGeometry(1, around, around * 0.3125, 0, Math.PI * 2, 0, Math.PI / 2);
  }
}

/** A mesh with normals: its own, or flat ones (each triangle then has corners of its own). */
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
