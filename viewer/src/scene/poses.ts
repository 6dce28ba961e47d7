/** The displayed poses by body row, interpolated between two frames. */
import { type Frame, flagAwake } from "../model";

export class Poses {
  readonly present: Uint8Array;
  readonly positions: Float64Array;
  readonly rotations: Float32Array;
  /** the first of the two frames; flags, islands and events come from it */
  frame: Frame | null = null;

  constructor(readonly count: number) {
    this.present = new Uint8Array(count);
    this.positions = new Float64Array(3 * count);
    this.rotations = new Float32Array(4 * count);
  }

  isAwake(row: number): boolean {
    return this.frame !== null && (this.frame.flags[row] & flagAwake) !== 0;
  }

  /** Interpolates all poses from frame `a` (share 0) to `b` (share 1). Bodies that are missing in b keep the pose in a. */
  mix(a: Frame, b: Frame, share: number): void {
    this.frame = a;
    this.present.set(a.present);
    this.positions.set(a.positions);
    this.rotations.set(a.rotations);
    if (share <= 0 || a === b) return;
    const { positions, rotations } = this;
    for (let row = 0; row < this.count; ++row) {
      if (!a.present[row] || !b.present[row]) continue;
      for (let i = 3 * row; i < 3 * row + 3; ++i) positions[i] += (b.positions[i] - positions[i]) * share;
      const q = 4 * row;
      const r = b.rotations;
      const sameSide =
        rotations[q] * r[q] + rotations[q + 1] * r[q + 1] + rotations[q + 2] * r[q + 2] + rotations[q + 3] * r[q + 3] >=
        0;
      const sign = sameSide ? share : -share;
      let squares = 0;
      for (let i = q; i < q + 4; ++i) {
        rotations[i] = rotations[i] * (1 - share) + r[i] * sign;
        squares += rotations[i] * rotations[i];
      }
      const norm = 1 / Math.sqrt(squares || 1);
      for (let i = q; i < q + 4; ++i) rotations[i] *= norm;
    }
  }
}
