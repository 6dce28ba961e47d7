/** Recordings for the tests: a wall that a ball breaks, with every shape and event at least once. */
import { hash01 } from "../src/scene/maths";
import type { Quat, Vec3 } from "../src/model";
import type { Shape } from "../src/shapes/list";
import {
  type BodyInput,
  type BodyRow,
  type ContactInput,
  FrameEncoder,
  type FrameInput,
  type Packer,
  bodies,
  chunk,
  colliders,
  type ColliderRow,
  fileHeader,
  head,
  join,
  meshes,
  plain,
  shapes,
  visuals,
} from "./encode";
import { octahedron } from "./shapes";

export const quanta = 2048;
const timeStep = 1 / 60;
const gravity = 9.81;

interface Actor extends Omit<BodyRow, "index" | "generation" | "user"> {
  shape: number;
  sensor?: boolean;
  mesh?: number;
  half: number;
  start: Vec3;
  /** when it starts to move, its velocity and spin; null: it does not move */
  free: { at: number; velocity: Vec3; spin: Vec3 } | null;
  /** seconds [from, to) in which it exists */
  exists?: [number, number];
}

const rotationAbout = (axis: Vec3, angle: number): Quat => {
  const length = Math.hypot(...axis) || 1;
  const s = Math.sin(angle / 2) / length;
  return [axis[0] * s, axis[1] * s, axis[2] * s, Math.cos(angle / 2)];
};

const table: Shape[] = [
  { kind: "half-space" },
  { kind: "box", half: [0.5, 0.25, 0.3] },
  { kind: "sphere", radius: 0.6 },
  { kind: "capsule", radius: 0.25, halfLength: 0.4 },
  { kind: "cylinder", radius: 0.4, halfHeight: 0.5 },
  { kind: "convex hull", mesh: octahedron(0.6) },
  { kind: "box", half: [2, 1, 0.05] },
  { kind: "box", half: [0.3, 0.3, 0.3] },
];

function wall(columns: number, courses: number): Actor[] {
  const actors: Actor[] = [];
  for (let course = 0; course < courses; ++course)
    for (let column = 0; column < columns; ++column) {
      const n = actors.length;
      const x = (column - columns / 2 + (course % 2) * 0.5) * 1.01;
      const y = 0.25 + course * 0.5;
      const nearness = Math.hypot(x, y - 3);
      const speed = Math.max(0, 9 - 1.6 * nearness) * (0.6 + 0.8 * hash01(n));
      actors.push({
        kind: 2,
        mass: 480,
        colour: null,
        name: "",
        shape: 1,
        half: 0.25,
        start: [x, y, 0],
        free:
          nearness > 5
            ? null
            : {
                at: 1.2 + nearness * 0.03,
                velocity: [x * 0.8, 2 * hash01(n + 9), -speed],
                spin: [hash01(n + 1) - 0.5, hash01(n + 2) - 0.5, hash01(n + 3) - 0.5].map((c) => 9 * c) as Vec3,
              },
      });
    }
  return actors;
}

/** Where shape `n` of the body "level" is, relative to the body. */
export const tileAt = (n: number): Vec3 => [(n % 40) * 0.61, 0, Math.floor(n / 40) * 0.61];

