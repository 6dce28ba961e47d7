/** The list of all kinds of shapes. */
import type { Reader } from "../format/bytes";
import { box } from "./box";
import { capsule } from "./capsule";
import { cylinder } from "./cylinder";
import { halfSpace } from "./half_space";
import { sphere } from "./sphere";
import type { ShapeTraits } from "./traits";
import { convexHull, mesh } from "./triangle_shapes";

/**
 * The traits of each kind; the index of a kind is its number in a recording. To add a shape, append its traits: the
 * rest of the viewer has no code for single kinds.
 */
export const shapeKinds = [sphere, box, capsule, cylinder, convexHull, halfSpace, mesh] as const;

type ShapeOf<T> = T extends ShapeTraits<infer S> ? S : never;
/** A shape: its kind and its numbers. */
export type Shape = ShapeOf<(typeof shapeKinds)[number]>;

const byName = new Map<string, unknown>(shapeKinds.map((traits) => [traits.kind, traits]));

/** Returns the traits of the shape's kind. */
export const traitsOf = <S extends Shape>({ kind }: S): ShapeTraits<S> => byName.get(kind) as ShapeTraits<S>;

/** Reads the kind and the numbers of a shape. */
export function readShape(read: Reader): Shape {
  const kind = read.u8();
  return shapeKinds[kind]?.read(read) ?? read.fail(`found shape kind ${kind}; expected 0 to ${shapeKinds.length - 1}`);
}
