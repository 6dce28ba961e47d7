/** Reads the chart data of each frame of a block; skips the bodies. */
import type { Summary, Tables } from "../model";
import { Reader } from "./bytes";
import { readBlockLayout, readFrameHead } from "./frames";

/** Skips a row list with `varuints` columns of numbers and `bytes` more per row. Returns the number of rows. */
function skipRows(read: Reader, varuints: number, bytes: number): number {
  const count = read.count(1);
  for (let i = 0; i < count; ++i) read.varuint();
  for (let i = 0; i < count * varuints; ++i) read.varuint();
  read.advance(count * bytes);
  return count;
}

function skipPairs(read: Reader): number {
  const count = read.count(2);
  for (let i = 0; i < 2 * count; ++i) read.varuint();
  return count;
}

export function readSummaries(raw: Uint8Array, tables: Tables): Summary[] {
  const { first, begins, ends } = readBlockLayout(raw);
  return begins.map((begin, i) => {
    const read = new Reader(raw.subarray(begin, ends[i]), `frame ${first + i}`);
    const { isKey, step, time, total, stages, counters } = readFrameHead(read, tables);
    const removed = skipRows(read, 0, 0);
    const added = readAddedCount(read);
    skipRows(read, 0, 1); // flags
    skipRows(read, 1, 0); // islands
    skipPoses(read); // jumped
    skipRows(read, 0, 12); // moved
    skipPairs(read);
    skipPairs(read);
    const sensors = skipPairs(read) + skipPairs(read);
    const hits = read.count(25);
    return { step, time, total, stages, counters, hits, sensors, added: isKey ? 0 : added, removed };
  });
}

function skipPoses(read: Reader): void {
  const count = skipRows(read, 3, 0);
  read.advance(6 * count);
}

function readAddedCount(read: Reader): number {
  const count = skipRows(read, 0, 1);
  for (let i = 0; i < 3 * count; ++i) read.varuint();
  read.advance(6 * count);
  for (let i = 0; i < count; ++i) read.varuint();
  return count;
}