function cast(columns: number, courses: number, tiles: number): Actor[] {
  const still = { kind: 2, mass: 100, colour: null, half: 0.5, free: null };
  const fall = (spin: Vec3) => ({ at: 0, velocity: [0, 0, 0] as Vec3, spin });
  return [
    { ...still, kind: 0, mass: 0, name: "ground", shape: 0, start: [0, 0, 0] },
    {
      ...still,
      name: "ball",
      colour: 0xc0392b,
      shape: 2,
      half: 0.6,
      start: [0, 3, 15],
      free: { at: 0, velocity: [0, 5.5, -12.5], spin: [-8, 0, 0] },
    },
    { ...still, name: "capsule", shape: 3, half: 0.25, start: [-4, 3, 3], free: fall([2, 0, 3]) },
    { ...still, name: "drum", shape: 4, half: 0.4, start: [-2, 4, 4], free: fall([1, 2, 0]) },
    { ...still, name: "crystal", shape: 5, colour: 0x7fd1e8, half: 0.6, start: [3, 3, 4], free: fall([0, 3, 1]) },
    { ...still, kind: 1, mass: 0, name: "lift", shape: 7, start: [5, 1, 4], free: null },
    { ...still, kind: 0, mass: 0, name: "gate", shape: 6, sensor: true, start: [0, 1, 6] },
    {
      ...still,
      name: "late",
      shape: 7,
      half: 0.3,
      colour: 0xf1c40f,
      start: [-6, 5, 2],
      free: fall([1, 1, 1]),
      exists: [0.5, 3],
    },
    { ...still, name: "statue", shape: 7, mesh: 0, half: 0.3, start: [7, 0.6, 3] },
    ...wall(columns, courses),
    ...(tiles > 0 ? [{ ...still, kind: 0, mass: 0, name: "level", shape: 7, half: 0.3, start: [-12, 0.3, -24] as Vec3 }] : []),
  ];
}

/** Returns the state of an actor at a time: thrown, then sliding to rest where it lands. */
function stateOf(actor: Actor, row: number, time: number): BodyInput {
  const kind = actor.kind << 2;
  if (actor.kind === 1) {
    const position: Vec3 = [actor.start[0], actor.start[1] + 0.7 * Math.sin(time * 2), actor.start[2]];
    return { row, position, rotation: rotationAbout([0, 1, 0], time), flags: kind | 1, island: 0 };
  }
  const since = actor.free ? time - actor.free.at : -1;
  if (!actor.free || since <= 0) {
    const isAwake = actor.kind === 2 && time < 0.5;
    return {
      row,
      position: actor.start,
      rotation: [0, 0, 0, 1],
      flags: kind | (isAwake ? 1 : 0),
      island: isAwake ? 10 : 0,
    };
  }
  const { velocity, spin } = actor.free;
  const drop = actor.start[1] - actor.half;
  const landing = (velocity[1] + Math.sqrt(velocity[1] ** 2 + 2 * gravity * drop)) / gravity;
  const t = Math.min(since, landing);
  const slide = Math.min(Math.max(0, since - landing), 0.6);
  const run = t + slide - slide * slide * 0.8;
  const position: Vec3 = [
    actor.start[0] + velocity[0] * run,
    Math.max(actor.half, actor.start[1] + velocity[1] * t - (gravity / 2) * t * t),
    actor.start[2] + velocity[2] * run,
  ];
  const isAwake = since < landing + 1;
  return {
    row,
    position,
    rotation: rotationAbout(spin, Math.hypot(...spin) * run),
    flags: kind | (isAwake ? 1 : 0),
    island: isAwake ? 1 + (row % 12) : 0,
  };
}

export interface FixtureOptions {
  frames?: number;
  columns?: number;
  courses?: number;
  blockFrames?: number;
  pack?: Packer;
  timeStep?: number;
  /** default: true */
  contacts?: boolean;
  /** adds a static body "level" with so many shapes; default: none */
  tiles?: number;
}

/** A recording and the frames that it was made from. */
export interface Fixture {
  file: Uint8Array;
  inputs: FrameInput[];
  /** offset of each chunk */
  chunkOffsets: number[];
}

