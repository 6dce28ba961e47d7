/** Encodes recordings as described in fase/record/format.md, to test the decoder. */
import { crc32 } from "../src/format/crc32";
import type { PairEvent, HitEvent, Quat, Triangles, Vec3, LocalPose } from "../src/model";
import type { Shape } from "../src/shapes/list";
import { writeShape } from "./shapes";

/** A growing byte buffer. */
export class Writer {
  private buffer = new Uint8Array(1024);
  length = 0;

  private grow(count: number): DataView {
    if (this.length + count > this.buffer.length) {
      const larger = new Uint8Array(2 * (this.length + count));
      larger.set(this.buffer);
      this.buffer = larger;
    }
    this.length += count;
    return new DataView(this.buffer.buffer, this.length - count, count);
  }
  u8(value: number): void {
    this.grow(1).setUint8(0, value);
  }
  u16(value: number): void {
    this.grow(2).setUint16(0, value, true);
  }
  u32(value: number): void {
    this.grow(4).setUint32(0, value, true);
  }
  u64(value: bigint | number): void {
    this.grow(8).setBigUint64(0, BigInt(value), true);
  }
  f32(...values: number[]): void {
    for (const value of values) this.grow(4).setFloat32(0, value, true);
  }
  f64(value: number): void {
    this.grow(8).setFloat64(0, value, true);
  }
  varuint(value: number): void {
    for (; value >= 128; value = Math.floor(value / 128)) this.u8((value % 128) + 128);
    this.u8(value);
  }
  varint(value: number): void {
    this.varuint(value >= 0 ? 2 * value : -2 * value - 1);
  }
  text(text: string): void {
    const bytes = new TextEncoder().encode(text);
    this.varuint(bytes.length);
    this.bytes(bytes);
  }
  bytes(bytes: Uint8Array): void {
    this.grow(bytes.length);
    this.buffer.set(bytes, this.length - bytes.length);
  }
  rows(rows: number[]): void {
    rows.forEach((row, i) => this.varuint(i === 0 ? row : row - rows[i - 1] - 1));
  }
  planes16(values: number[]): void {
    for (const value of values) this.u8(value & 255);
    for (const value of values) this.u8(value >> 8);
  }
  running(values: number[]): void {
    values.forEach((value, i) => this.varint(value - (i === 0 ? 0 : values[i - 1])));
  }
  done(): Uint8Array {
    return this.buffer.slice(0, this.length);
  }
}

export type Packer = (raw: Uint8Array) => { method: number; packed: Uint8Array };
export const plain: Packer = (raw) => ({ method: 0, packed: raw });
/** Packs into a zstd frame of raw blocks: valid, but not smaller. */
export const zstdRaw: Packer = (raw) => {
  const out = new Writer();
  out.u32(0xfd2fb528);
  out.u8(0b10100000); // single segment, content size of 4 bytes
  out.u32(raw.length);
  for (let at = 0; at < raw.length || at === 0; at += 65536) {
    const block = raw.subarray(at, at + 65536);
    const isLast = at + 65536 >= raw.length;
    const head = (block.length << 3) | (isLast ? 1 : 0);
    out.u16(head & 0xffff);
    out.u8(head >> 16);
    out.bytes(block);
  }
  return { method: 1, packed: out.done() };
};

export function chunk(type: string, raw: Uint8Array, pack: Packer = plain): Uint8Array {
  const { method, packed } = pack(raw);
  const out = new Writer();
  out.bytes(new TextEncoder().encode(type));
  out.u32(8 + packed.length);
  out.u8(method);
  out.bytes(new Uint8Array(3));
  out.u32(raw.length);
  out.bytes(packed);
  out.u32(crc32(out.done()));
  return out.done();
}

export function fileHeader(version = 1): Uint8Array {
  const out = new Writer();
  out.bytes(new TextEncoder().encode("FASEREC\n"));
  out.u32(version);
  out.u32(crc32(out.done()));
  return out.done();
}

