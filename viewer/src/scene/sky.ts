/** The sky: a gradient around the scene, lighter at the horizon, where it blends with the fog. */
import { BackSide, Color, Mesh, ShaderMaterial, SphereGeometry } from "three";

export const horizon = new Color(0xbccbdb);
const zenith = new Color(0x3f6ea6);
const below = new Color(0x7f8c9a);

export function makeSky(): Mesh {
  const material = new ShaderMaterial({
    side: BackSide,
    depthWrite: false,
    depthTest: false,
    fog: false,
    toneMapped: false,
    uniforms: { horizon: { value: horizon }, zenith: { value: zenith }, below: { value: below } },
    vertexShader: /* glsl */ `
            varying vec3 vDirection;
            void main() {
                vDirection = position;
                vec4 at = projectionMatrix * vec4(mat3(viewMatrix) * position, 1.0);
                gl_Position = at.xyww;
            }`,
    fragmentShader: /* glsl */ `
            uniform vec3 horizon, zenith, below;
            varying vec3 vDirection;
            void main() {
                float up = normalize(vDirection).y;
                float away = 1.0 - pow(1.0 - abs(up), up > 0.0 ? 2.6 : 8.0);
                vec3 colour = mix(horizon, up > 0.0 ? zenith : below, away);
                // noise hides the banding of 8-bit colour
                float noise = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453);
                gl_FragColor = vec4(colour + (noise - 0.5) / 255.0, 1.0);
                #include <colorspace_fragment>
            }`,
  });
  const sky = new Mesh(new SphereGeometry(1, 32, 24), material);
  sky.frustumCulled = false;
  sky.renderOrder = -10;
  return sky;
}
