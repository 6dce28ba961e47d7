/** Splits bodies into parts: a form each, with pose and size in the body's frame. */
import type { LocalPose, Tables, Triangles, Vec3 } from "../model";
import { traitsOf } from "../shapes/list";
import type { Form } from "../shapes/traits";
import { combine } from "./maths";

export interface Part {
  body: number;
  form: Form | Triangles;
  pose: LocalPose;
  size: Vec3;
  colour: number | null;
  sensor: boolean;
  /** shown in frames [from, to) */
  from: number;
  to: number;
}

/** Returns the parts of all bodies. The ground has none; it is drawn separately. */
export function makeParts(tables: Tables): Part[] {
  const parts: Part[] = [];
  tables.bodies.forEach((body, row) => {
    for (const index of body.visuals) {
      const { mesh, pose, colour } = tables.visuals[index];
      parts.push({
        body: row,
        form: tables.meshes[mesh],
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
      for (const { form, size, position, rotation } of traitsOf(shape).pieces(shape))
        parts.push({
          body: row,
          form,
          pose: combine(collider.pose, { position: position ?? [0, 0, 0], rotation: rotation ?? [0, 0, 0, 1] }),
          size,
          colour: body.colour,
          sensor: collider.sensor,
          from: collider.from,
          to: collider.to,
        });
    }
  });
  return parts;
}
