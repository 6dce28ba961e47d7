/** A capsule: all points within `radius` of a segment of the y axis. */
import { CylinderGeometry, SphereGeometry } from "three";
import type { Vec3 } from "../model";
import { intersectCylinder, intersectSphere } from "./rays";
import { type Form, formatSize, setSymmetric, type ShapeTraits } from "./traits";

/** makes rotation about the axis visible */
const stripe = /* glsl */ `
{
    float x = vLocal.x / vHalf.x;
    diffuseColor.rgb *= 1.0 - 0.2 * smoothstep(0.0, 1.5 * fwidth(x), 0.3 - abs(x));
}
`;
const tube: Form = {
  name: "tube",
  geometry: (around) => new CylinderGeometry(1, 1, 2, around, 1, true),
  detail: stripe,
};
/** the upper half of a sphere */
const cap: Form = {
  name: "cap",
  geometry: (around) => new SphereGeometry(1, around, around * 0.3125, 0, Math.PI * 2, 0, Math.PI / 2),
  detail: stripe,
};

/** `halfLength`: of the segment; 0 is allowed */
export const capsule: ShapeTraits<{ kind: "capsule"; radius: number; halfLength: number }> = {
  kind: "capsule",
  read: (read) => {
    const radius = read.size();
    const halfLength = read.f32();
    if (!(halfLength >= 0 && halfLength < Infinity)) read.fail(`found half length ${halfLength}; expected 0 or more`);
    return { kind: "capsule", radius, halfLength };
  },
  extent: ({ radius, halfLength }, _x, y, _z, out) => setSymmetric(out, Math.abs(y) * halfLength + radius),
  radius: ({ radius, halfLength }) => radius + halfLength,
  intersect: ({ radius, halfLength }, ray) => {
    const hits = [
      intersectCylinder(ray, radius, halfLength, false),
      intersectSphere(ray, halfLength, radius),
      intersectSphere(ray, -halfLength, radius),
    ].filter((distance) => distance !== null);
    return hits.length ? Math.min(...hits) : null;
  },
  pieces: ({ radius, halfLength }) => {
    const round: Vec3 = [radius, radius, radius];
    return [
      ...(halfLength > 0 ? [{ form: tube, size: [radius, halfLength, radius] as Vec3 }] : []),
      { form: cap, size: round, position: [0, halfLength, 0] },
      { form: cap, size: round, position: [0, -halfLength, 0], rotation: [1, 0, 0, 0] },
    ];
  },
  isGround: false,
  describe: ({ radius, halfLength }) => `capsule r ${formatSize(radius)}, length ${formatSize(2 * halfLength)} m`,
};
