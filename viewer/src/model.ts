/** The data model of a recording: bodies, shapes, and their state frame by frame. */
import type { Shape } from "./shapes/list";

export type Vec3 = [number, number, number];
/** x, y, z, w */
export type Quat = [number, number, number, number];

export type BodyKind = 0 | 1 | 2;
export const kindNames = ["static", "kinematic", "dynamic"] as const;

/** Triangles, counter-clockwise from outside. */
export interface Triangles {
  vertices: Float32Array;
  normals: Float32Array | null;
  triangles: Uint32Array;
}

/** A local frame: rotates a point, then translates it. */
export interface LocalPose {
  position: Vec3;
  rotation: Quat;
}
/** One shape on a body; exists in frames [from, to). */
export interface Collider {
  body: number;
  shape: number;
  pose: LocalPose;
  sensor: boolean;
  from: number;
  to: number;
}
/** A mesh for display only. `colour` is 0xrrggbb or null. */
export interface Visual {
  body: number;
  mesh: number;
  pose: LocalPose;
  colour: number | null;
}
/** A body that exists in some frame; `index` and `generation` are its id in the world. */
export interface Body {
  index: number;
  generation: number;
  kind: BodyKind;
  user: bigint;
  mass: number;
  colour: number | null;
  name: string;
  colliders: number[];
  visuals: number[];
}
/** Data shared by all frames. */
export interface Tables {
  title: string;
  program: string;
  timeStep: number;
  gravity: Vec3;
  quantaPerMetre: number;
  hasContacts: boolean;
  stageNames: string[];
  counterNames: string[];
  shapes: Shape[];
  meshes: Triangles[];
  bodies: Body[];
  colliders: Collider[];
  visuals: Visual[];
}

export const noIsland = 0;
export const flagAwake = 1;
export const flagBroken = 2;
export const kindOf = (flags: number): BodyKind => Math.min(2, (flags >> 2) & 3) as BodyKind;

/** What a user picked: the row of a body, and the position of the hit shape in its list of colliders; null: the whole body. */
export interface Selection {
  body: number;
  shape: number | null;
}

/** Two colliders. */
export interface PairEvent {
  a: number;
  b: number;
}
export interface HitEvent extends PairEvent {
  point: Vec3;
  normal: Vec3;
  speed: number;
  impulse: number;
}
export interface FrameEvents {
  contactsBegun: PairEvent[];
  contactsEnded: PairEvent[];
  sensorsBegun: PairEvent[];
  sensorsEnded: PairEvent[];
  hits: HitEvent[];
}
/** Contact points of a frame as flat arrays: three numbers per point in `points` and `normals`, one in the others. */
export interface ContactPoints {
  points: Float64Array;
  normals: Float32Array;
  separations: Float32Array;
  impulses: Float32Array;
}
/** The state of all bodies at one frame, by body row. */
export interface Frame {
  number: number;
  /** steps of the world so far, and the seconds they simulated */
  step: number;
  time: number;
  /** 1: the body exists */
  present: Uint8Array;
  /** flagAwake, flagBroken, kindOf() */
  flags: Uint8Array;
  /** 0: none; k + 1: the island whose lowest body slot is k */
  islands: Uint32Array;
  /** metres, world frame, three per body */
  positions: Float64Array;
  /** unit quaternions x y z w, four per body */
  rotations: Float32Array;
  events: FrameEvents;
  contacts: ContactPoints | null;
}
/** Chart data of one frame. Times in milliseconds. */
export interface Summary {
  step: number;
  time: number;
  total: number;
  stages: Float32Array;
  counters: number[];
  hits: number;
  sensors: number;
  added: number;
  removed: number;
}
