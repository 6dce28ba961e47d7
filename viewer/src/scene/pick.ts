/** Finds the first body on a ray: exact for every shape, in the shape's frame. */
import type { Tables, Vec3 } from "../model";
import { type Shape, traitsOf } from "../shapes/list";
import type { Ray } from "../shapes/traits";
import { existsAt } from "./bounds";
import { combine, dot, inverse, rotate, sub } from "./maths";
import type { Poses } from "./poses";

export interface Picked {
  body: number;
  collider: number;
  distance: number;
}

/** Returns the nearest collider on the ray (world frame); a sensor only when the ray hits nothing else. */
export function pick(tables: Tables, poses: Poses, ray: Ray): Picked | null {
  const { frame } = poses;
  if (!frame) return null;
  let solid: Picked | null = null;
  let sensor: Picked | null = null;
  tables.colliders.forEach((collider, index) => {
    if (!existsAt(collider, frame)) return;
    const b = 3 * collider.body;
    const r = 4 * collider.body;
    const pose = combine(
      {
        position: [poses.positions[b], poses.positions[b + 1], poses.positions[b + 2]],
        rotation: [poses.rotations[r], poses.rotations[r + 1], poses.rotations[r + 2], poses.rotations[r + 3]],
      },
      collider.pose,
    );
    const shape = tables.shapes[collider.shape];
    const relative = sub(ray.origin, pose.position);
    if (missesSphere(relative, ray.direction, radiusOf(shape))) return;
    const back = inverse(pose.rotation);
    const distance = traitsOf(shape).intersect(shape, {
      origin: rotate(back, relative),
      direction: rotate(back, ray.direction),
    });
    const best = collider.sensor ? sensor : solid;
    if (distance === null || (best && best.distance <= distance)) return;
    const picked = { body: collider.body, collider: index, distance };
    if (collider.sensor) sensor = picked;
    else solid = picked;
  });
  return solid ?? sensor;
}

const radii = new WeakMap<Shape, number>();

/** Returns the radius of the sphere around the shape's origin that contains it. */
function radiusOf(shape: Shape): number {
  let radius = radii.get(shape);
  if (radius === undefined) radii.set(shape, (radius = traitsOf(shape).radius(shape)));
  return radius;
}

/** Whether a ray misses a sphere; `origin` is relative to the sphere's centre. */
function missesSphere(origin: Vec3, direction: Vec3, radius: number): boolean {
  const along = dot(origin, direction);
  const outside = dot(origin, origin) - radius * radius;
  return outside > 0 && (along > 0 || along * along < outside);
}
