/** Materials of bodies: matt, with the details of their form. */
import { type Material, MeshLambertMaterial, MeshStandardMaterial } from "three";
import type { Form } from "../shapes/traits";

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

/** Creates the material of a batch; `form` null: of triangles. Sensors are transparent. */
export function makeMaterial(form: Form | null, sensor: boolean): MeshStandardMaterial {
  const material = new MeshStandardMaterial({ roughness: 0.78, metalness: 0 });
  if (sensor) makeTransparent(material);
  if (!form) return material;
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", `#include <common>\n${vertexHead}`)
      .replace("#include <begin_vertex>", `#include <begin_vertex>\n${vertexBody}`);
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", `#include <common>\n${fragmentHead}`)
      .replace("#include <normal_fragment_maps>", `#include <normal_fragment_maps>\n${form.detail}`);
  };
  material.customProgramCacheKey = () => `fase-${form.name}`;
  return material;
}

/** Creates the material of simplified shapes: cheap, one normal per triangle, colours by vertex. */
export function makeCoarseMaterial(sensor: boolean): MeshLambertMaterial {
  const material = new MeshLambertMaterial({ flatShading: true, vertexColors: true });
  if (sensor) makeTransparent(material);
  return material;
}

function makeTransparent(material: Material): void {
  material.transparent = true;
  material.opacity = 0.22;
  material.depthWrite = false;
}
