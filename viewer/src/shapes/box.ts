/** A box around the origin. */
import { BoxGeometry } from "three";
import type { Vec3 } from "../model";
import { slab } from "./rays";
import { type Form, formatSize, type Ray, setSymmetric, type ShapeTraits } from "./traits";

/** with rounded edges; details smaller than a pixel fade out */
const form: Form = {
  name: "box",
  geometry: () => new BoxGeometry(2, 2, 2),
  detail: /* glsl */ `
{
    float bevel = min(0.14 * min(vHalf.x, min(vHalf.y, vHalf.z)), 0.08 * max(vHalf.x, max(vHalf.y, vHalf.z)));
    vec3 past = max(abs(vLocal) - (vHalf - bevel), 0.0);
    vec3 grain = fwidth(vLocal);
    float detail = smoothstep(0.4, 1.6, bevel / max(grain.x, max(grain.y, grain.z)));
    vec3 rounded = normalize(vTurn * (sign(vLocal) * past + 1e-6));
    normal = normalize(mix(normal, rounded, detail));
    vec3 depth = 1.0 - past / bevel;
    float inner = min(max(depth.x, depth.y), min(max(depth.y, depth.z), max(depth.x, depth.z)));
    diffuseColor.rgb *= mix(1.0, 0.8 + 0.2 * smoothstep(0.0, 0.9, inner), detail);
}
`,
};

export const box: ShapeTraits<{ kind: "box"; half: Vec3 }> = {
  kind: "box",
  read: (read) => ({ kind: "box", half: [read.size(), read.size(), read.size()] }),
  extent: ({ half }, x, y, z, out) =>
    setSymmetric(out, Math.abs(x) * half[0] + Math.abs(y) * half[1] + Math.abs(z) * half[2]),
  radius: ({ half }) => Math.hypot(...half),
  intersect: ({ half }, ray) => intersectBox(ray, half),
  pieces: ({ half }) => [{ form, size: half }],
  isGround: false,
  describe: ({ half }) => `box ${half.map((x) => formatSize(2 * x)).join(" × ")} m`,
};

function intersectBox({ origin, direction }: Ray, half: Vec3): number | null {
  let enter = 0;
  let leave = Infinity;
  for (let i = 0; i < 3; ++i) {
    const span = slab(origin[i], direction[i], half[i]);
    if (!span) return null;
    enter = Math.max(enter, span[0]);
    leave = Math.min(leave, span[1]);
  }
  return enter <= leave ? enter : null;
}
