/** Ray intersections that several shapes use, in the frame of the shape. */
import type { Vec3 } from "../model";
import { dot } from "../scene/maths";
import type { Ray } from "./traits";

/** A sphere around (0, y, 0). */
export function intersectSphere({ origin, direction }: Ray, y: number, radius: number): number | null {
  const m: Vec3 = [origin[0], origin[1] - y, origin[2]];
  const b = dot(m, direction);
  const c = dot(m, m) - radius * radius;
  if (c <= 0) return 0;
  const root = b * b - c;
  return b < 0 && root >= 0 ? -b - Math.sqrt(root) : null;
}

/** Returns the interval of the ray inside the slab |x| <= half on one axis. */
export function slab(origin: number, direction: number, half: number): [number, number] | null {
  if (direction === 0) return Math.abs(origin) <= half ? [-Infinity, Infinity] : null;
  const a = (-half - origin) / direction;
  const b = (half - origin) / direction;
  return a < b ? [a, b] : [b, a];
}

/** A cylinder around the y axis; `closed`: with flat ends. */
export function intersectCylinder({ origin, direction }: Ray, radius: number, half: number, closed: boolean): number | null {
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
  if (!closed && flat[0] > Math.max(0, round[0])) return null; // through the open end: the sphere of the cap decides
  return enter;
}
