/** Finds the chunks of a recording: checks magic and version, then each chunk up to the first damaged one. */
import { RecordingError } from "./bytes";
import { crc32 } from "./crc32";

export const supportedVersion = 1;
const headerBytes = 16;
const bytesBeforePause = 8 * 1024 * 1024;

/** One chunk: its four-letter type, its offset in the file, and its body. */
export interface Chunk {
  type: string;
  offset: number;
  body: Uint8Array;
}

/** All complete chunks. `damage` explains why the scan stopped before the end of the file, or is empty. */
export interface ChunkList {
  chunks: Chunk[];
  damage: string;
}

const ascii = (bytes: Uint8Array, at: number, count: number) => String.fromCharCode(...bytes.subarray(at, at + count));

function checkHeader(file: Uint8Array): void {
  if (file.length === 0) throw new RecordingError("the file is empty");
  const magic = ascii(file, 0, Math.min(8, file.length));
  if (!"FASEREC\n".startsWith(magic))
    throw new RecordingError("this is not a Fase recording: it does not begin with FASEREC");
  if (file.length < headerBytes)
    throw new RecordingError(`the file ends after ${file.length} bytes, inside its header`);
  const view = new DataView(file.buffer, file.byteOffset);
  const version = view.getUint32(8, true);
  if (view.getUint32(12, true) !== crc32(file, 0, 12))
    throw new RecordingError("byte 12: the header is damaged (wrong checksum)");
  if (version !== supportedVersion)
    throw new RecordingError(
      `found version ${version}; this viewer reads ${supportedVersion}` +
        (version > supportedVersion ? ": open it with a newer Fase" : ""),
    );
}

/** Scans the file. Yields the checked share (0 to 1) from time to time. Throws when the header is invalid. */
export function* walkChunks(file: Uint8Array): Generator<number, ChunkList> {
  checkHeader(file);
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
  const chunks: Chunk[] = [];
  let pause = bytesBeforePause;
  let at = headerBytes;
  while (at < file.length) {
    const damage = (why: string): ChunkList => ({ chunks, damage: `byte ${at}: ${why}` });
    if (file.length - at < 12) return damage("the file ends inside a chunk");
    const length = view.getUint32(at + 4, true);
    const end = at + 8 + length;
    if (end + 4 > file.length) return damage("the file ends inside a chunk");
    if (view.getUint32(end, true) !== crc32(file, at, end)) return damage("a chunk is damaged (wrong checksum)");
    const type = ascii(file, at, 4);
    if (!/^[A-Za-z]{4}$/.test(type)) return damage("found an invalid chunk type");
    if (type === "INDX") break; // only the tail follows
    chunks.push({ type, offset: at, body: file.subarray(at + 8, end) });
    at = end + 4;
    if (at > pause) {
      yield at / file.length;
      pause = at + bytesBeforePause;
    }
  }
  return { chunks, damage: "" };
}
