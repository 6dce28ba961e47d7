/** What the viewer must know about a kind of shape. */
import type { BufferGeometry } from "three";
import type { Reader } from "../format/bytes";
import type { Quat, Triangles, Vec3 } from "../model";

export interface Ray {
  origin: Vec3;
  /** unit */
  direction: Vec3;
}

/** A unit geometry, which extends from -1 to 1 along its axes. One draw call draws all parts with the same form. */
export interface Form {
  /** unique; names the shader program */
  name: string;
  /** `around`: number of segments of a full circle */
  geometry(around: number): BufferGeometry;
  /**
   * GLSL that changes `normal` and `diffuseColor` of a fragment. It can use vLocal (position in metres), vHalf (half
   * sizes in metres), vTurn (rotation from part to eye) and sides() of materials.ts.
   */
  detail: string;
}

/** A piece of a shape as it is drawn: a scaled unit geometry or triangles, with its pose in the shape's frame. */
export interface Piece {
  form: Form | Triangles;
  /** scale along the axes of the form */
  size: Vec3;
  /** default: the origin */
  position?: Vec3;
  /** default: none */
  rotation?: Quat;
}
export const isTriangles = (form: Form | Triangles): form is Triangles => "triangles" in form;

/** The traits of one kind of shape. All functions work in the shape's frame, in metres. */
export interface ShapeTraits<S extends { kind: string }> {
  kind: S["kind"];
  /** Reads the numbers that follow the kind in a recording (fase/record/format.md, SHAP). Fails on invalid numbers. */
  read(read: Reader): S;
  /**
   * Sets `out` to the least and greatest coordinate of the shape along the unit axis (x, y, z); -Infinity and Infinity
   * if it is unbounded. Called thousands of times per picture: must not allocate.
   */
  extent(shape: S, x: number, y: number, z: number, out: Float64Array): void;
  /** Returns the radius of the smallest sphere around the origin that contains the shape; Infinity if it is unbounded. */
  radius(shape: S): number;
  /** Returns the distance at which a ray enters the shape; 0: it starts inside; null: no hit. */
  intersect(shape: S, ray: Ray): number | null;
  /** Returns what is drawn. */
  pieces(shape: S): Piece[];
  /** Whether it is drawn as the ground in its plane y = 0, instead of pieces, and cannot be selected. */
  isGround: boolean;
  /** Returns a label with sizes, for the panel of a body. */
  describe(shape: S): string;
}

/** Sets the extent of a shape that is symmetric about its origin. */
export function setSymmetric(out: Float64Array, half: number): void {
  out[0] = -half;
  out[1] = half;
}

/** Formats metres with three digits. */
export const formatSize = (x: number): string => Number(x.toPrecision(3)).toString();
