/** Draws many parts in one call: one batch per unit geometry, one for all triangle meshes. */
import { BatchedMesh, Color, InstancedBufferAttribute, InstancedMesh, Matrix4, type Mesh } from "three";
import type { Triangles } from "../model";
import { type Form, isTriangles } from "../shapes/traits";
import { meshGeometry, unitGeometry } from "./geometries";
import { makeMaterial } from "./materials";
import { MergedBatch } from "./merged_batch";
import type { Part } from "./parts";

/** A set of parts drawn together. Slots have the order of the parts in the constructor. */
export interface Batch {
  readonly object: Mesh;
  /** sixteen numbers in column order; all 0 hides the part */
  setMatrix(slot: number, matrix: Float32Array): void;
  /** linear RGB */
  setColour(slot: number, colour: Float32Array): void;
  /** uploads the changes to the graphics card */
  flush(): void;
}

class InstancedBatch implements Batch {
  readonly object: InstancedMesh;
  private readonly matrices: Float32Array;
  private readonly colours: Float32Array;
  private moved = false;
  private coloured = false;

  constructor(form: Form, sensor: boolean, count: number) {
    this.object = new InstancedMesh(unitGeometry(form, count), makeMaterial(form, sensor), count);
    this.matrices = this.object.instanceMatrix.array as Float32Array;
    this.matrices.fill(0);
    this.colours = new Float32Array(3 * count).fill(1);
    this.object.instanceColor = new InstancedBufferAttribute(this.colours, 3);
  }
  setMatrix(slot: number, matrix: Float32Array): void {
    this.matrices.set(matrix, 16 * slot);
    this.moved = true;
  }
  setColour(slot: number, colour: Float32Array): void {
    this.colours.set(colour, 3 * slot);
    this.coloured = true;
  }
  flush(): void {
    if (this.moved) this.object.instanceMatrix.needsUpdate = true;
    if (this.coloured && this.object.instanceColor) this.object.instanceColor.needsUpdate = true;
    this.moved = this.coloured = false;
  }
}

class MeshBatch implements Batch {
  readonly object: BatchedMesh;
  private readonly matrix = new Matrix4();
  private readonly colour = new Color();
  private readonly ids: number[];

  constructor(parts: Triangles[], sensor: boolean) {
    const meshes = new Map<Triangles, ReturnType<typeof meshGeometry>>();
    for (const mesh of parts) if (!meshes.has(mesh)) meshes.set(mesh, meshGeometry(mesh));
    let vertices = 0;
    let indices = 0;
    for (const geometry of meshes.values()) {
      vertices += geometry.getAttribute("position").count;
      indices += geometry.index?.count ?? 0;
    }
    this.object = new BatchedMesh(parts.length, vertices, indices, makeMaterial(null, sensor));
    this.object.perObjectFrustumCulled = false;
    this.object.sortObjects = false;
    const geometryIds = new Map<Triangles, number>();
    for (const [mesh, geometry] of meshes) {
      geometryIds.set(mesh, this.object.addGeometry(geometry));
      geometry.dispose();
    }
    this.ids = parts.map((mesh) => this.object.addInstance(geometryIds.get(mesh) as number));
    for (const id of this.ids) this.object.setVisibleAt(id, false);
  }
  setMatrix(slot: number, matrix: Float32Array): void {
    const visible = matrix[15] !== 0;
    this.object.setVisibleAt(this.ids[slot], visible);
    if (visible) this.object.setMatrixAt(this.ids[slot], this.matrix.fromArray(matrix));
  }
  setColour(slot: number, colour: Float32Array): void {
    this.object.setColorAt(this.ids[slot], this.colour.setRGB(colour[0], colour[1], colour[2]));
  }
  flush(): void {}
}

/**
 * Groups parts into batches. `cells`: of simplified shapes; Infinity draws shapes as they are. Returns the batches, and
 * batch and slot of each part in the order of `parts`.
 */
export function makeBatches(
  parts: Part[],
  cells: number,
): { batches: Batch[]; slots: { batch: Batch; slot: number }[] } {
  const isMerged = cells !== Infinity;
  const groups = new Map<string, Part[]>();
  const keys = parts.map((part) => {
    const key = `${isMerged || isTriangles(part.form) ? "triangles" : part.form.name} ${part.sensor}`;
    const group = groups.get(key) ?? [];
    groups.set(key, group);
    return { key, slot: group.push(part) - 1 };
  });
  const made = new Map<string, Batch>();
  for (const [key, group] of groups) {
    const { form, sensor } = group[0];
    const batch = isMerged
      ? new MergedBatch(group, sensor, cells)
      : isTriangles(form)
        ? new MeshBatch(group.map((part) => part.form as Triangles), sensor)
        : new InstancedBatch(form, sensor, group.length);
    batch.object.castShadow = !sensor;
    batch.object.receiveShadow = !sensor;
    batch.object.frustumCulled = false;
    if (sensor) batch.object.renderOrder = 2;
    made.set(key, batch);
  }
  return {
    batches: [...made.values()],
    slots: keys.map(({ key, slot }) => ({ batch: made.get(key) as Batch, slot })),
  };
}
