/** World boxes of colliders, from shapes and poses. */
import type { Collider, Frame, Shape, Tables, Vec3 } from "../model";
import type { Poses } from "./poses";

export interface Bounds {
  lo: Vec3;
  hi: Vec3;
}

// Boxes are made for thousands of colliders a picture: these are used again for each.
const turn = new Float64Array(9);
const centre = new Float64Array(3);
const below = new Float64Array(3);
const above = new Float64Array(3);

/** Sets `turn` (by column) and `centre` to the collider's frame in the world. */
function placeFrame({ body, pose }: Collider, poses: Poses): void {
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
  turn[0] = 1 - 2 * (y * y + z * z);
  turn[1] = 2 * (x * y + z * w);
  turn[2] = 2 * (x * z - y * w);
  turn[3] = 2 * (x * y - z * w);
  turn[4] = 1 - 2 * (x * x + z * z);
  turn[5] = 2 * (y * z + x * w);
  turn[6] = 2 * (x * z + y * w);
  turn[7] = 2 * (y * z - x * w);
  turn[8] = 1 - 2 * (x * x + y * y);
}

/** Sets `below` and `above` to how far the shape reaches from `centre` along the world axes; false: it is endless. */
function measure(shape: Shape): boolean {
  for (let i = 0; i < 3; ++i) {
    const up = turn[3 + i];
    switch (shape.kind) {
      case "sphere":
        above[i] = shape.radius;
        break;
      case "box":
        above[i] =
          Math.abs(turn[i]) * shape.half[0] + Math.abs(up) * shape.half[1] + Math.abs(turn[6 + i]) * shape.half[2];
        break;
      case "capsule":
        above[i] = Math.abs(up) * shape.halfLength + shape.radius;
        break;
      case "cylinder":
        above[i] = Math.abs(up) * shape.halfHeight + Math.sqrt(Math.max(0, 1 - up * up)) * shape.radius;
        break;
      case "half-space":
        return false;
      default: {
        const { vertices } = shape.mesh;
        let lo = Infinity;
        let hi = -Infinity;
        for (let v = 0; v < vertices.length; v += 3) {
          const at = turn[i] * vertices[v] + up * vertices[v + 1] + turn[6 + i] * vertices[v + 2];
          if (at < lo) lo = at;
          if (at > hi) hi = at;
        }
        below[i] = lo;
        above[i] = hi;
        continue;
      }
    }
    below[i] = -above[i];
  }
  return true;
}

/**
 * Writes the world box of a collider as posed, relative to `origin`, to lo[at…] and hi[at…]; false: it has none
 * (half-space).
 */
export function writeWorldBox(
  lo: Float32Array | Float64Array,
  hi: Float32Array | Float64Array,
  at: number,
  tables: Tables,
  collider: Collider,
  poses: Poses,
  origin: Vec3,
): boolean {
  placeFrame(collider, poses);
  if (!measure(tables.shapes[collider.shape])) return false;
  for (let i = 0; i < 3; ++i) {
    lo[at + i] = centre[i] - origin[i] + below[i];
    hi[at + i] = centre[i] - origin[i] + above[i];
  }
  return true;
}

/** The world box of a collider as posed; null for a half-space. */
export function worldBox(tables: Tables, collider: Collider, poses: Poses): Bounds | null {
  const lo = new Float64Array(3);
  const hi = new Float64Array(3);
  if (!writeWorldBox(lo, hi, 0, tables, collider, poses, [0, 0, 0])) return null;
  return { lo: [...lo] as Vec3, hi: [...hi] as Vec3 };
}

/** Is the collider there at the frame? */
export const isThere = (collider: Collider, frame: Frame): boolean =>
  frame.present[collider.body] === 1 && frame.number >= collider.from && frame.number < collider.to;
