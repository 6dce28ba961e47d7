/** A recording with random access: unpacks blocks on demand and caches frames within a memory budget. */
import { type Chunk, walkChunks } from "./format/chunks";
import { RecordingError } from "./format/bytes";
import { BlockDecoder, readBlockLayout, readBlockRange } from "./format/frames";
import { readSummaries } from "./format/summary";
import { addRows, decodeHead } from "./format/tables";
import { finish, unpack, unpackSlices } from "./format/unpack";
import type { Frame, Summary, Tables } from "./model";

const rawBudget = 96 * 1024 * 1024;
const frameBudget = 160 * 1024 * 1024;
const bytesPerBody = 46;

interface Block {
  first: number;
  count: number;
  chunk: Chunk;
}

/** A least-recently-used cache with a maximum number of values (at least one). */
class LruCache<T> {
  private readonly values = new Map<number, T>();
  constructor(private readonly capacity: number) {}
  get(key: number): T | undefined {
    const value = this.values.get(key);
    if (value === undefined) return undefined;
    this.values.delete(key);
    this.values.set(key, value);
    return value;
  }
  has(key: number): boolean {
    return this.values.has(key);
  }
  set(key: number, value: T): void {
    this.values.delete(key);
    this.values.set(key, value);
    for (const oldest of this.values.keys()) {
      if (this.values.size <= Math.max(1, this.capacity)) break;
      this.values.delete(oldest);
    }
  }
}

export class Recording {
  readonly frameCount: number;
  private readonly raws: LruCache<Uint8Array>;
  private readonly frames: LruCache<Frame>;
  private decoder: { block: number; at: BlockDecoder } | null = null;

  private constructor(
    readonly tables: Tables,
    private readonly blocks: Block[],
    /** why the end of the file is missing; empty: nothing is missing */
    readonly damage: string,
  ) {
    const last = blocks[blocks.length - 1];
    this.frameCount = last.first + last.count;
    this.frames = new LruCache(Math.max(4, Math.floor(frameBudget / (bytesPerBody * tables.bodies.length + 4096))));
    const largest = Math.max(...blocks.map(({ chunk }) => rawLengthOf(chunk)));
    this.raws = new LruCache(Math.max(2, Math.floor(rawBudget / Math.max(1, largest))));
  }

  /** Opens a file; yields the finished share (0 to 1). Throws RecordingError when no frame can be shown. */
  static *open(file: Uint8Array): Generator<number, Recording> {
    const { chunks, damage } = yield* walkChunks(file);
    if (chunks[0]?.type !== "HEAD") throw new RecordingError(damage || "found no HEAD as first chunk");
    const tables = decodeHead(unpack(chunks[0].body, "HEAD"));
    const maxBytes = 4 * 1024 * 1024 + 16 * file.length;
    let tableBytes = rawLengthOf(chunks[0]);
    let problem = damage;
    const blocks: Block[] = [];
    let next = 0;
    for (const chunk of chunks.slice(1)) {
      try {
        if (chunk.type === "FRMS") {
          const { first, count } = readBlockRange(unpack(chunk.body, "FRMS", 12));
          if (first !== next) throw new RecordingError(`found a block of frame ${first}; expected frame ${next}`);
          blocks.push({ first, count, chunk });
          next += count;
        } else if (chunk.type === "HEAD") {
          throw new RecordingError("found a second HEAD");
        } else {
          tableBytes += rawLengthOf(chunk);
          if (tableBytes > maxBytes) throw new RecordingError(`the tables expand to more than ${maxBytes} bytes`);
          addRows(tables, chunk.type, unpack(chunk.body, chunk.type));
        }
      } catch (error) {
        if (!(error instanceof RecordingError)) throw error;
        if (blocks.length === 0) throw new RecordingError(`chunk at byte ${chunk.offset}: ${error.message}`);
        problem = `chunk at byte ${chunk.offset}: ${error.message}`;
        break;
      }
      yield 1;
    }
    if (blocks.length === 0) throw new RecordingError(problem ? `found no complete frame (${problem})` : "found no frames");
    return new Recording(tables, blocks, problem);
  }

  static openNow(file: Uint8Array): Recording {
    return finish(Recording.open(file));
  }

  /** Returns the state at a frame, 0 to frameCount - 1. Fast for the next frame and for recent ones. */
  frame(number: number): Frame {
    const known = this.frames.get(number);
    if (known) return known;
    const block = this.blockOf(number);
    const index = number - this.blocks[block].first;
    if (this.decoder?.block !== block || this.decoder.at.index > index) {
      const raw = this.raw(block);
      this.decoder = { block, at: new BlockDecoder(this.tables, raw, readBlockLayout(raw)) };
    }
    const { at } = this.decoder;
    let frame: Frame;
    do {
      try {
        frame = at.next();
      } catch (error) {
        this.decoder = null;
        throw error;
      }
      this.frames.set(frame.number, frame);
    } while (frame.number < number);
    return frame;
  }

  /** Unpacks the block of a frame in advance; yields between slices of a few milliseconds. */
  *prepare(number: number): Generator<unknown, void> {
    if (number < 0 || number >= this.frameCount) return;
    const block = this.blockOf(number);
    if (this.raws.has(block)) return;
    this.raws.set(block, yield* unpackSlices(this.blocks[block].chunk.body, this.nameOf(block)));
  }

  /** Reads all summaries into `into`, block by block; yields between slices of a few milliseconds. */
  *readSummaries(into: Summary[]): Generator<unknown, void> {
    for (let block = 0; block < this.blocks.length; ++block) {
      const raw = this.raws.get(block) ?? (yield* unpackSlices(this.blocks[block].chunk.body, this.nameOf(block)));
      if (block < 2) this.raws.set(block, raw);
      for (const summary of readSummaries(raw, this.tables)) into.push(summary);
      yield;
    }
  }

  private raw(block: number): Uint8Array {
    let raw = this.raws.get(block);
    if (!raw) {
      raw = unpack(this.blocks[block].chunk.body, this.nameOf(block));
      this.raws.set(block, raw);
    }
    return raw;
  }

  private nameOf(block: number): string {
    return `block of frame ${this.blocks[block].first}`;
  }

  private blockOf(number: number): number {
    let lo = 0;
    let hi = this.blocks.length - 1;
    while (lo < hi) {
      const middle = (lo + hi + 1) >> 1;
      if (this.blocks[middle].first <= number) lo = middle;
      else hi = middle - 1;
    }
    return lo;
  }
}

function rawLengthOf(chunk: Chunk): number {
  const { body } = chunk;
  return body.length < 8 ? 0 : new DataView(body.buffer, body.byteOffset).getUint32(4, true);
}
