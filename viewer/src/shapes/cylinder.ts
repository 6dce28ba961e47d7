/** A cylinder around the y axis. */
import { CylinderGeometry } from "three";
import { intersectCylinder } from "./rays";
import { type Form, formatSize, setSymmetric, type ShapeTraits } from "./traits";

/** with faint marks, so that rotation is visible */
const form: Form = {
  name: "cylinder",
  geometry: (around) => new CylinderGeometry(1, 1, 2, around),
  detail: /* glsl */ `{ vec3 s = sides(vLocal / vHalf); diffuseColor.rgb *= 1.0 + 0.12 * s.x * s.z; }`,
};

export const cylinder: ShapeTraits<{ kind: "cylinder"; radius: number; halfHeight: number }> = {
  kind: "cylinder",
  read: (read) => ({ kind: "cylinder", radius: read.size(), halfHeight: read.size() }),
  extent: ({ radius, halfHeight }, _x, y, _z, out) =>
    setSymmetric(out, Math.abs(y) * halfHeight + Math.sqrt(Math.max(0, 1 - y * y)) * radius),
  radius: ({ radius, halfHeight }) => Math.hypot(radius, halfHeight),
  intersect: ({ radius, halfHeight }, ray) => intersectCylinder(ray, radius, halfHeight, true),
  pieces: ({ radius, halfHeight }) => [{ form, size: [radius, halfHeight, radius] }],
  isGround: false,
  describe: ({ radius, halfHeight }) => `cylinder r ${formatSize(radius)}, height ${formatSize(2 * halfHeight)} m`,
};
