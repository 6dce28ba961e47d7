/** A bright rim round the picked body: its parts again, a little larger, seen from inside. */
import { BackSide, Group, Mesh, MeshBasicMaterial, type PerspectiveCamera } from "three";
import type { Vec3 } from "../model";
import { writePartMatrix } from "./bodies";
import { meshGeometry, unitGeometry } from "./geometries";
import type { Part } from "./parts";
import type { Poses } from "./poses";

/** width of the rim as a share of the distance to the eye */
const width = 0.0035;

export class Highlight {
  readonly group = new Group();
  private readonly material = new MeshBasicMaterial({ color: 0xffb961, side: BackSide, fog: false, toneMapped: false });
  private parts: Part[] = [];

  constructor(
    private readonly all: Part[],
    private readonly origin: Vec3,
  ) {}

  /** Which body has the rim; null: none. */
  show(row: number | null): void {
    for (const child of this.group.children) (child as Mesh).geometry.dispose();
    this.group.clear();
    this.parts = row === null ? [] : this.all.filter((part) => part.body === row);
    for (const part of this.parts) {
      const geometry =
        part.form === "mesh" && part.mesh ? meshGeometry(part.mesh) : unitGeometry(part.form as "block", 1);
      if (part.form === "mesh") geometry.center();
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
      if (part.form === "mesh") growMesh(matrix, part, distance * width);
      else writePartMatrix(matrix, part, poses, this.origin, distance * width);
      mesh.matrix.fromArray(matrix);
    });
  }
}

/** A mesh grows about its middle: its geometry was centred, so its place is moved there. */
function growMesh(matrix: Float32Array, part: Part, by: number): void {
  const lo = [Infinity, Infinity, Infinity];
  const hi = [-Infinity, -Infinity, -Infinity];
  part.mesh?.vertices.forEach((x, i) => {
    lo[i % 3] = Math.min(lo[i % 3], x);
    hi[i % 3] = Math.max(hi[i % 3], x);
  });
  const middle = lo.map((x, i) => (x + hi[i]) / 2);
  const size = Math.max(1e-6, ...hi.map((x, i) => (x - lo[i]) / 2));
  for (let row = 0; row < 3; ++row)
    matrix[12 + row] += matrix[row] * middle[0] + matrix[4 + row] * middle[1] + matrix[8 + row] * middle[2];
  const grown = 1 + by / size;
  for (let i = 0; i < 11; ++i) matrix[i] *= grown;
}
