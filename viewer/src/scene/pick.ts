/** Which body a ray meets first: exact for every shape, in the shape's own frame. */
import type { Shape, Tables, Triangles, Vec3 } from "../model";
import { isThere } from "./bounds";
import { combine, cross, dot, inverse, rotate, sub } from "./maths";
import type { Poses } from "./poses";

export interface Ray {
  origin: Vec3;
  /** unit */
  direction: Vec3;
}
export interface Picked {
  body: number;
  collider: number;
  distance: number;
}

/** The nearest collider that the ray (world frame) meets; a sensor only when nothing else is met. */
export function pick(tables: Tables, poses: Poses, ray: Ray): Picked | null {
  const { frame } = poses;
  if (!frame) return null;
  let solid: Picked | null = null;
  let sensor: Picked | null = null;
  tables.colliders.forEach((collider, index) => {
    if (!isThere(collider, frame)) return;
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
    const away = sub(ray.origin, pose.position);
    if (passesBy(away, ray.direction, radiusOf(shape))) return;
    const back = inverse(pose.rotation);
    const distance = meet(shape, {
      origin: rotate(back, away),
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

/** How far a shape reaches from its own origin. */
function radiusOf(shape: Shape): number {
  let radius = radii.get(shape);
  if (radius === undefined) radii.set(shape, (radius = measureRadius(shape)));
  return radius;
}

function measureRadius(shape: Shape): number {
  switch (shape.kind) {
    case "sphere":
      return shape.radius;
    case "box":
      return Math.hypot(...shape.half);
    case "capsule":
      return shape.radius + shape.halfLength;
    case "cylinder":
      return Math.hypot(shape.radius, shape.halfHeight);
    case "half-space":
      return Infinity;
    default: {
      const { vertices } = shape.mesh;
      let most = 0;
      for (let i = 0; i < vertices.length; i += 3)
        most = Math.max(most, Math.hypot(vertices[i], vertices[i + 1], vertices[i + 2]));
      return most;
    }
  }
}

/** Does the ray from `away` (relative to a ball's centre) miss the ball? */
function passesBy(away: Vec3, direction: Vec3, radius: number): boolean {
  const along = dot(away, direction);
  const outside = dot(away, away) - radius * radius;
  return outside > 0 && (along > 0 || along * along < outside);
}

/** How far along the ray (in the shape's frame) it enters the shape; 0 when it starts inside; null: it misses. */
export function meet(shape: Shape, ray: Ray): number | null {
  switch (shape.kind) {
    case "sphere":
      return meetBall(ray, 0, shape.radius);
    case "box":
      return meetSlabs(ray, shape.half);
    case "capsule":
      return nearest(
        meetPipe(ray, shape.radius, shape.halfLength, false),
        meetBall(ray, shape.halfLength, shape.radius),
        meetBall(ray, -shape.halfLength, shape.radius),
      );
    case "cylinder":
      return meetPipe(ray, shape.radius, shape.halfHeight, true);
    case "convex hull":
    case "mesh":
      return meetTriangles(ray, shape.mesh);
    case "half-space": {
      if (ray.origin[1] <= 0) return 0;
      return ray.direction[1] < 0 ? -ray.origin[1] / ray.direction[1] : null;
    }
  }
}

function nearest(...distances: (number | null)[]): number | null {
  const met = distances.filter((d): d is number => d !== null);
  return met.length ? Math.min(...met) : null;
}

/** A ball around (0, y, 0). */
function meetBall({ origin, direction }: Ray, y: number, radius: number): number | null {
  const m: Vec3 = [origin[0], origin[1] - y, origin[2]];
  const b = dot(m, direction);
  const c = dot(m, m) - radius * radius;
  if (c <= 0) return 0;
  const root = b * b - c;
  return b < 0 && root >= 0 ? -b - Math.sqrt(root) : null;
}

/** The interval of the ray inside the slab |x| <= half on one axis. */
function slab(origin: number, direction: number, half: number): [number, number] | null {
  if (direction === 0) return Math.abs(origin) <= half ? [-Infinity, Infinity] : null;
  const a = (-half - origin) / direction;
  const b = (half - origin) / direction;
  return a < b ? [a, b] : [b, a];
}

function meetSlabs({ origin, direction }: Ray, half: Vec3): number | null {
  let enter = 0;
  let leave = Infinity;
  for (let i = 0; i < 3; ++i) {
    const span = slab(origin[i], direction[i], half[i]);
    if (!span) return null;
    enter = Math.max(enter, span[0]);
    leave = Math.min(leave, span[1]);
  }
  return enter <= leave ? enter : null;
}

/** A pipe round the y axis; `closed`: with flat ends. */
function meetPipe({ origin, direction }: Ray, radius: number, half: number, closed: boolean): number | null {
  const a = direction[0] ** 2 + direction[2] ** 2;
  const b = origin[0] * direction[0] + origin[2] * direction[2];
  const c = origin[0] ** 2 + origin[2] ** 2 - radius * radius;
  let round: [number, number];
  if (a === 0) {
    if (c > 0) return null;
    round = [-Infinity, Infinity];
  } else {
    const root = b * b - a * c;
    if (root < 0) return null;
    round = [(-b - Math.sqrt(root)) / a, (-b + Math.sqrt(root)) / a];
  }
  const flat = slab(origin[1], direction[1], half);
  if (!flat) return null;
  const enter = Math.max(0, round[0], flat[0]);
  if (enter > Math.min(round[1], flat[1])) return null;
  if (!closed && flat[0] > Math.max(0, round[0])) return null; // through the open end: the cap's ball answers
  return enter;
}

/** Source: Möller and Trumbore 1997, "Fast, minimum storage ray/triangle intersection". */
function meetTriangles({ origin, direction }: Ray, { vertices, triangles }: Triangles): number | null {
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