export function join(...pieces: Uint8Array[]): Uint8Array {
  const out = new Writer();
  for (const piece of pieces) out.bytes(piece);
  return out.done();
}

export interface Head {
  title: string;
  timeStep: number;
  quantaPerMetre: number;
  hasContacts: boolean;
  stageNames: string[];
  counterNames: string[];
}
export function head({ title, timeStep, quantaPerMetre, hasContacts, stageNames, counterNames }: Head): Uint8Array {
  const out = new Writer();
  out.text(title);
  out.text("fixture 1");
  out.f32(timeStep, 0, -9.81, 0);
  out.f64(quantaPerMetre);
  out.u32(hasContacts ? 1 : 0);
  for (const names of [stageNames, counterNames]) {
    out.varuint(names.length);
    names.forEach((name) => out.text(name));
  }
  return out.done();
}

function table<T>(rows: T[], write: (out: Writer, row: T) => void): Uint8Array {
  const out = new Writer();
  out.u32(rows.length);
  rows.forEach((row) => write(out, row));
  return out.done();
}

export const shapes = (rows: Shape[]): Uint8Array => table(rows, writeShape);

export const meshes = (rows: Triangles[]): Uint8Array =>
  table(rows, (out, { vertices, normals, triangles }) => {
    out.u32(vertices.length / 3);
    out.u32(triangles.length / 3);
    out.u8(normals ? 1 : 0);
    out.f32(...vertices, ...(normals ?? []));
    triangles.forEach((vertex) => out.u32(vertex));
  });

function writeColour(out: Writer, colour: number | null): void {
  for (const shift of [16, 8, 0]) out.u8(((colour ?? 0) >> shift) & 255);
  out.u8(colour === null ? 0 : 255);
}

export interface BodyRow {
  index: number;
  generation: number;
  kind: number;
  user: bigint;
  mass: number;
  colour: number | null;
  name: string;
}
export const bodies = (rows: BodyRow[]): Uint8Array =>
  table(rows, (out, body) => {
    out.u32(body.index);
    out.u16(body.generation);
    out.u8(body.kind);
    out.u8(0);
    out.u64(body.user);
    out.f32(body.mass);
    writeColour(out, body.colour);
    out.text(body.name);
  });

export interface ColliderRow {
  body: number;
  shape: number;
  from?: number;
  sensor?: boolean;
  pose?: LocalPose;
}
const still: LocalPose = { position: [0, 0, 0], rotation: [0, 0, 0, 1] };
export const colliders = (rows: ColliderRow[]): Uint8Array =>
  table(rows, (out, { body, shape, from = 0, sensor = false, pose = still }) => {
    out.u32(body);
    out.u16(1);
    out.u8(sensor ? 1 : 0);
    out.u8(0);
    out.u32(body);
    out.u32(shape);
    out.u64(from);
    out.f32(...pose.position, ...pose.rotation);
  });

export const colliderEnds = (rows: { collider: number; frame: number }[]): Uint8Array =>
  table(rows, (out, { collider, frame }) => {
    out.u32(collider);
    out.u64(frame);
  });

export const visuals = (rows: { body: number; mesh: number; pose?: LocalPose; colour: number | null }[]): Uint8Array =>
  table(rows, (out, { body, mesh, pose = still, colour }) => {
    out.u32(body);
    out.u32(mesh);
    out.f32(...pose.position, ...pose.rotation);
    writeColour(out, colour);
  });

/** The state of one body in a frame to encode. */
export interface BodyInput {
  row: number;
  position: Vec3;
  rotation: Quat;
  flags: number;
  island: number;
}
export interface ContactInput extends PairEvent {
  normal: Vec3;
  points: { at: Vec3; separation: number; impulse: number }[];
}
export interface FrameInput {
  step: number;
  time: number;
  total: number;
  stages: number[];
  counters: number[];
  bodies: BodyInput[];
  contactsBegun?: PairEvent[];
  contactsEnded?: PairEvent[];
  sensorsBegun?: PairEvent[];
  sensorsEnded?: PairEvent[];
  hits?: HitEvent[];
  contacts?: ContactInput[];
}