export function makeFixture(options: FixtureOptions = {}): Fixture {
  const { frames = 150, columns = 16, courses = 12, blockFrames = 32, pack = plain, tiles = 0 } = options;
  const actors = cast(columns, courses, tiles);
  const bodyRows: BodyRow[] = actors.map(({ kind, mass, colour, name }, i) => ({
    index: i,
    generation: 1,
    kind,
    user: BigInt(i) + (1n << 40n),
    mass,
    colour,
    name,
  }));
  const colliderRows: ColliderRow[] = actors.map(({ shape, sensor = false }, body) => ({ body, shape, sensor }));
  for (let n = 1; n < tiles; ++n)
    colliderRows.push({ body: actors.length - 1, shape: 7, pose: { position: tileAt(n), rotation: [0, 0, 0, 1] } });
  const statue = actors.findIndex(({ mesh }) => mesh !== undefined);
  const pieces = [
    chunk(
      "HEAD",
      head({
        title: "test wall",
        timeStep: options.timeStep ?? timeStep,
        quantaPerMetre: quanta,
        hasContacts: options.contacts ?? true,
        stageNames: ["refresh", "pairs", "collide", "islands", "solve", "finish", "sleep", "events"],
        counterNames: ["bodies", "awake", "pairs", "manifolds", "contact_points", "islands"],
      }),
      pack,
    ),
    chunk("SHAP", shapes(table), pack),
    chunk("MESH", meshes([octahedron(0.9)]), pack),
    chunk("XTRA", new Uint8Array([1, 2, 3]), pack),
    chunk("BODY", bodies(bodyRows), pack),
    chunk("COLL", colliders(colliderRows), pack),
    chunk("VISU", visuals([{ body: statue, mesh: 0, colour: 0x9ad0a0 }]), pack),
  ];
  const encoder = new FrameEncoder(quanta);
  const inputs: FrameInput[] = [];
  for (let number = 0; number < frames; ++number) {
    const input = frameAt(actors, number);
    if (options.contacts === false) delete input.contacts;
    inputs.push(input);
    encoder.add(input);
    if (encoder.pending === blockFrames || number === frames - 1) pieces.push(chunk("FRMS", encoder.takeBlock(), pack));
  }
  const chunkOffsets: number[] = [];
  pieces.reduce((at, piece) => (chunkOffsets.push(at), at + piece.length), 16);
  return { file: join(fileHeader(), ...pieces), inputs, chunkOffsets };
}

function frameAt(actors: Actor[], number: number): FrameInput {
  const time = number * timeStep;
  const states = actors.flatMap((actor, row) => {
    const [from, to] = actor.exists ?? [0, Infinity];
    return time >= from && time < to ? [stateOf(actor, row, time)] : [];
  });
  const awake = states.filter(({ flags }) => flags & 1).length;
  const noise = (n: number) => 0.8 + 0.4 * hash01(number * 31 + n);
  const stages = [0.05, 0.3, 0.5, 0.08, 1.1, 0.1, 0.04, 0.03].map((ms, i) => ms * noise(i) * (0.3 + awake / 80));
  const contacts: ContactInput[] = states
    .filter(({ row, position }) => actors[row].kind === 2 && position[1] <= actors[row].half + 1e-6)
    .map(({ row, position }) => ({
      a: 0,
      b: row,
      normal: [0, 1, 0],
      points: [{ at: [position[0], 0, position[2]], separation: -0.001, impulse: 2 + 10 * hash01(row) }],
    }));
  const isHit = number === 72;
  return {
    step: number,
    time,
    total: stages.reduce((a, b) => a + b, 0.02),
    stages,
    counters: [states.length, awake, awake * 4, awake * 3, awake * 9, Math.min(12, awake)],
    bodies: states,
    contacts,
    contactsBegun: isHit
      ? [
          { a: 1, b: 20 },
          { a: 5, b: 3 },
        ]
      : [],
    contactsEnded: number === 80 ? [{ a: 1, b: 20 }] : [],
    sensorsBegun: number === 40 ? [{ a: 6, b: 1 }] : [],
    sensorsEnded: number === 50 ? [{ a: 6, b: 1 }] : [],
    hits: isHit ? [{ a: 1, b: 20, point: [0, 3, 0.3], normal: [0, 0, -1], speed: 12.5, impulse: 640 }] : [],
  };
}
