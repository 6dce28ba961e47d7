/** Decodes the events and contact points at the end of a frame. */
import type { ContactPoints, FrameEvents, HitEvent, PairEvent, Tables, Vec3 } from "../model";
import type { Reader } from "./bytes";

/** Reads the columns a and b of a list of collider pairs. */
function readPairs(read: Reader, count: number, tables: Tables): PairEvent[] {
  const limit = tables.colliders.length;
  const a = read.running(count);
  const pairs: PairEvent[] = [];
  for (let i = 0; i < count; ++i) {
    const b = a[i] + read.varint();
    for (const row of [a[i], b])
      if (row < 0 || row >= limit) read.fail(`found collider row ${row}; expected 0 to ${limit - 1}`);
    pairs.push({ a: a[i], b });
  }
  return pairs;
}

const readPairList = (read: Reader, tables: Tables) => readPairs(read, read.count(2), tables);

/** Reads three columns of quanta; returns points in metres, three numbers each. */
function readPoints(read: Reader, count: number, tables: Tables): Float64Array {
  const points = new Float64Array(3 * count);
  for (let axis = 0; axis < 3; ++axis) {
    const column = read.running(count);
    for (let i = 0; i < count; ++i) points[3 * i + axis] = column[i] / tables.quantaPerMetre;
  }
  return points;
}

function readHits(read: Reader, tables: Tables): HitEvent[] {
  const count = read.count(25);
  const pairs = readPairs(read, count, tables);
  const points = readPoints(read, count, tables);
  const normals = read.floats(3 * count);
  const speeds = read.floats(count);
  const impulses = read.floats(count);
  const three = (from: Float64Array | Float32Array, i: number) => Array.from(from.subarray(3 * i, 3 * i + 3)) as Vec3;
  return pairs.map((pair, i) => ({
    ...pair,
    point: three(points, i),
    normal: three(normals, i),
    speed: speeds[i],
    impulse: impulses[i],
  }));
}

export function readEvents(read: Reader, tables: Tables): FrameEvents {
  const contactsBegun = readPairList(read, tables);
  const contactsEnded = readPairList(read, tables);
  const sensorsBegun = readPairList(read, tables);
  const sensorsEnded = readPairList(read, tables);
  return { contactsBegun, contactsEnded, sensorsBegun, sensorsEnded, hits: readHits(read, tables) };
}

export function readContacts(read: Reader, tables: Tables): ContactPoints {
  const count = read.count(15);
  readPairs(read, count, tables);
  const pointsOf = read.octets(count);
  const normalOf = read.floats(3 * count);
  let total = 0;
  for (const points of pointsOf) {
    if (points > 4) read.fail(`found a contact of ${points} points; expected 0 to 4`);
    total += points;
  }
  if (total * 11 > read.left) read.fail(`found ${total} contact points, but only ${read.left} bytes follow`);
  const points = readPoints(read, total, tables);
  const separations = read.floats(total);
  const impulses = read.floats(total);
  const normals = new Float32Array(3 * total);
  for (let i = 0, at = 0; i < count; ++i)
    for (let k = 0; k < pointsOf[i]; ++k, ++at) normals.set(normalOf.subarray(3 * i, 3 * i + 3), 3 * at);
  return { points, normals, separations, impulses };
}
