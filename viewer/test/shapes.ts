/** For the tests: how each kind of shape is stored, by fase/record/format.md, and which points it contains. */
import type { Triangles, Vec3 } from "../src/model";
import type { Shape } from "../src/shapes/list";
import type { Writer } from "./encode";

/** Returns an octahedron, counter-clockwise from outside. */
export function octahedron(radius: number): Triangles {
  const r = radius;
  return {
    vertices: new Float32Array([r, 0, 0, -r, 0, 0, 0, r, 0, 0, -r, 0, 0, 0, r, 0, 0, -r]),
    normals: null,
    triangles: new Uint32Array([0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5]),
  };
}

interface ShapeCase<S> {
  example: S;
  /** Whether a point is in the shape, by definition. */
  contains(shape: S, x: number, y: number, z: number): boolean;
  write(out: Writer, shape: S): void;
}
const ofTriangles = <K extends string>(kind: K, code: number): ShapeCase<{ kind: K; mesh: Triangles }> => ({
  example: { kind, mesh: octahedron(0.8) },
  contains: ({ mesh }, x, y, z) => Math.abs(x) + Math.abs(y) + Math.abs(z) <= mesh.vertices[0], // octahedra only
  write: (out, { mesh: { vertices, triangles } }) => {
    out.u8(code);
    out.u32(vertices.length / 3);
    out.u32(triangles.length / 3);
    out.f32(...vertices);
    triangles.forEach((vertex) => out.u32(vertex));
  },
});

/** One entry for each kind of the viewer's list; the type checker requires all. */
const cases: { [K in Shape["kind"]]: ShapeCase<Extract<Shape, { kind: K }>> } = {
  sphere: {
    example: { kind: "sphere", radius: 0.7 },
    contains: ({ radius }, x, y, z) => Math.hypot(x, y, z) <= radius,
    write: (out, { radius }) => {
      out.u8(0);
      out.f32(radius);
    },
  },
  box: {
    example: { kind: "box", half: [0.5, 0.2, 0.9] },
    contains: ({ half }, x, y, z) => Math.abs(x) <= half[0] && Math.abs(y) <= half[1] && Math.abs(z) <= half[2],
    write: (out, { half }) => {
      out.u8(1);
      out.f32(...half);
    },
  },
  capsule: {
    example: { kind: "capsule", radius: 0.3, halfLength: 0.6 },
    contains: ({ radius, halfLength }, x, y, z) => Math.hypot(x, Math.max(0, Math.abs(y) - halfLength), z) <= radius,
    write: (out, { radius, halfLength }) => {
      out.u8(2);
      out.f32(radius, halfLength);
    },
  },
  cylinder: {
    example: { kind: "cylinder", radius: 0.4, halfHeight: 0.7 },
    contains: ({ radius, halfHeight }, x, y, z) => Math.hypot(x, z) <= radius && Math.abs(y) <= halfHeight,
    write: (out, { radius, halfHeight }) => {
      out.u8(3);
      out.f32(radius, halfHeight);
    },
  },
  "convex hull": ofTriangles("convex hull", 4),
  "half-space": {
    example: { kind: "half-space" },
    contains: (_shape, _x, y) => y <= 0,
    write: (out) => out.u8(5),
  },
  mesh: ofTriangles("mesh", 6),
};

export const examples: Shape[] = Object.values(cases).map(({ example }) => example);

const caseOf = (shape: Shape) => cases[shape.kind] as ShapeCase<Shape>;
export const contains = (shape: Shape, [x, y, z]: Vec3): boolean => caseOf(shape).contains(shape, x, y, z);
export const writeShape = (out: Writer, shape: Shape): void => caseOf(shape).write(out, shape);