/** A pose as stored in the file. */
interface Coded {
  quanta: number[];
  codes: number[];
  largest: number;
}

export function codeRotation(rotation: Quat): { codes: number[]; largest: number } {
  const norm = Math.hypot(...rotation);
  const largest = rotation.reduce((best, x, i) => (Math.abs(x) > Math.abs(rotation[best]) ? i : best), 0);
  const sign = rotation[largest] < 0 ? -1 : 1;
  const rest = rotation.filter((_, i) => i !== largest);
  const codes = rest.map((x) =>
    Math.max(0, Math.min(16383, Math.round(((sign * x) / norm) * Math.SQRT2 * 8191) + 8192)),
  );
  return { codes, largest };
}

const zigzag = (n: number) => (n >= 0 ? 2 * n : -2 * n - 1);
const wrap14 = (n: number) => ((n + 8192) & 16383) - 8192;

/** Encodes frames into the raw bytes of blocks; keeps the same state as the decoder. */
export class FrameEncoder {
  private readonly last = new Map<number, Coded & { flags: number; island: number; steps: number[] }>();
  private readonly frames: Uint8Array[] = [];
  private first = 0;
  private count = 0;

  constructor(private readonly quantaPerMetre: number) {}

  /** Adds a frame. The first of a block is a key frame. */
  add(input: FrameInput): void {
    const isKey = this.frames.length === 0;
    if (isKey) this.last.clear();
    const out = new Writer();
    out.u8((isKey ? 1 : 0) | (input.contacts ? 2 : 0));
    out.u64(input.step);
    out.f64(input.time);
    out.f32(input.total, ...input.stages);
    input.counters.forEach((counter) => out.varuint(counter));
    this.writeBodies(out, input.bodies);
    this.writeEvents(out, input);
    if (input.contacts) this.writeContacts(out, input.contacts);
    const sized = new Writer();
    sized.u32(out.length);
    sized.bytes(out.done());
    this.frames.push(sized.done());
    ++this.count;
  }

  get pending(): number {
    return this.frames.length;
  }

  /** Returns the raw bytes of the current block and starts the next. */
  takeBlock(): Uint8Array {
    const out = new Writer();
    out.u64(this.first);
    out.u32(this.frames.length);
    this.frames.forEach((frame) => out.bytes(frame));
    this.first = this.count;
    this.frames.length = 0;
    return out.done();
  }

