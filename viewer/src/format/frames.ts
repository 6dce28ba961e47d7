/** Decodes one block of frames: a key frame, then the changes from frame to frame. */
import type { Frame, Tables } from "../model";
import { Reader } from "./bytes";
import { readContacts, readEvents } from "./events";

const maxFrames = 64;

/** The begin and end offsets of the frames in the raw bytes of a block. */
export interface BlockLayout {
  first: number;
  begins: number[];
  ends: number[];
}

/** Reads the first frame's number and the frame count from the first 12 raw bytes of a block. */
export function readBlockRange(raw: Uint8Array): { first: number; count: number } {
  const read = new Reader(raw, "FRMS");
  const first = read.count64();
  const count = read.u32();
  if (count < 1 || count > maxFrames) read.fail(`found ${count} frames; expected 1 to ${maxFrames}`);
  return { first, count };
}

export function readBlockLayout(raw: Uint8Array): BlockLayout {
  const { first, count } = readBlockRange(raw);
  const read = new Reader(raw, `block of frame ${first}`);
  read.advance(12);
  const begins: number[] = [];
  const ends: number[] = [];
  for (let i = 0; i < count; ++i) {
    begins.push(read.advance(read.u32()));
    ends.push(read.offset);
  }
  if (read.left > 0) read.fail(`found ${read.left} bytes after the last frame`);
  return { first, begins, ends };
}

/** The fields at the beginning of every frame. */
export interface FrameHead {
  isKey: boolean;
  hasContacts: boolean;
  step: number;
  time: number;
  total: number;
  stages: Float32Array;
  counters: number[];
}

export function readFrameHead(read: Reader, tables: Tables): FrameHead {
  const flags = read.u8();
  const step = read.count64();
  const time = read.f64();
  if (!Number.isFinite(time)) read.fail(`found time ${time}; expected a finite number`);
  const total = read.f32();
  const stages = read.floats(tables.stageNames.length);
  const counters = tables.counterNames.map(() => read.varuint());
  return { isKey: (flags & 1) !== 0, hasContacts: (flags & 2) !== 0, step, time, total, stages, counters };
}

const unzigzag = (u: number): number => (u & 1 ? -((u + 1) >>> 1) : u >>> 1);

/** Decodes the frames in order. Its state by body row: quanta, rotation codes, and the steps of the last frame. */
export class BlockDecoder {
  /** index in the block of the next frame */
  index = 0;
  private readonly present: Uint8Array;
  private readonly flags: Uint8Array;
  private readonly islands: Uint32Array;
  private readonly positions: Float64Array;
  private readonly rotations: Float32Array;
  private readonly quanta: Float64Array;
  private readonly codes: Int32Array;
  private readonly largest: Uint8Array;
  private readonly steps: Float64Array;
  /** index of the last frame whose *moved* list had the row; its steps are valid in the next frame only */
  private readonly lastMoved: Int32Array;
  /** index of the last frame whose added, jumped or moved list had the row; at most one of them per frame */
  private readonly lastPosed: Int32Array;

  constructor(
    private readonly tables: Tables,
    private readonly raw: Uint8Array,
    private readonly layout: BlockLayout,
  ) {
    const n = tables.bodies.length;
    this.present = new Uint8Array(n);
    this.flags = new Uint8Array(n);
    this.islands = new Uint32Array(n);
    this.positions = new Float64Array(3 * n);
    this.rotations = new Float32Array(4 * n);
    this.quanta = new Float64Array(3 * n);
    this.codes = new Int32Array(3 * n);
    this.largest = new Uint8Array(n);
    this.steps = new Float64Array(6 * n);
    this.lastMoved = new Int32Array(n).fill(-2);
    this.lastPosed = new Int32Array(n).fill(-2);
    for (let row = 0; row < n; ++row) this.rotations[4 * row + 3] = 1;
  }

  /** Decodes the next frame. The result owns its arrays. */
  next(): Frame {
    const { tables, layout, index } = this;
    const number = layout.first + index;
    const read = new Reader(this.raw.subarray(layout.begins[index], layout.ends[index]), `frame ${number}`);
    const head = readFrameHead(read, tables);
    if (index === 0 && !head.isKey) read.fail("found no key frame at the beginning of a block");
    if (head.isKey) this.present.fill(0);

    for (const row of this.readRows(read, "present")) this.present[row] = 0;
    this.readAdded(read);
    const flagged = this.readRows(read, "present");
    const flags = read.octets(flagged.length);
    for (let i = 0; i < flagged.length; ++i) this.flags[flagged[i]] = flags[i];
    for (const row of this.readRows(read, "present")) this.islands[row] = read.varuint();
    this.readPoses(read, this.readRows(read, "present"));
    this.readMoves(read, this.readRows(read, "present"));
    const events = readEvents(read, tables);
    const contacts = head.hasContacts ? readContacts(read, tables) : null;
    if (read.left > 0) read.fail(`found ${read.left} bytes after the last field`);
    this.index = index + 1;
    return {
      number,
      step: head.step,
      time: head.time,
      present: this.present.slice(),
      flags: this.flags.slice(),
      islands: this.islands.slice(),
      positions: this.positions.slice(),
      rotations: this.rotations.slice(),
      events,
      contacts,
    };
  }

