/** Draws contact points as dots with a line along the normal; the colour shows the impulse. */
import {
  BufferAttribute,
  BufferGeometry,
  DynamicDrawUsage,
  Group,
  LineBasicMaterial,
  LineSegments,
  Points,
  PointsMaterial,
} from "three";
import type { Frame, Vec3 } from "../model";
import { writeLinear } from "./colours";

const heat = [0xffe9a8, 0xffb347, 0xff6a3d, 0xff2f6d];

export class ContactLayer {
  readonly group = new Group();
  private readonly dots = new BufferGeometry();
  private readonly lines = new BufferGeometry();
  private capacity = 0;

  /** `length`: of the normals, metres. */
  constructor(
    private readonly origin: Vec3,
    private readonly length: number,
  ) {
    const points = new Points(
      this.dots,
      new PointsMaterial({
        size: 6,
        sizeAttenuation: false,
        vertexColors: true,
        depthTest: false,
        transparent: true,
        fog: false,
      }),
    );
    const lines = new LineSegments(
      this.lines,
      new LineBasicMaterial({ vertexColors: true, depthTest: false, transparent: true, opacity: 0.85, fog: false }),
    );
    for (const object of [lines, points]) {
      object.frustumCulled = false;
      object.renderOrder = 6;
      this.group.add(object);
    }
    this.group.visible = false;
  }

  update(frame: Frame): void {
    if (!this.group.visible) return;
    const contacts = frame.contacts;
    const count = contacts?.impulses.length ?? 0;
    if (count > this.capacity || this.capacity === 0) this.reserve(Math.max(256, 2 * count));
    const dots = this.dots.attributes.position.array as Float32Array;
    const dotColours = this.dots.attributes.color.array as Float32Array;
    const ends = this.lines.attributes.position.array as Float32Array;
    const endColours = this.lines.attributes.color.array as Float32Array;
    let maxImpulse = 0;
    for (let i = 0; i < count; ++i) maxImpulse = Math.max(maxImpulse, contacts?.impulses[i] ?? 0);
    for (let i = 0; contacts && i < count; ++i) {
      const share = maxImpulse > 0 ? Math.sqrt(contacts.impulses[i] / maxImpulse) : 0;
      const colour = heat[Math.min(heat.length - 1, Math.floor(share * heat.length))] ?? heat[0];
      for (let k = 0; k < 3; ++k) {
        const x = contacts.points[3 * i + k] - this.origin[k];
        dots[3 * i + k] = ends[6 * i + k] = x;
        ends[6 * i + 3 + k] = x + contacts.normals[3 * i + k] * this.length * (0.4 + share);
      }
      writeLinear(dotColours, 3 * i, colour, 1);
      writeLinear(endColours, 6 * i, colour, 1);
      writeLinear(endColours, 6 * i + 3, colour, 1);
    }
    this.dots.setDrawRange(0, count);
    this.lines.setDrawRange(0, 2 * count);
    for (const geometry of [this.dots, this.lines])
      for (const name of ["position", "color"]) geometry.attributes[name].needsUpdate = true;
  }

  private reserve(count: number): void {
    this.capacity = count;
    for (const [geometry, pointsEach] of [
      [this.dots, 1],
      [this.lines, 2],
    ] as const) {
      geometry.dispose();
      for (const name of ["position", "color"])
        geometry.setAttribute(
          name,
          new BufferAttribute(new Float32Array(3 * pointsEach * count), 3).setUsage(DynamicDrawUsage),
        );
    }
  }
}
