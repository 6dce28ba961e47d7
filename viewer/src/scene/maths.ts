/** Small vector and quaternion functions on plain tuples. Quaternions are x, y, z, w. */
import type { LocalPose, Quat, Vec3 } from "../model";

export const add = (a: Vec3, b: Vec3): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a: Vec3, s: number): Vec3 => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vec3, b: Vec3): Vec3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

/** Rotates a vector. */
export function rotate([x, y, z, w]: Quat, v: Vec3): Vec3 {
  const t = scale(cross([x, y, z], v), 2);
  return add(add(v, scale(t, w)), cross([x, y, z], t));
}
export const inverse = ([x, y, z, w]: Quat): Quat => [-x, -y, -z, w];
export const multiply = ([ax, ay, az, aw]: Quat, [bx, by, bz, bw]: Quat): Quat => [
  aw * bx + ax * bw + ay * bz - az * by,
  aw * by - ax * bz + ay * bw + az * bx,
  aw * bz + ax * by - ay * bx + az * bw,
  aw * bw - ax * bx - ay * by - az * bz,
];
/** Returns the pose `inner`, given relative to `outer`, in the frame of `outer`'s parent. */
export const combine = (outer: LocalPose, inner: LocalPose): LocalPose => ({
  position: add(outer.position, rotate(outer.rotation, inner.position)),
  rotation: multiply(outer.rotation, inner.rotation),
});

/** Returns a pseudo-random number in [0, 1) for an integer; the same in each run. */
export function hash01(n: number): number {
  let h = Math.imul(n ^ (n >>> 16), 0x45d9f3b);
  h = Math.imul(h ^ (h >>> 16), 0x45d9f3b);
  return ((h ^ (h >>> 16)) >>> 0) / 4294967296;
}
