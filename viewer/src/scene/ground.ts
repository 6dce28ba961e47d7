/** The ground: a large plane with a grid that fades with distance. Solid where the recording has a half-space. */
import { DoubleSide, type Matrix4, Mesh, MeshStandardMaterial, PlaneGeometry } from "three";

const minReach = 3000; // metres

const gridHead = /* glsl */ `
varying vec2 vGrid;
float gridLines(vec2 at, float cell) {
    vec2 wide = fwidth(at / cell);
    vec2 off = abs(fract(at / cell - 0.5) - 0.5) / max(wide, vec2(1e-6));
    float fade = 1.0 - smoothstep(0.15, 0.5, max(wide.x, wide.y));
    return (1.0 - min(min(off.x, off.y), 1.0)) * fade;
}
`;
const gridBody = /* glsl */ `
vec2 middle = vGrid / glow;
float fine = gridLines(vGrid, gridCell);
float coarse = gridLines(vGrid, gridCell * 10.0);
diffuseColor.rgb *= 0.82 + 0.3 * exp(-dot(middle, middle));
diffuseColor.rgb = mix(diffuseColor.rgb, vec3(0.85, 0.93, 1.0), 0.08 * fine + 0.15 * coarse);
`;
const lineAlpha = /* glsl */ `diffuseColor.a = 0.05 + 0.35 * max(fine, coarse);`;

/** Creates the ground. `solid`: opaque; else only lines, for scenes without ground. Lines every `cell` m; lighter within `glow` m. */
export function makeGround(matrix: Matrix4, solid: boolean, cell: number, glow: number): Mesh {
  const material = new MeshStandardMaterial({ color: 0x76838f, roughness: 0.95, metalness: 0 });
  if (!solid) {
    material.transparent = true;
    material.depthWrite = false;
    material.side = DoubleSide;
  }
  material.onBeforeCompile = (shader) => {
    shader.uniforms.gridCell = { value: cell };
    shader.uniforms.glow = { value: glow };
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", "#include <common>\nvarying vec2 vGrid;")
      .replace("#include <begin_vertex>", "#include <begin_vertex>\nvGrid = position.xz;");
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", `#include <common>\nuniform float gridCell, glow;\n${gridHead}`)
      .replace("#include <color_fragment>", `#include <color_fragment>\n${gridBody}\n${solid ? "" : lineAlpha}`);
  };
  material.customProgramCacheKey = () => `fase-ground-${solid}`;
  // Surfaces at the height of the ground hide it.
  material.polygonOffset = true;
  material.polygonOffsetFactor = 4;
  material.polygonOffsetUnits = 16;
  const reach = Math.max(minReach, 20 * glow);
  const geometry = new PlaneGeometry(2 * reach, 2 * reach, 1, 1);
  geometry.rotateX(-Math.PI / 2);
  const ground = new Mesh(geometry, material);
  ground.matrixAutoUpdate = false;
  ground.matrix.copy(matrix);
  ground.receiveShadow = true;
  ground.frustumCulled = false;
  return ground;
}
