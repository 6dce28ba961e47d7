/** A half-space: all points with y <= 0. */
import type { ShapeTraits } from "./traits";

export const halfSpace: ShapeTraits<{ kind: "half-space" }> = {
  kind: "half-space",
  read: () => ({ kind: "half-space" }),
  extent: (_shape, _x, _y, _z, out) => {
    out[0] = -Infinity;
    out[1] = Infinity;
  },
  radius: () => Infinity,
  intersect: (_shape, { origin, direction }) => {
    if (origin[1] <= 0) return 0;
    return direction[1] < 0 ? -origin[1] / direction[1] : null;
  },
  pieces: () => [],
  isGround: true,
  describe: () => "half-space",
};
