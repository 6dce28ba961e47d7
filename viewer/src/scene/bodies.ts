/** Draws all bodies at one degree of detail: sets the matrices and colours of their parts. */
import { Group } from "three";
import type { Vec3 } from "../model";
import { type Batch, makeBatches } from "./batch";
import { type Colouring, colourOf, shadeOf, writeLinear } from "./colours";
import type { Part } from "./parts";
import type { Poses } from "./poses";

const hidden = new Float32Array(16);
const poseNumbers = 7;

/** Writes the matrix of a part in column order; positions are relative to `origin`. `margin` enlarges the part, metres. */
export function writePartMatrix(out: Float32Array, part: Part, poses: Poses, origin: Vec3, margin = 0): void {
  const b = 3 * part.body;
  const r = 4 * part.body;
  const [bx, by, bz, bw] = [poses.rotations[r], poses.rotations[r + 1], poses.rotations[r + 2], poses.rotations[r + 3]];
  const [px, py, pz] = part.pose.position;
  const [lx, ly, lz, lw] = part.pose.rotation;
  const tx = 2 * (by * pz - bz * py);
  const ty = 2 * (bz * px - bx * pz);
  const tz = 2 * (bx * py - by * px);
  const x = bw * lx + bx * lw + by * lz - bz * ly;
  const y = bw * ly - bx * lz + by * lw + bz * lx;
  const z = bw * lz + bx * ly - by * lx + bz * lw;
  const w = bw * lw - bx * lx - by * ly - bz * lz;
  const sx = part.size[0] + margin;
  const sy = part.size[1] + margin;
  const sz = part.size[2] + margin;
  out[0] = (1 - 2 * (y * y + z * z)) * sx;
  out[1] = 2 * (x * y + z * w) * sx;
  out[2] = 2 * (x * z - y * w) * sx;
  out[4] = 2 * (x * y - z * w) * sy;
  out[5] = (1 - 2 * (x * x + z * z)) * sy;
  out[6] = 2 * (y * z + x * w) * sy;
  out[8] = 2 * (x * z + y * w) * sz;
  out[9] = 2 * (y * z - x * w) * sz;
  out[10] = (1 - 2 * (x * x + y * y)) * sz;
  out[12] = poses.positions[b] - origin[0] + px + bw * tx + by * tz - bz * ty;
  out[13] = poses.positions[b + 1] - origin[1] + py + bw * ty + bz * tx - bx * tz;
  out[14] = poses.positions[b + 2] - origin[2] + pz + bw * tz + bx * ty - by * tx;
  out[3] = out[7] = out[11] = 0;
  out[15] = 1;
}

export class BodyLayer {
  readonly group = new Group();
  private readonly batches: Batch[];
  private readonly slots: { batch: Batch; slot: number }[];
  /** the last drawn pose of each body, seven numbers */
  private readonly drawn: Float64Array;
  private readonly shown: Uint8Array;
  /** current colour and shading of each part */
  private readonly keys: Int32Array;
  private readonly matrix = new Float32Array(16);
  private readonly colour = new Float32Array(3);
  private painted = "";

  /** `cells`: of simplified shapes; Infinity draws shapes as they are. */
  constructor(
    private readonly parts: Part[],
    private readonly bodyCount: number,
    private readonly origin: Vec3,
    cells: number,
  ) {
    const { batches, slots } = makeBatches(parts, cells);
    this.batches = batches;
    this.slots = slots;
    this.drawn = new Float64Array(poseNumbers * bodyCount).fill(NaN);
    this.shown = new Uint8Array(parts.length);
    this.keys = new Int32Array(parts.length).fill(-1);
    for (const { object } of batches) this.group.add(object);
  }

  /** Updates the parts of bodies that moved, appeared or disappeared since the last call. Returns whether any did. */
  update(poses: Poses): boolean {
    const moved = this.findMoved(poses);
    const number = poses.frame?.number ?? 0;
    let changed = false;
    this.parts.forEach((part, i) => {
      const { batch, slot } = this.slots[i];
      const show = poses.present[part.body] === 1 && number >= part.from && number < part.to;
      if (show ? this.shown[i] && !moved[part.body] : !this.shown[i]) return;
      if (show) writePartMatrix(this.matrix, part, poses, this.origin);
      batch.setMatrix(slot, show ? this.matrix : hidden);
      this.shown[i] = show ? 1 : 0;
      changed = true;
    });
    for (const batch of this.batches) batch.flush();
    return changed;
  }

  /** Colours all parts for the shown frame. */
  paint(poses: Poses, by: Colouring): void {
    const { frame } = poses;
    if (!frame || this.painted === `${frame.number} ${by}`) return;
    this.painted = `${frame.number} ${by}`;
    this.parts.forEach((part, i) => {
      const colour = colourOf(part.body, part.colour, frame, by);
      const isOwn = part.colour !== null && by === "material";
      const key = 2 * colour + (isOwn ? 1 : 0);
      if (key === this.keys[i]) return;
      this.keys[i] = key;
      writeLinear(this.colour, 0, colour, isOwn ? 1 : shadeOf(part.body));
      const { batch, slot } = this.slots[i];
      batch.setColour(slot, this.colour);
    });
    for (const batch of this.batches) batch.flush();
  }

  private findMoved(poses: Poses): Uint8Array {
    const moved = new Uint8Array(this.bodyCount);
    const { drawn } = this;
    const { positions, rotations } = poses;
    for (let row = 0, at = 0; row < moved.length; ++row, at += poseNumbers) {
      if (
        drawn[at] === positions[3 * row] &&
        drawn[at + 1] === positions[3 * row + 1] &&
        drawn[at + 2] === positions[3 * row + 2] &&
        drawn[at + 3] === rotations[4 * row] &&
        drawn[at + 4] === rotations[4 * row + 1] &&
        drawn[at + 5] === rotations[4 * row + 2] &&
        drawn[at + 6] === rotations[4 * row + 3]
      )
        continue;
      moved[row] = 1;
      for (let i = 0; i < 3; ++i) drawn[at + i] = positions[3 * row + i];
      for (let i = 0; i < 4; ++i) drawn[at + 3 + i] = rotations[4 * row + i];
    }
    return moved;
  }
}
