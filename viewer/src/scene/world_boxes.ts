/** Draws the world boxes of all colliders as thin lines: bright when awake, pale when asleep, grey when static. */
import {
  BufferAttribute,
  DynamicDrawUsage,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  LineSegments,
  ShaderMaterial,
} from "three";
import { flagAwake, kindOf, type Tables, type Vec3 } from "../model";
import { existsAt, writeWorldBox } from "./bounds";
import { writeLinear } from "./colours";
import type { Poses } from "./poses";

const awake = 0x6ff2e0;
const asleep = 0x86a9d8;
const still = 0xb9c2cc;

/** The 12 edges of the unit cube. */
function cubeEdges(): Float32Array {
  const edges: number[] = [];
  for (let corner = 0; corner < 8; ++corner)
    for (const bit of [1, 2, 4])
      if (!(corner & bit)) for (const c of [corner, corner | bit]) edges.push(c & 1, (c >> 1) & 1, c >> 2);
  return new Float32Array(edges);
}

export class WorldBoxes {
  readonly object: LineSegments;
  private readonly lo: InstancedBufferAttribute;
  private readonly hi: InstancedBufferAttribute;
  private readonly colour: InstancedBufferAttribute;
  private readonly opacity = { value: 1 };
  private readonly geometry = new InstancedBufferGeometry();

  constructor(
    private readonly tables: Tables,
    private readonly origin: Vec3,
  ) {
    const attribute = (name: string) => {
      const made = new InstancedBufferAttribute(new Float32Array(3 * tables.colliders.length), 3);
      made.setUsage(DynamicDrawUsage);
      this.geometry.setAttribute(name, made);
      return made;
    };
    this.geometry.setAttribute("position", new BufferAttribute(cubeEdges(), 3));
    this.lo = attribute("lo");
    this.hi = attribute("hi");
    this.colour = attribute("tint");
    const material = new ShaderMaterial({
      transparent: true,
      depthWrite: false,
      vertexShader: /* glsl */ `
                attribute vec3 lo, hi, tint;
                varying vec3 vTint;
                void main() {
                    vTint = tint;
                    gl_Position = projectionMatrix * viewMatrix * vec4(mix(lo, hi, position), 1.0);
                    gl_Position.z -= 0.0004 * gl_Position.w;
                }`,
      uniforms: { opacity: this.opacity },
      fragmentShader: /* glsl */ `
                uniform float opacity;
                varying vec3 vTint;
                void main() {
                    gl_FragColor = vec4(vTint, opacity);
                    #include <colorspace_fragment>
                }`,
    });
    this.object = new LineSegments(this.geometry, material);
    this.object.frustumCulled = false;
    this.object.visible = false;
    this.object.renderOrder = 4;
  }

  /** Does nothing while hidden. */
  update(poses: Poses): void {
    const { frame } = poses;
    if (!this.object.visible || !frame) return;
    const lo = this.lo.array as Float32Array;
    const hi = this.hi.array as Float32Array;
    let count = 0;
    for (const collider of this.tables.colliders) {
      if (!existsAt(collider, frame)) continue;
      if (!writeWorldBox(lo, hi, 3 * count, this.tables, collider, poses, this.origin)) continue;
      const flags = frame.flags[collider.body];
      const colour = kindOf(flags) === 0 ? still : flags & flagAwake ? awake : asleep;
      writeLinear(this.colour.array as Float32Array, 3 * count, colour, 1);
      ++count;
    }
    this.geometry.instanceCount = count;
    this.opacity.value = Math.max(0.4, Math.min(0.85, 14 / Math.sqrt(count + 1))); // fainter when there are many lines
    this.lo.needsUpdate = this.hi.needsUpdate = this.colour.needsUpdate = true;
  }
}
