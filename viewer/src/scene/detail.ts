/** All bodies at several degrees of detail, of which one is shown. */
import { Group } from "three";
import type { Tables, Triangles, Vec3 } from "../model";
import { type Form, isTriangles } from "../shapes/traits";
import { BodyLayer } from "./bodies";
import type { Colouring } from "./colours";
import { unitGeometry } from "./geometries";
import { coarseShapes } from "./merged_batch";
import { makeParts, type Part } from "./parts";
import type { Poses } from "./poses";

/** cells along each axis of a simplified shape (simplify.ts), by degree of detail; the first draws shapes as they are */
const cells = [Infinity, 5, 3, 2];
export const coarsest = cells.length - 1;

export class DetailedBodies {
  readonly group = new Group();
  readonly parts: Part[];
  private readonly layers: BodyLayer[] = [];
  private detail = 0;

  constructor(
    private readonly tables: Tables,
    private readonly origin: Vec3,
  ) {
    this.parts = makeParts(tables);
  }

  /** Shows the bodies at a degree of detail, 0 to `coarsest`. Returns whether the picture changes. */
  show(poses: Poses, by: Colouring, detail = this.detail): boolean {
    const isOther = detail !== this.detail || this.layers.length === 0;
    this.detail = detail;
    const layer = (this.layers[detail] ??= new BodyLayer(
      this.parts,
      this.tables.bodies.length,
      this.origin,
      cells[detail],
    ));
    if (isOther) this.group.clear().add(layer.group);
    const isMoved = layer.update(poses);
    layer.paint(poses, by);
    return isOther || isMoved;
  }

  /** Returns the number of triangles of all parts at a degree of detail. */
  trianglesAt(detail: number): number {
    if (detail > 0)
      return coarseShapes(this.parts, cells[detail]).reduce((sum, { triangles }) => sum + triangles.length / 3, 0);
    const counts = new Map<Form | Triangles, number>();
    for (const { form } of this.parts) counts.set(form, (counts.get(form) ?? 0) + 1);
    let sum = 0;
    for (const [form, count] of counts) sum += count * trianglesOf(form, count);
    return sum;
  }
}

function trianglesOf(form: Form | Triangles, count: number): number {
  if (isTriangles(form)) return form.triangles.length / 3;
  const geometry = unitGeometry(form, count);
  geometry.dispose();
  return (geometry.index?.count ?? 0) / 3;
}
