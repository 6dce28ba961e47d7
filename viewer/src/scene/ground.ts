/** The ground: a wide plane with a fine grid that fades with distance. Solid where the recording has a half-space. */
import { DoubleSide, type Matrix4, Mesh, MeshStandardMaterial, PlaneGeometry } from "three";

const reach = 3000;

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
float fine = gridLines(vGrid, gridCell);
float coarse = gridLines(vGrid, gridCell * 10.0);
diffuseColor.rgb = mix(diffuseColor.rgb, vec3(1.0), 0.10 * fine + 0.16 * coarse);
`;
const airyAlpha = /* glsl */ `diffuseColor.a = 0.05 + 0.35 * max(fine, coarse);`;

/** `solid`: opaque ground; else lines in the air, for recordings without ground. `cell` in metres. */
export function makeGround(matrix: Matrix4, solid: boolean, cell: number): Mesh {
    const material = new MeshStandardMaterial({ color: 0x6f7c88, roughness: 0.95, metalness: 0 });
    if (!solid) {
        material.transparent = true;
        material.depthWrite = false;
        material.side = DoubleSide;
    }
    material.onBeforeCompile = (shader) => {
        shader.uniforms.gridCell = { value: cell };
        shader.vertexShader = shader.vertexShader
            .replace("#include <common>", "#include <common>\nvarying vec2 vGrid;")
            .replace("#include <begin_vertex>", "#include <begin_vertex>\nvGrid = position.xz;");
        shader.fragmentShader = shader.fragmentShader
            .replace("#include <common>", `#include <common>\nuniform float gridCell;\n${gridHead}`)
            .replace("#include <color_fragment>", `#include <color_fragment>\n${gridBody}\n${solid ? "" : airyAlpha}`);
    };
    material.customProgramCacheKey = () => `fase-ground-${solid}`;
    const geometry = new PlaneGeometry(2 * reach, 2 * reach, 1, 1);
    geometry.rotateX(-Math.PI / 2);
    const ground = new Mesh(geometry, material);
    ground.matrixAutoUpdate = false;
    ground.matrix.copy(matrix);
    ground.receiveShadow = true;
    ground.frustumCulled = false;
    return ground;
}
