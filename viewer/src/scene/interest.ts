/** The box that the camera shows at first: the bounds of most moving bodies. */
import type { Tables, Vec3 } from "../model";
import { type Bounds, existsAt, worldBox } from "./bounds";
import type { Poses } from "./poses";

/** outliers are ignored from this number of boxes on */
const minForOutliers = 20;
const outlierShare = 0.02;
const marginShare = 0.4;

const join = (boxes: Bounds[]): Bounds => ({
  lo: [0, 1, 2].map((i) => boxes.reduce((lo, box) => Math.min(lo, box.lo[i]), Infinity)) as Vec3,
  hi: [0, 1, 2].map((i) => boxes.reduce((hi, box) => Math.max(hi, box.hi[i]), -Infinity)) as Vec3,
});
const size = (box: Bounds) => Math.hypot(...box.hi.map((x, i) => x - box.lo[i]));

/** Removes boxes far outside the range of most boxes. */
function withoutOutliers(boxes: Bounds[]): Bounds[] {
  if (boxes.length < minForOutliers) return boxes;
  const spans = [0, 1, 2].map((i) => {
    const middles = boxes.map(({ lo, hi }) => (lo[i] + hi[i]) / 2).sort((a, b) => a - b);
    const few = Math.floor(middles.length * outlierShare);
    const [from, to] = [middles[few], middles[middles.length - 1 - few]];
    const margin = marginShare * (to - from) + 1e-3;
    return [from - margin, to + margin];
  });
  return boxes.filter(({ lo, hi }) => spans.every(([from, to], i) => hi[i] >= from && lo[i] <= to));
}

/** Returns the bounds of moving bodies without outliers; includes static bodies unless that is much larger. */
export function boundsOfInterest(tables: Tables, poses: Poses): Bounds {
  const moving: Bounds[] = [];
  const fixed: Bounds[] = [];
  for (const collider of tables.colliders) {
    if (!poses.frame || !existsAt(collider, poses.frame) || collider.sensor) continue;
    const box = worldBox(tables, collider, poses);
    if (box) (tables.bodies[collider.body].kind === 0 ? fixed : moving).push(box);
  }
  if (moving.length + fixed.length === 0) return { lo: [-2, 0, -2], hi: [2, 2, 2] };
  if (moving.length === 0) return join(fixed);
  const middle = join(withoutOutliers(moving));
  const all = join([middle, ...fixed]);
  return size(all) > 2 * size(middle) ? middle : all;
}
