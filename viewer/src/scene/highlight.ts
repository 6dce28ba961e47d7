/**
 * Marks what is selected. A body has a bright outline: its parts, slightly enlarged, drawn from inside. A shape among
 * others of its body is tinted and has bright edges: its neighbours would cover an outline.
 */
import {
  BackSide,
  type BufferGeometry,
  EdgesGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  type PerspectiveCamera,
} from "three";
import type { Selection, Tables, Triangles, Vec3 } from "../model";
import { isTriangles } from "../shapes/traits";
import { writePartMatrix } from "./bodies";
import { meshGeometry, unitGeometry } from "./geometries";
import { type Part, partsOfSelection } from "./parts";
import type { Poses } from "./poses";

/** width of the outline as a share of the distance to the eye */
const width = 0.0035;
const accent = 0xffb961;
const minEdgeDegrees = 20;
/** of a body with more parts, only the first are outlined */
const maxParts = 256;

type Marking = Mesh | LineSegments;

export class Highlight {
  readonly group = new Group();
  private readonly outline = new MeshBasicMaterial({ color: accent, side: BackSide, fog: false, toneMapped: false });
  private readonly tint = new MeshBasicMaterial({
    color: accent,
    transparent: true,
    opacity: 0.5,
    depthWrite: false,
    polygonOffset: true,
    polygonOffsetFactor: -1,
    polygonOffsetUnits: -4,
    fog: false,
    toneMapped: false,
  });
  private readonly edges = new LineBasicMaterial({
    color: accent,
    transparent: true,
    depthTest: false,
    fog: false,
    toneMapped: false,
  });
  private parts: Part[] = [];

  constructor(
    private readonly tables: Tables,
    private readonly all: Part[],
    private readonly origin: Vec3,
  ) {}

  /** Marks a body or one of its shapes; null: nothing. */
  show(selection: Selection | null): void {
    for (const child of this.group.children) (child as Marking).geometry.dispose();
    this.group.clear();
    const parts = selection ? partsOfSelection(this.tables, this.all, selection).slice(0, maxParts) : [];
    const isAmongOthers = selection?.shape != null && this.tables.bodies[selection.body].colliders.length > 1;
    this.parts = [];
    for (const part of parts) {
      const geometry = isTriangles(part.form) ? meshGeometry(part.form).center() : unitGeometry(part.form, 1);
      for (const marking of isAmongOthers ? this.tinted(geometry) : [new Mesh(geometry, this.outline)]) {
        marking.matrixAutoUpdate = false;
        marking.frustumCulled = false;
        this.group.add(marking);
        this.parts.push(part);
      }
    }
  }

  private tinted(geometry: BufferGeometry): Marking[] {
    const lines = new LineSegments(new EdgesGeometry(geometry, minEdgeDegrees), this.edges);
    lines.renderOrder = 5;
    return [new Mesh(geometry, this.tint), lines];
  }

  update(poses: Poses, eye: PerspectiveCamera): void {
    const number = poses.frame?.number ?? 0;
    const matrix = new Float32Array(16);
    this.parts.forEach((part, i) => {
      const marking = this.group.children[i] as Marking;
      marking.visible = poses.present[part.body] === 1 && number >= part.from && number < part.to;
      writePartMatrix(matrix, part, poses, this.origin);
      const distance = Math.hypot(
        matrix[12] - eye.position.x,
        matrix[13] - eye.position.y,
        matrix[14] - eye.position.z,
      );
      const margin = marking.material === this.outline ? distance * width : 0;
      if (isTriangles(part.form)) enlargeMesh(matrix, part.form, margin);
      else writePartMatrix(matrix, part, poses, this.origin, margin);
      marking.matrix.fromArray(matrix);
    });
  }
}

/** Enlarges a mesh about its centre and moves its matrix there, since its geometry is centred. */
function enlargeMesh(matrix: Float32Array, mesh: Triangles, margin: number): void {
  const lo = [Infinity, Infinity, Infinity];
  const hi = [-Infinity, -Infinity, -Infinity];
  mesh.vertices.forEach((x, i) => {
    lo[i % 3] = Math.min(lo[i % 3], x);
    hi[i % 3] = Math.max(hi[i % 3], x);
  });
  const middle = lo.map((x, i) => (x + hi[i]) / 2);
  const size = Math.max(1e-6, ...hi.map((x, i) => (x - lo[i]) / 2));
  for (let row = 0; row < 3; ++row)
    matrix[12 + row] += matrix[row] * middle[0] + matrix[4 + row] * middle[1] + matrix[8 + row] * middle[2];
  const factor = 1 + margin / size;
  for (let i = 0; i < 11; ++i) matrix[i] *= factor;
}
