/** A bright outline around the picked body: its parts, slightly enlarged, drawn from inside. */
import { BackSide, Group, Mesh, MeshBasicMaterial, type PerspectiveCamera } from "three";
import type { Triangles, Vec3 } from "../model";
import { isTriangles } from "../shapes/traits";
import { writePartMatrix } from "./bodies";
import { meshGeometry, unitGeometry } from "./geometries";
import type { Part } from "./parts";
import type { Poses } from "./poses";

/** width of the outline as a share of the distance to the eye */
const width = 0.0035;

export class Highlight {
  readonly group = new Group();
  private readonly material = new MeshBasicMaterial({ color: 0xffb961, side: BackSide, fog: false, toneMapped: false });
  private parts: Part[] = [];

  constructor(
    private readonly all: Part[],
    private readonly origin: Vec3,
  ) {}

  /** Outlines a body; null: none. */
  show(row: number | null): void {
    for (const child of this.group.children) (child as Mesh).geometry.dispose();
    this.group.clear();
    this.parts = row === null ? [] : this.all.filter((part) => part.body === row);
    for (const part of this.parts) {
      const geometry = isTriangles(part.form) ? meshGeometry(part.form).center() : unitGeometry(part.form, 1);
      const mesh = new Mesh(geometry, this.material);
      mesh.matrixAutoUpdate = false;
      mesh.frustumCulled = false;
      this.group.add(mesh);
    }
  }

  update(poses: Poses, eye: PerspectiveCamera): void {
    const number = poses.frame?.number ?? 0;
    const matrix = new Float32Array(16);
    this.parts.forEach((part, i) => {
      const mesh = this.group.children[i] as Mesh;
      mesh.visible = poses.present[part.body] === 1 && number >= part.from && number < part.to;
      writePartMatrix(matrix, part, poses, this.origin);
      const distance = Math.hypot(
        matrix[12] - eye.position.x,
        matrix[13] - eye.position.y,
        matrix[14] - eye.position.z,
      );
      if (isTriangles(part.form)) enlargeMesh(matrix, part.form, distance * width);
      else writePartMatrix(matrix, part, poses, this.origin, distance * width);
      mesh.matrix.fromArray(matrix);
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
