/** Materials of bodies: matt, with rounded edges on blocks and quiet marks on round things, so that turning shows. */
import { MeshStandardMaterial } from "three";
import type { Form } from "./parts";

const vertexHead = /* glsl */ `
varying vec3 vLocal;
varying vec3 vHalf;
flat varying mat3 vTurn;
`;
const vertexBody = /* glsl */ `
vHalf = vec3(length(instanceMatrix[0].xyz), length(instanceMatrix[1].xyz), length(instanceMatrix[2].xyz));
vLocal = position * vHalf;
vTurn = mat3(instanceMatrix[0].xyz / vHalf.x, instanceMatrix[1].xyz / vHalf.y, instanceMatrix[2].xyz / vHalf.z);
vTurn = normalMatrix * vTurn;
`;
const fragmentHead = /* glsl */ `
varying vec3 vLocal;
varying vec3 vHalf;
flat varying mat3 vTurn;
vec3 sides(vec3 d) { return clamp(d / max(fwidth(d), vec3(1e-5)), -1.0, 1.0); }
`;
/** Lit like a box with rounded edges. Details smaller than a pixel fade away. */
const blockNormal = /* glsl */ `
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
`;
const stripe = /* glsl */ `
{
    float x = vLocal.x / vHalf.x;
    diffuseColor.rgb *= 1.0 - 0.2 * smoothstep(0.0, 1.5 * fwidth(x), 0.3 - abs(x));
}
`;
const marks: Partial<Record<Form, string>> = {
  ball: /* glsl */ `{ vec3 s = sides(vLocal / vHalf); diffuseColor.rgb *= 1.0 + 0.16 * s.x * s.y * s.z; }`,
  drum: /* glsl */ `{ vec3 s = sides(vLocal / vHalf); diffuseColor.rgb *= 1.0 + 0.12 * s.x * s.z; }`,
  tube: stripe,
  cap: stripe,
};

/** The material of a batch; sensors are glassy. */
export function makeMaterial(form: Form, sensor: boolean): MeshStandardMaterial {
  const material = new MeshStandardMaterial({ roughness: 0.78, metalness: 0 });
  if (sensor) {
    material.transparent = true;
    material.opacity = 0.22;
    material.depthWrite = false;
  }
  if (form === "mesh") return material;
  const detail = form === "block" ? blockNormal : (marks[form] ?? "");
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", `#include <common>\n${vertexHead}`)
      .replace("#include <begin_vertex>", `#include <begin_vertex>\n${vertexBody}`);
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", `#include <common>\n${fragmentHead}`)
      .replace("#include <normal_fragment_maps>", `#include <normal_fragment_maps>\n${detail}`);
  };
  material.customProgramCacheKey = () => `fase-${form}`;
  return material;
}