  private writeBodies(out: Writer, inputs: BodyInput[]): void {
    const now = new Map(inputs.map((body) => [body.row, body]));
    const removed = [...this.last.keys()].filter((row) => !now.has(row)).sort((a, b) => a - b);
    const list = (rows: number[]) => {
      out.varuint(rows.length);
      out.rows(rows);
    };
    list(removed);
    removed.forEach((row) => this.last.delete(row));

    const coded = new Map(
      inputs.map(({ row, position, rotation }): [number, Coded] => [
        row,
        { quanta: position.map((x) => Math.round(x * this.quantaPerMetre)), ...codeRotation(rotation) },
      ]),
    );
    const of = (row: number) => coded.get(row) as Coded;
    const input = (row: number) => now.get(row) as BodyInput;
    const rows = inputs.map(({ row }) => row).sort((a, b) => a - b);
    const added = rows.filter((row) => !this.last.has(row));
    const old = rows.filter((row) => this.last.has(row));
    const before = (row: number) => this.last.get(row) as NonNullable<ReturnType<typeof this.last.get>>;

    list(added);
    added.forEach((row) => out.u8(input(row).flags));
    this.writePoses(out, added.map(of));
    added.forEach((row) => out.varuint(input(row).island));

    const flagged = old.filter((row) => before(row).flags !== input(row).flags);
    list(flagged);
    flagged.forEach((row) => out.u8(input(row).flags));
    const relabelled = old.filter((row) => before(row).island !== input(row).island);
    list(relabelled);
    relabelled.forEach((row) => out.varuint(input(row).island));

    const changed = old.filter((row) => {
      const [a, b] = [before(row), of(row)];
      return (
        a.largest !== b.largest ||
        a.quanta.some((x, i) => x !== b.quanta[i]) ||
        a.codes.some((x, i) => x !== b.codes[i])
      );
    });
    const residuals = (row: number) => {
      const [a, b] = [before(row), of(row)];
      return [
        ...b.quanta.map((x, i) => x - a.quanta[i] - a.steps[i]),
        ...b.codes.map((x, i) => wrap14(x - a.codes[i] - a.steps[3 + i])),
      ];
    };
    const jumped = changed.filter((row) =>
      residuals(row)
        .slice(0, 3)
        .some((e) => e < -32768 || e > 32767),
    );
    const moved = changed.filter((row) => !jumped.includes(row));
    list(jumped);
    this.writePoses(out, jumped.map(of));
    list(moved);
    const words = moved.map((row) => residuals(row).map(zigzag));
    for (let column = 0; column < 6; ++column)
      out.planes16(words.map((six, i) => six[column] | (column === 3 ? of(moved[i]).largest << 14 : 0)));

    const isMoved = new Set(moved);
    for (const row of rows) {
      const last = this.last.get(row);
      const { quanta, codes, largest } = of(row);
      const steps =
        last && isMoved.has(row)
          ? [...quanta.map((x, i) => x - last.quanta[i]), ...codes.map((x, i) => wrap14(x - last.codes[i]))]
          : [0, 0, 0, 0, 0, 0];
      this.last.set(row, { quanta, codes, largest, flags: input(row).flags, island: input(row).island, steps });
    }
  }

  private writePoses(out: Writer, poses: Coded[]): void {
    for (let axis = 0; axis < 3; ++axis) out.running(poses.map(({ quanta }) => quanta[axis]));
    for (let part = 0; part < 3; ++part)
      out.planes16(poses.map(({ codes, largest }) => codes[part] | (part === 0 ? largest << 14 : 0)));
  }

  private writePairs(out: Writer, pairs: PairEvent[]): void {
    out.varuint(pairs.length);
    out.running(pairs.map(({ a }) => a));
    pairs.forEach(({ a, b }) => out.varint(b - a));
  }

  private writePoints(out: Writer, points: Vec3[]): void {
    for (let axis = 0; axis < 3; ++axis)
      out.running(points.map((point) => Math.round(point[axis] * this.quantaPerMetre)));
  }

  private writeEvents(out: Writer, input: FrameInput): void {
    for (const pairs of [input.contactsBegun, input.contactsEnded, input.sensorsBegun, input.sensorsEnded])
      this.writePairs(out, pairs ?? []);
    const hits = input.hits ?? [];
    this.writePairs(out, hits);
    this.writePoints(
      out,
      hits.map(({ point }) => point),
    );
    hits.forEach(({ normal }) => out.f32(...normal));
    hits.forEach(({ speed }) => out.f32(speed));
    hits.forEach(({ impulse }) => out.f32(impulse));
  }

  private writeContacts(out: Writer, contacts: ContactInput[]): void {
    this.writePairs(out, contacts);
    contacts.forEach(({ points }) => out.u8(points.length));
    contacts.forEach(({ normal }) => out.f32(...normal));
    const points = contacts.flatMap((contact) => contact.points);
    this.writePoints(
      out,
      points.map(({ at }) => at),
    );
    points.forEach(({ separation }) => out.f32(separation));
    points.forEach(({ impulse }) => out.f32(impulse));
  }
}
