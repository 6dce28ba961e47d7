/** A sphere around the origin. */
import { SphereGeometry } from "three";
import { intersectSphere } from "./rays";
import { type Form, formatSize, setSymmetric, type ShapeTraits } from "./traits";

/** with faint marks, so that rotation is visible */
const form: Form = {
  name: "sphere",
  geometry: (around) => new SphereGeometry(1, around, around * 0.625),
  detail: /* glsl */ `{ vec3 s = sides(vLocal / vHalf); diffuseColor.rgb *= 1.0 + 0.16 * s.x * s.y * s.z; }`,
};

export const sphere: ShapeTraits<{ kind: "sphere"; radius: number }> = {
  kind: "sphere",
  read: (read) => ({ kind: "sphere", radius: read.size() }),
  extent: ({ radius }, _x, _y, _z, out) => setSymmetric(out, radius),
  radius: ({ radius }) => radius,
  intersect: ({ radius }, ray) => intersectSphere(ray, 0, radius),
  pieces: ({ radius }) => [{ form, size: [radius, radius, radius] }],
  isGround: false,
  describe: ({ radius }) => `sphere r ${formatSize(radius)} m`,
};
