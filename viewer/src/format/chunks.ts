/** Finds the chunks of a recording: magic, version, then from check to check up to the first that is not whole. */
import { RecordingError } from "./bytes";
import { crc32 } from "./crc32";

export const readsVersion = 1;
const headerBytes = 16;
const bytesBeforePause = 8 * 1024 * 1024;

/** One chunk: its four letters, where it begins in the file, and its body. */
export interface Chunk {
  type: string;
  offset: number;
  body: Uint8Array;
}

/** All whole chunks; `lost` says in words why the walk ended before the end of the file, or is empty. */
export interface ChunkList {
  chunks: Chunk[];
  lost: string;
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
    throw new RecordingError("byte 12: the header is damaged (wrong check)");
  if (version !== readsVersion)
    throw new RecordingError(
      `version ${version}, this viewer reads ${readsVersion}` +
        (version > readsVersion ? ": open it with a newer Fase" : ""),
    );
}

/** Walks the file; yields the share that is checked (0 to 1) now and then. Throws when not even the header holds. */
export function* walkChunks(file: Uint8Array): Generator<number, ChunkList> {
  checkHeader(file);
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
  const chunks: Chunk[] = [];
  let pause = bytesBeforePause;
  let at = headerBytes;
  while (at < file.length) {
    const lost = (why: string): ChunkList => ({ chunks, lost: `byte ${at}: ${why}` });
    if (file.length - at < 12) return lost("the file ends inside a chunk");
    const length = view.getUint32(at + 4, true);
    const end = at + 8 + length;
    if (end + 4 > file.length) return lost("the file ends inside a chunk");
    if (view.getUint32(end, true) !== crc32(file, at, end)) return lost("a chunk is damaged (wrong check)");
    const type = ascii(file, at, 4);
    if (!/^[A-Za-z]{4}$/.test(type)) return lost("found no type of chunk");
    if (type === "INDX") break; // only the tail follows
    chunks.push({ type, offset: at, body: file.subarray(at + 8, end) });
    at = end + 4;
    if (at > pause) {
      yield at / file.length;
      pause = at + bytesBeforePause;
    }
  }
  return { chunks, lost: "" };
}
