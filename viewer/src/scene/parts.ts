/** Splits bodies into parts: a form each, with pose and size in the body's frame. */
import type { Collider, LocalPose, Selection, Tables, Triangles, Vec3 } from "../model";
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
  /** of a static body: a level or a landscape, say */
  isStatic: boolean;
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
        isStatic: body.kind === 0,
        from: 0,
        to: Infinity,
      });
    }
    for (const index of body.colliders) {
      const collider = tables.colliders[index];
      if (body.visuals.length > 0 && !collider.sensor) continue;
      parts.push(...partsOfCollider(tables, collider));
    }
  });
  return parts;
}

/** Returns the parts of one collider. */
export function partsOfCollider(tables: Tables, collider: Collider): Part[] {
  const shape = tables.shapes[collider.shape];
  return traitsOf(shape)
    .pieces(shape)
    .map(({ form, size, position, rotation }) => ({
      body: collider.body,
      form,
      pose: combine(collider.pose, { position: position ?? [0, 0, 0], rotation: rotation ?? [0, 0, 0, 1] }),
      size,
      colour: tables.bodies[collider.body].colour,
      sensor: collider.sensor,
      isStatic: tables.bodies[collider.body].kind === 0,
      from: collider.from,
      to: collider.to,
    }));
}

/**
 * Returns the parts that show what is selected: those of collider number `shape` of the body; those of the whole body if
 * it has one collider or `shape` is null.
 */
export function partsOfSelection(tables: Tables, all: Part[], { body, shape }: Selection): Part[] {
  const { colliders } = tables.bodies[body];
  if (shape === null || colliders.length < 2) return all.filter((part) => part.body === body);
  return partsOfCollider(tables, tables.colliders[colliders[shape]]);
}
