/** What the viewer knows of a recording: bodies, their shapes, and their state frame by frame. */

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
export type Shape =
  | { kind: "sphere"; radius: number }
  | { kind: "box"; half: Vec3 }
  | { kind: "capsule"; radius: number; halfLength: number }
  | { kind: "cylinder"; radius: number; halfHeight: number }
  | { kind: "convex hull"; mesh: Triangles }
  | { kind: "half-space" }
  | { kind: "mesh"; mesh: Triangles };

/** A frame inside another: turns a point first, then moves it. */
export interface LocalPose {
  position: Vec3;
  rotation: Quat;
}
/** One shape on a body, there in frames [from, to). */
export interface Collider {
  body: number;
  shape: number;
  pose: LocalPose;
  sensor: boolean;
  from: number;
  to: number;
}
/** A mesh for the picture. `colour` is 0xrrggbb or null. */
export interface Visual {
  body: number;
  mesh: number;
  pose: LocalPose;
  colour: number | null;
}
/** One body that lived at any time; `index` and `generation` are its id in the world. */
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
/** What is the same in all frames. */
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
/** Contact points of a frame, flat: three numbers a point in `points` and `normals`, one in `impulses`. */
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
  /** 1 where the body lives */
  present: Uint8Array;
  /** flagAwake, flagBroken, kindOf() */
  flags: Uint8Array;
  /** 0: none; k + 1: the island whose least body slot is k */
  islands: Uint32Array;
  /** metres, world, three a body */
  positions: Float64Array;
  /** unit quaternions x y z w, four a body */
  rotations: Float32Array;
  events: FrameEvents;
  contacts: ContactPoints | null;
}
/** What the charts show of one frame. Milliseconds. */
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