  private readRows(read: Reader, state: "present" | "absent"): Uint32Array {
    const rows = read.rows(read.count(1), this.tables.bodies.length);
    const expected = state === "present" ? 1 : 0;
    for (const row of rows)
      if (this.present[row] !== expected)
        read.fail(`found body row ${row} ${expected ? "that is not present" : "that is already present"}`);
    return rows;
  }

  private readAdded(read: Reader): void {
    const rows = this.readRows(read, "absent");
    const flags = read.octets(rows.length);
    for (let i = 0; i < rows.length; ++i) {
      this.present[rows[i]] = 1;
      this.flags[rows[i]] = flags[i];
    }
    this.readPoses(read, rows);
    for (const row of rows) this.islands[row] = read.varuint();
  }

  /** Reads full poses, of new bodies and of bodies that jumped. */
  private readPoses(read: Reader, rows: Uint32Array): void {
    const n = rows.length;
    for (let axis = 0; axis < 3; ++axis) {
      const values = read.running(n);
      for (let i = 0; i < n; ++i) this.quanta[3 * rows[i] + axis] = values[i];
    }
    for (let part = 0; part < 3; ++part) {
      const codes = read.planes16(n);
      for (let i = 0; i < n; ++i) {
        this.codes[3 * rows[i] + part] = codes[i] & 16383;
        if (part === 0) this.largest[rows[i]] = codes[i] >> 14;
      }
    }
    for (const row of rows) {
      this.markPosed(read, row);
      this.lastMoved[row] = -2;
      this.dequantize(row);
    }
  }

  /** Reads the residuals of the prediction that each body repeats its last step. */
  private readMoves(read: Reader, rows: Uint32Array): void {
    const n = rows.length;
    const { steps, quanta, codes } = this;
    for (const row of rows) {
      this.markPosed(read, row);
      if (this.lastMoved[row] !== this.index - 1) steps.fill(0, 6 * row, 6 * row + 6);
      this.lastMoved[row] = this.index;
    }
    for (let axis = 0; axis < 3; ++axis) {
      const residuals = read.planes16(n);
      for (let i = 0; i < n; ++i) {
        const step = (steps[6 * rows[i] + axis] += unzigzag(residuals[i]));
        quanta[3 * rows[i] + axis] += step;
      }
    }
    for (let part = 0; part < 3; ++part) {
      const residuals = read.planes16(n);
      for (let i = 0; i < n; ++i) {
        const row = rows[i];
        const old = codes[3 * row + part];
        const code = (old + steps[6 * row + 3 + part] + unzigzag(residuals[i] & 16383)) & 16383;
        const change = code - old;
        steps[6 * row + 3 + part] = change > 8191 ? change - 16384 : change < -8192 ? change + 16384 : change;
        codes[3 * row + part] = code;
        if (part === 0) this.largest[row] = residuals[i] >> 14;
      }
    }
    for (const row of rows) this.dequantize(row);
  }

  private markPosed(read: Reader, row: number): void {
    if (this.lastPosed[row] === this.index) read.fail(`found body row ${row} posed twice in one frame`);
    this.lastPosed[row] = this.index;
  }

  /** Converts quanta and codes to metres and a unit quaternion. */
  private dequantize(row: number): void {
    const { positions, quanta, rotations, codes } = this;
    const perMetre = this.tables.quantaPerMetre;
    for (let axis = 0; axis < 3; ++axis) positions[3 * row + axis] = quanta[3 * row + axis] / perMetre;
    const scale = Math.SQRT1_2 / 8191;
    const a = (codes[3 * row] - 8192) * scale;
    const b = (codes[3 * row + 1] - 8192) * scale;
    const c = (codes[3 * row + 2] - 8192) * scale;
    const rest = 1 - a * a - b * b - c * c;
    const d = rest > 0 ? Math.sqrt(rest) : 0;
    const norm = 1 / Math.sqrt(a * a + b * b + c * c + d * d);
    const largest = this.largest[row];
    const at = 4 * row;
    rotations[at] = (largest === 0 ? d : a) * norm;
    rotations[at + 1] = (largest === 1 ? d : largest === 0 ? a : b) * norm;
    rotations[at + 2] = (largest === 2 ? d : largest === 3 ? c : b) * norm;
    rotations[at + 3] = (largest === 3 ? d : c) * norm;
  }
}
