/** Unpacks the body of a chunk in slices, so that a long one does not block drawing. */
import { Decompress } from "fzstd";
import { RecordingError } from "./bytes";

const mebi = 1024 * 1024;
export const maxRawBytes = 64 * mebi;
const maxWindow = 8 * mebi;
const sliceBytes = 32 * 1024;

/** The fields before the packed bytes of a chunk's body. */
export interface Packing {
  method: number;
  rawLength: number;
  packed: Uint8Array;
}

/** Reads the packing of a body and checks it against the limits of the format. Allocates nothing. */
export function readPacking(body: Uint8Array, what: string): Packing {
  if (body.length < 8) throw new RecordingError(`${what}: found a body of ${body.length} bytes; expected at least 8`);
  const rawLength = new DataView(body.buffer, body.byteOffset).getUint32(4, true);
  const method = body[0];
  const packed = body.subarray(8);
  if (method > 1) throw new RecordingError(`${what}: found packing method ${method}; expected 0 or 1`);
  const limit = Math.min(maxRawBytes, 4 * mebi + 32 * body.length);
  if (rawLength > limit) throw new RecordingError(`${what}: expands to ${rawLength} bytes, limit ${limit}`);
  if (method === 0 && rawLength !== packed.length)
    throw new RecordingError(`${what}: found ${packed.length} bytes; expected ${rawLength}`);
  if (method === 1) checkZstdHeader(packed, rawLength, what);
  return { method, rawLength, packed };
}

/** Checks a zstd header, which decides how much memory the decoder allocates. Source: RFC 8878, 3.1.1. */
function checkZstdHeader(packed: Uint8Array, rawLength: number, what: string): void {
  const magic = packed.length >= 6 && new DataView(packed.buffer, packed.byteOffset).getUint32(0, true);
  if (magic !== 0xfd2fb528) throw new RecordingError(`${what}: found no zstd frame`);
  const descriptor = packed[4];
  const single = (descriptor & 0x20) !== 0;
  if (descriptor & 3) throw new RecordingError(`${what}: found a zstd dictionary; expected none`);
  let at = 5;
  let window = 0;
  if (!single) {
    const base = 2 ** (10 + (packed[at] >> 3));
    window = base + (base / 8) * (packed[at] & 7);
    at += 1;
  }
  const sizeBytes = [single ? 1 : 0, 2, 4, 8][descriptor >> 6];
  let content = sizeBytes === 2 ? 256 : 0;
  for (let i = 0; i < sizeBytes; ++i) content += (packed[at + i] ?? 0) * 256 ** i;
  if (single) window = content;
  if (window > Math.max(maxWindow, single ? rawLength : 0))
    throw new RecordingError(`${what}: found a zstd window of ${window} bytes, limit ${maxWindow}`);
  if (sizeBytes > 0 && content !== rawLength)
    throw new RecordingError(`${what}: found ${content} bytes in the zstd frame; expected ${rawLength}`);
}

/**
 * Unpacks in slices: yields the number of raw bytes so far and returns all of them. Stops early after `enough` bytes; the
 * result is then shorter. Errors name `what`.
 */
export function* unpackSlices(body: Uint8Array, what: string, enough = Infinity): Generator<number, Uint8Array> {
  const { method, rawLength, packed } = readPacking(body, what);
  if (method === 0) return packed;
  const raw = new Uint8Array(Math.min(rawLength, enough === Infinity ? rawLength : enough + 128 * 1024));
  let filled = 0;
  const stream = new Decompress((piece) => {
    if (filled + piece.length > rawLength) throw new RecordingError(`${what}: expands beyond ${rawLength} bytes`);
    raw.set(piece.subarray(0, raw.length - filled), filled);
    filled = Math.min(raw.length, filled + piece.length);
  });
  for (let at = 0; at < packed.length; at += sliceBytes) {
    try {
      stream.push(packed.subarray(at, at + sliceBytes), at + sliceBytes >= packed.length);
    } catch (error) {
      if (error instanceof RecordingError) throw error;
      throw new RecordingError(`${what}: the zstd frame is broken (${(error as Error).message})`);
    }
    if (filled >= enough) return raw.subarray(0, filled);
    yield filled;
  }
  if (filled !== rawLength)
    throw new RecordingError(`${what}: found ${filled} bytes in the zstd frame; expected ${rawLength}`);
  return raw;
}

/** Runs a generator to its end and returns its result. */
export function finish<T>(work: Generator<unknown, T>): T {
  for (;;) {
    const step = work.next();
    if (step.done) return step.value;
  }
}

/** Unpacks a body in one call; with `enough`, at least that many of its first bytes. */
export function unpack(body: Uint8Array, what: string, enough = Infinity): Uint8Array {
  return finish(unpackSlices(body, what, enough));
}
