/** World boxes of colliders, computed from shapes and poses. */
import type { Collider, Frame, Tables, Vec3 } from "../model";
import { type Shape, traitsOf } from "../shapes/list";
import type { Poses } from "./poses";

export interface Bounds {
  lo: Vec3;
  hi: Vec3;
}

// Scratch arrays: thousands of boxes are computed per picture.
const rotation = new Float64Array(9);
const centre = new Float64Array(3);
const below = new Float64Array(3);
const above = new Float64Array(3);
const extent = new Float64Array(2);

/** Sets `rotation` (column order) and `centre` to the collider's frame in the world. */
function setFrame({ body, pose }: Collider, poses: Poses): void {
  const r = 4 * body;
  const [px, py, pz] = pose.position;
  const [lx, ly, lz, lw] = pose.rotation;
  const bx = poses.rotations[r];
  const by = poses.rotations[r + 1];
  const bz = poses.rotations[r + 2];
  const bw = poses.rotations[r + 3];
  const tx = 2 * (by * pz - bz * py);
  const ty = 2 * (bz * px - bx * pz);
  const tz = 2 * (bx * py - by * px);
  centre[0] = poses.positions[3 * body] + px + bw * tx + by * tz - bz * ty;
  centre[1] = poses.positions[3 * body + 1] + py + bw * ty + bz * tx - bx * tz;
  centre[2] = poses.positions[3 * body + 2] + pz + bw * tz + bx * ty - by * tx;
  const x = bw * lx + bx * lw + by * lz - bz * ly;
  const y = bw * ly - bx * lz + by * lw + bz * lx;
  const z = bw * lz + bx * ly - by * lx + bz * lw;
  const w = bw * lw - bx * lx - by * ly - bz * lz;
  rotation[0] = 1 - 2 * (y * y + z * z);
  rotation[1] = 2 * (x * y + z * w);
  rotation[2] = 2 * (x * z - y * w);
  rotation[3] = 2 * (x * y - z * w);
  rotation[4] = 1 - 2 * (x * x + z * z);
  rotation[5] = 2 * (y * z + x * w);
  rotation[6] = 2 * (x * z + y * w);
  rotation[7] = 2 * (y * z - x * w);
  rotation[8] = 1 - 2 * (x * x + y * y);
}

/** Sets `below` and `above` to the extent of the shape from `centre` along the world axes. Returns false if unbounded. */
function computeExtent(shape: Shape): boolean {
  const traits = traitsOf(shape);
  for (let i = 0; i < 3; ++i) {
    traits.extent(shape, rotation[i], rotation[3 + i], rotation[6 + i], extent);
    if (extent[0] === -Infinity) return false;
    below[i] = extent[0];
    above[i] = extent[1];
  }
  return true;
}

/**
 * Writes the world box of a collider, relative to `origin`, to lo[index…] and hi[index…]. Returns false if the
 * shape is unbounded.
 */
export function writeWorldBox(
  lo: Float32Array | Float64Array,
  hi: Float32Array | Float64Array,
  index: number,
  tables: Tables,
  collider: Collider,
  poses: Poses,
  origin: Vec3,
): boolean {
  setFrame(collider, poses);
  if (!computeExtent(tables.shapes[collider.shape])) return false;
  for (let i = 0; i < 3; ++i) {
    lo[index + i] = centre[i] - origin[i] + below[i];
    hi[index + i] = centre[i] - origin[i] + above[i];
  }
  return true;
}

/** Returns the world box of a collider; null if the shape is unbounded. */
export function worldBox(tables: Tables, collider: Collider, poses: Poses): Bounds | null {
  const lo = new Float64Array(3);
  const hi = new Float64Array(3);
  if (!writeWorldBox(lo, hi, 0, tables, collider, poses, [0, 0, 0])) return null;
  return { lo: [...lo] as Vec3, hi: [...hi] as Vec3 };
}

/** Whether the collider exists at the frame. */
export const existsAt = (collider: Collider, frame: Frame): boolean =>
  frame.present[collider.body] === 1 && frame.number >= collider.from && frame.number < collider.to;
