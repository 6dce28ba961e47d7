/** Breaks bodies into parts: one simple geometry each, placed and stretched in its body's frame. */
import type { LocalPose, Quat, Tables, Triangles, Vec3 } from "../model";
import { combine } from "./maths";

/** Unit geometries (reach -1 to 1 along their axes); "mesh" has triangles of its own. */
export type Form = "ball" | "block" | "drum" | "tube" | "cap" | "mesh";

export interface Part {
  body: number;
  form: Form;
  mesh: Triangles | null;
  smooth: boolean;
  pose: LocalPose;
  size: Vec3;
  colour: number | null;
  sensor: boolean;
  /** shown in frames [from, to) */
  from: number;
  to: number;
}

const upsideDown: Quat = [1, 0, 0, 0];
const none: Quat = [0, 0, 0, 1];

/** All parts of all bodies; half-spaces have none (the ground is drawn by itself). */
export function makeParts(tables: Tables): Part[] {
  const parts: Part[] = [];
  tables.bodies.forEach((body, row) => {
    for (const index of body.visuals) {
      const { mesh, pose, colour } = tables.visuals[index];
      parts.push({
        body: row,
        form: "mesh",
        mesh: tables.meshes[mesh],
        smooth: tables.meshes[mesh].normals !== null,
        pose,
        size: [1, 1, 1],
        colour: colour ?? body.colour,
        sensor: false,
        from: 0,
        to: Infinity,
      });
    }
    for (const index of body.colliders) {
      const collider = tables.colliders[index];
      if (body.visuals.length > 0 && !collider.sensor) continue;
      const shape = tables.shapes[collider.shape];
      const put = (
        form: Form,
        size: Vec3,
        at: Vec3 = [0, 0, 0],
        rotation: Quat = none,
        mesh: Triangles | null = null,
      ) =>
        parts.push({
          body: row,
          form,
          mesh,
          smooth: false,
          pose: combine(collider.pose, { position: at, rotation }),
          size,
          colour: body.colour,
          sensor: collider.sensor,
          from: collider.from,
          to: collider.to,
        });
      switch (shape.kind) {
        case "sphere":
          put("ball", [shape.radius, shape.radius, shape.radius]);
          break;
        case "box":
          put("block", shape.half);
          break;
        case "cylinder":
          put("drum", [shape.radius, shape.halfHeight, shape.radius]);
          break;
        case "capsule": {
          const { radius, halfLength } = shape;
          const round: Vec3 = [radius, radius, radius];
          if (halfLength > 0) put("tube", [radius, halfLength, radius]);
          put("cap", round, [0, halfLength, 0]);
          put("cap", round, [0, -halfLength, 0], upsideDown);
          break;
        }
        case "convex hull":
        case "mesh":
          put("mesh", [1, 1, 1], [0, 0, 0], none, shape.mesh);
          break;
        case "half-space":
          break;
      }
    }
  });
  return parts;
}
