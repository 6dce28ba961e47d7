/** Decodes the chunks that are shared by all frames: HEAD, SHAP, MESH, BODY, COLL, CEND, VISU. */
import type { BodyKind, LocalPose, Quat, Tables, Vec3 } from "../model";
import { readShape } from "../shapes/list";
import { Reader } from "./bytes";
import { readTriangles } from "./triangles";

const maxRows = 1 << 21;

export function decodeHead(raw: Uint8Array): Tables {
  const read = new Reader(raw, "HEAD");
  const title = read.text();
  const program = read.text();
  const timeStep = read.f32();
  const gravity = read.vec3();
  const quantaPerMetre = read.f64();
  if (!(quantaPerMetre > 0 && quantaPerMetre < Infinity))
    read.fail(`found ${quantaPerMetre} quanta per metre; expected above 0`);
  const flags = read.u32();
  const texts = () => Array.from({ length: read.count(1) }, () => read.text());
  const stageNames = texts();
  const counterNames = texts();
  return {
    title,
    program,
    timeStep,
    gravity,
    quantaPerMetre,
    hasContacts: (flags & 1) !== 0,
    stageNames,
    counterNames,
    shapes: [],
    meshes: [],
    bodies: [],
    colliders: [],
    visuals: [],
  };
}

/** Adds the rows of one chunk to the tables. Ignores other chunk types. */
export function addRows(tables: Tables, type: string, raw: Uint8Array): void {
  const rows = readers[type];
  if (!rows) return;
  const read = new Reader(raw, type);
  const count = read.u32();
  const table = rows.of(tables);
  if (count * rows.minBytes > read.left) read.fail(`found ${count} rows, but only ${read.left} bytes follow`);
  if (table && table.length + count > maxRows) read.fail(`found more than ${maxRows} rows`);
  for (let i = 0; i < count; ++i) rows.add(tables, read);
  if (read.left > 0) read.fail(`found ${read.left} bytes after the last row`);
}

interface RowReader {
  minBytes: number;
  of(tables: Tables): unknown[] | null;
  add(tables: Tables, read: Reader): void;
}

const readers: Record<string, RowReader> = {
  SHAP: { minBytes: 1, of: (t) => t.shapes, add: (t, read) => t.shapes.push(readShape(read)) },
  MESH: {
    minBytes: 9,
    of: (t) => t.meshes,
    add: (t, read) => {
      const vertices = read.u32();
      const triangles = read.u32();
      const flags = read.u8();
      t.meshes.push(readTriangles(read, vertices, triangles, (flags & 1) !== 0));
    },
  },
  BODY: {
    minBytes: 25,
    of: (t) => t.bodies,
    add: (t, read) => {
      const index = read.u32();
      const generation = read.u16();
      const kind = read.u8();
      if (kind > 2) read.fail(`found body kind ${kind}; expected 0 to 2`);
      read.u8();
      const user = read.u64();
      const mass = read.f32();
      const colour = readColour(read);
      const name = read.text();
      t.bodies.push({
        index,
        generation,
        kind: kind as BodyKind,
        user,
        mass,
        colour,
        name,
        colliders: [],
        visuals: [],
      });
    },
  },
  COLL: {
    minBytes: 52,
    of: (t) => t.colliders,
    add: (t, read) => {
      read.advance(6); // id in the world
      const flags = read.u8();
      read.u8();
      const body = readRow(read, t.bodies, "body");
      const shape = readRow(read, t.shapes, "shape");
      const from = read.count64();
      const pose = readPose(read);
      t.bodies[body].colliders.push(t.colliders.length);
      t.colliders.push({ body, shape, pose, sensor: (flags & 1) !== 0, from, to: Infinity });
    },
  },
  CEND: {
    minBytes: 12,
    of: () => null,
    add: (t, read) => {
      const collider = readRow(read, t.colliders, "collider");
      t.colliders[collider].to = read.count64();
    },
  },
  VISU: {
    minBytes: 40,
    of: (t) => t.visuals,
    add: (t, read) => {
      const body = readRow(read, t.bodies, "body");
      const mesh = readRow(read, t.meshes, "mesh");
      const pose = readPose(read);
      const colour = readColour(read);
      t.bodies[body].visuals.push(t.visuals.length);
      t.visuals.push({ body, mesh, pose, colour });
    },
  },
};

function readRow(read: Reader, table: unknown[], what: string): number {
  const row = read.u32();
  if (row >= table.length) read.fail(`found ${what} row ${row}; expected below ${table.length}`);
  return row;
}

function readColour(read: Reader): number | null {
  const [red, green, blue, alpha] = read.octets(4);
  return alpha === 0 ? null : (red << 16) | (green << 8) | blue;
}

function readPose(read: Reader): LocalPose {
  const position: Vec3 = read.vec3();
  const rotation: Quat = [read.f32(), read.f32(), read.f32(), read.f32()];
  const length = Math.hypot(...rotation);
  if (![...position, length].every(Number.isFinite) || length < 0.5)
    read.fail("found a pose that is not finite or has no rotation");
  return { position, rotation: rotation.map((x) => x / length) as Quat };
}
