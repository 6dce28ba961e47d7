/**
 * Draws many parts as one mesh that the processor transforms. Without a graphics card this is faster than one mesh per
 * part: each instance costs as much as dozens of triangles.
 */
import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Mesh } from "three";
import type { Triangles } from "../model";
import type { Form } from "../shapes/traits";
import type { Batch } from "./batch";
import { coarseTriangles } from "./geometries";
import { makeCoarseMaterial } from "./materials";
import type { Part } from "./parts";

/** Returns the simplified shape of each part. What is static stays as it is: a level would fall to pieces. */
export function coarseShapes(parts: Part[], cells: number): Triangles[] {
  const moving = new Map<Form | Triangles, Triangles>();
  const fixed = new Map<Form | Triangles, Triangles>();
  return parts.map(({ form, isStatic }) => {
    const made = isStatic ? fixed : moving;
    let shape = made.get(form);
    if (!shape) made.set(form, (shape = coarseTriangles(form, isStatic ? Infinity : cells)));
    return shape;
  });
}

export class MergedBatch implements Batch {
  readonly object: Mesh;
  private readonly shapes: Triangles[];
  /** the first vertex of each part */
  private readonly first: Uint32Array;
  private readonly positions: BufferAttribute;
  private readonly colours: BufferAttribute;

  /** `cells`: of the simplified shapes */
  constructor(parts: Part[], sensor: boolean, cells: number) {
    this.shapes = coarseShapes(parts, cells);
    this.first = new Uint32Array(parts.length + 1);
    this.shapes.forEach(({ vertices }, i) => (this.first[i + 1] = this.first[i] + vertices.length / 3));
    const count = this.first[parts.length];
    this.positions = new BufferAttribute(new Float32Array(3 * count), 3).setUsage(DynamicDrawUsage);
    this.colours = new BufferAttribute(new Float32Array(3 * count).fill(1), 3).setUsage(DynamicDrawUsage);
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", this.positions);
    geometry.setAttribute("color", this.colours);
    geometry.setIndex(new BufferAttribute(this.joinTriangles(), 1));
    this.object = new Mesh(geometry, makeCoarseMaterial(sensor));
  }

  setMatrix(slot: number, m: Float32Array): void {
    const { vertices } = this.shapes[slot];
    const out = this.positions.array;
    for (let from = 0, to = 3 * this.first[slot]; from < vertices.length; from += 3, to += 3) {
      const x = vertices[from];
      const y = vertices[from + 1];
      const z = vertices[from + 2];
      out[to] = m[0] * x + m[4] * y + m[8] * z + m[12];
      out[to + 1] = m[1] * x + m[5] * y + m[9] * z + m[13];
      out[to + 2] = m[2] * x + m[6] * y + m[10] * z + m[14];
    }
    this.positions.needsUpdate = true;
  }
  setColour(slot: number, colour: Float32Array): void {
    for (let vertex = this.first[slot]; vertex < this.first[slot + 1]; ++vertex)
      this.colours.array.set(colour, 3 * vertex);
    this.colours.needsUpdate = true;
  }
  flush(): void {}

  private joinTriangles(): Uint32Array {
    const all = new Uint32Array(this.shapes.reduce((sum, { triangles }) => sum + triangles.length, 0));
    let at = 0;
    this.shapes.forEach(({ triangles }, i) => {
      for (const vertex of triangles) all[at++] = this.first[i] + vertex;
    });
    return all;
  }
}
