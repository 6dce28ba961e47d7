/** Tests the decoder against an independent encoder of the same format (format.md). */
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { Recording } from "../../src/recording";
import { finish } from "../../src/format/unpack";
import type { Frame, Summary } from "../../src/model";
import { rotate } from "../../src/scene/maths";
import {
  bodies,
  chunk,
  colliderEnds,
  colliders,
  fileHeader,
  FrameEncoder,
  head,
  join,
  plain,
  shapes,
  zstdRaw,
  type BodyInput,
  type FrameInput,
} from "../encode";
import { type Fixture, makeFixture, quanta } from "../fixtures";

const small = { frames: 100, columns: 8, courses: 6 };

/** Compares a decoded body with the input, within the quantization error. */
function assertBody(frame: Frame, input: BodyInput): void {
  const { row } = input;
  assert.equal(frame.present[row], 1);
  assert.equal(frame.flags[row], input.flags);
  assert.equal(frame.islands[row], input.island);
  for (let i = 0; i < 3; ++i) assert.ok(Math.abs(frame.positions[3 * row + i] - input.position[i]) <= 0.51 / quanta);
  const q = [...frame.rotations.subarray(4 * row, 4 * row + 4)];
  const cosine = Math.abs(q.reduce((sum, x, i) => sum + x * input.rotation[i], 0)) / Math.hypot(...input.rotation);
  assert.ok(2 * Math.acos(Math.min(1, cosine)) < (0.1 * Math.PI) / 180, `row ${row}`);
}

function assertFrame(frame: Frame, input: FrameInput): void {
  assert.equal(frame.step, input.step);
  assert.equal(frame.time, input.time);
  assert.equal(
    frame.present.reduce((sum, x) => sum + x, 0),
    input.bodies.length,
  );
  for (const body of input.bodies) assertBody(frame, body);
  assert.deepEqual(frame.events.contactsBegun, input.contactsBegun ?? []);
  assert.deepEqual(frame.events.contactsEnded, input.contactsEnded ?? []);
  assert.deepEqual(frame.events.sensorsBegun, input.sensorsBegun ?? []);
  assert.deepEqual(frame.events.sensorsEnded, input.sensorsEnded ?? []);
  assert.deepEqual(
    frame.events.hits.map(({ a, b, speed }) => ({ a, b, speed })),
    (input.hits ?? []).map(({ a, b, speed }) => ({ a, b, speed })),
  );
  const points = (input.contacts ?? []).flatMap(({ points }) => points);
  assert.equal(frame.contacts?.impulses.length, points.length);
  points.forEach(({ at }, i) =>
    at.forEach((x, k) => assert.ok(Math.abs((frame.contacts?.points[3 * i + k] ?? NaN) - x) < 0.51 / quanta)),
  );
}

const summariesOf = (recording: Recording): Summary[] => {
  const summaries: Summary[] = [];
  finish(recording.readSummaries(summaries));
  return summaries;
};

for (const [name, pack] of [
  ["plain", plain],
  ["zstd", zstdRaw],
] as const)
  test(`every frame of a ${name} recording round-trips`, () => {
    const { file, inputs } = makeFixture({ ...small, pack });
    const recording = Recording.openNow(file);
    assert.equal(recording.damage, "");
    assert.equal(recording.frameCount, inputs.length);
    inputs.forEach((input, i) => assertFrame(recording.frame(i), input));
  });

test("frames read in any order equal frames read in sequence", () => {
  const { file, inputs } = makeFixture(small);
  const recording = Recording.openNow(file);
  for (const i of [99, 0, 50, 49, 48, 98, 31, 32, 33, 1, 64]) assertFrame(recording.frame(i), inputs[i]);
});

test("the shared tables are read: names, numbers, colours, shapes, visuals", () => {
  const { tables } = Recording.openNow(makeFixture(small).file);
  assert.equal(tables.title, "test wall");
  assert.ok(Math.abs(tables.timeStep - 1 / 60) < 1e-8);
  assert.equal(tables.stageNames[4], "solve");
  assert.equal(tables.bodies[1].name, "ball");
  assert.equal(tables.bodies[1].colour, 0xc0392b);
  assert.equal(tables.bodies[2].colour, null);
  assert.equal(tables.bodies[1].user, 1n + (1n << 40n));
  assert.deepEqual(
    tables.shapes.slice(0, 5).map(({ kind }) => kind),
    ["half-space", "box", "sphere", "capsule", "cylinder"],
  );
  assert.equal(tables.visuals[0].colour, 0x9ad0a0);
  assert.ok(tables.colliders[6].sensor);
});

test("summaries hold stage times, counters and the number of events", () => {
  const { file, inputs } = makeFixture(small);
  const summaries = summariesOf(Recording.openNow(file));
  assert.equal(summaries.length, inputs.length);
  summaries.forEach((summary, i) => {
    assert.deepEqual(summary.counters, inputs[i].counters);
    summary.stages.forEach((ms, k) => assert.ok(Math.abs(ms - inputs[i].stages[k]) < 1e-5));
    assert.equal(summary.hits, inputs[i].hits?.length);
    assert.equal(summary.sensors, (inputs[i].sensorsBegun?.length ?? 0) + (inputs[i].sensorsEnded?.length ?? 0));
  });
  assert.equal(summaries[30].added, 1, "one body is added at half a second");
});

test("a recording truncated anywhere opens with all complete blocks", () => {
  const { file, chunkOffsets }: Fixture = makeFixture({ frames: 70, columns: 2, courses: 2, blockFrames: 16 });
  const ends = [...chunkOffsets.slice(1), file.length];
  const blockEnds = ends.slice(-5);
  for (let length = 0; length < file.length; length += length < 600 ? 1 : 97) {
    const cut = file.subarray(0, length);
    const complete = blockEnds.filter((end) => end <= length).length;
    if (complete === 0) {
      assert.throws(() => Recording.openNow(cut), { name: "RecordingError" });
      continue;
    }
    const recording = Recording.openNow(cut);
    assert.equal(recording.frameCount, 16 * complete);
    assert.equal(recording.damage === "", ends.includes(length), `${length}: ${recording.damage}`);
    recording.frame(recording.frameCount - 1);
  }
});

test("a flipped bit ends the recording before its chunk; no wrong frame is shown", () => {
  const { file, inputs, chunkOffsets } = makeFixture({ frames: 40, columns: 2, courses: 1, blockFrames: 8 });
  for (let at = 0; at < file.length; at += at < 400 ? 1 : 23) {
    const damaged = file.slice();
    damaged[at] ^= 1 << (at % 8);
    const firstBlock = chunkOffsets[chunkOffsets.length - 5];
    if (at < firstBlock) {
      assert.throws(() => Recording.openNow(damaged), { name: "RecordingError" }, `byte ${at}`);
      continue;
    }
    if (at < chunkOffsets[chunkOffsets.length - 4]) {
      assert.throws(() => Recording.openNow(damaged), { name: "RecordingError" });
      continue;
    }
    const recording = Recording.openNow(damaged);
    assert.ok(recording.frameCount < inputs.length && recording.damage !== "");
    assertFrame(recording.frame(recording.frameCount - 1), inputs[recording.frameCount - 1]);
  }
});

test("damage with a valid checksum gives a RecordingError, never a crash", () => {
  const { inputs } = makeFixture({ frames: 6, columns: 2, courses: 1 });
  const encoder = new FrameEncoder(quanta);
  inputs.forEach((input) => encoder.add(input));
  const raw = encoder.takeBlock();
  const fixture = makeFixture({ frames: 6, columns: 2, courses: 1 });
  const before = fixture.file.subarray(0, fixture.chunkOffsets[fixture.chunkOffsets.length - 1]);
  for (let at = 0; at < raw.length; ++at) {
    const damaged = raw.slice();
    damaged[at] ^= 0xff;
    try {
      const recording = Recording.openNow(join(before, chunk("FRMS", damaged)));
      for (let i = 0; i < recording.frameCount; ++i) recording.frame(i);
      summariesOf(recording);
    } catch (error) {
      assert.equal((error as Error).name, "RecordingError", `byte ${at}: ${(error as Error).stack}`);
    }
  }
});

test("other files, other versions and empty recordings are refused with a reason", () => {
  assert.throws(() => Recording.openNow(new Uint8Array(0)), /empty/);
  assert.throws(() => Recording.openNow(new TextEncoder().encode("glTF....................")), /not a Fase recording/);
  assert.throws(() => Recording.openNow(fileHeader(7)), /version 7; this viewer reads 1/);
  assert.throws(() => Recording.openNow(fileHeader()), /no HEAD/);
  const { file, chunkOffsets } = makeFixture({ frames: 1, columns: 1, courses: 1 });
  assert.throws(() => Recording.openNow(file.subarray(0, chunkOffsets[7])), /no frames/);
});

/** Returns a recording of one ball with the given frames. */
function tiny(frames: FrameInput[], more: Uint8Array[] = []): Uint8Array {
  const encoder = new FrameEncoder(quanta);
  frames.forEach((frame) => encoder.add(frame));
  const body = { index: 4, generation: 2, kind: 2, user: 7n, mass: 1, colour: null, name: "" };
  return join(
    fileHeader(),
    chunk(
      "HEAD",
      join(
        head({
          title: "",
          timeStep: 0.01,
          quantaPerMetre: quanta,
          hasContacts: false,
          stageNames: [],
          counterNames: [],
        }),
        new Uint8Array(9),
      ),
    ),
    chunk("SHAP", shapes([{ kind: "sphere", radius: 1 }])),
    chunk("BODY", bodies([body])),
    chunk(
      "COLL",
      colliders([
        { body: 0, shape: 0 },
        { body: 0, shape: 0, from: 2 },
      ]),
    ),
    chunk("FRMS", encoder.takeBlock()),
    ...more,
  );
}
const frameOf = (step: number, bodies: BodyInput[]): FrameInput => ({
  step,
  time: step / 100,
  total: 1,
  stages: [],
  counters: [],
  bodies,
});
const at = (x: number): BodyInput => ({ row: 0, position: [x, 0, 0], rotation: [0, 0, 0, 1], flags: 9, island: 0 });

test("a body that rests, moves, jumps, goes far away and returns has the right position", () => {
  const positions = [0, 0.1, 0.25, 0.25, 0.3, 0.6, 5000, 5000.2, -9e6, -9e6, 3, 3.1];
  const recording = Recording.openNow(tiny(positions.map((x, i) => frameOf(i, [at(x)]))));
  positions.forEach((x, i) => assert.ok(Math.abs(recording.frame(i).positions[0] - x) < 0.51 / quanta, `frame ${i}`));
});

test("decoded rotations rotate points like the input", () => {
  const rotations = [
    [0.5, 0.5, 0.5, 0.5],
    [-0.9, 0.1, 0.3, -0.2],
    [0.1, -0.99, 0, 0.05],
    [0.2, 0.1, -0.95, 0.1],
    [0, 0, 0.05, -0.99],
  ] as const;
  const recording = Recording.openNow(tiny(rotations.map((q, i) => frameOf(i, [{ ...at(0), rotation: [...q] }]))));
  rotations.forEach((q, i) => {
    const norm = Math.hypot(...q);
    const expected = rotate([q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm], [1, 2, 3]);
    const actual = rotate([...recording.frame(i).rotations] as [number, number, number, number], [1, 2, 3]);
    expected.forEach((x, k) => assert.ok(Math.abs(x - actual[k]) < 2e-3));
  });
});

test("colliders exist in their frames; unknown chunks and the index are skipped", () => {
  const index = chunk("INDX", new Uint8Array(4));
  const file = tiny(
    [0, 1, 2, 3].map((i) => frameOf(i, [at(i)])),
    [
      chunk("CEND", colliderEnds([{ collider: 0, frame: 3 }])),
      chunk("ZZZZ", new Uint8Array(5)),
      index,
      new Uint8Array(16),
    ],
  );
  const { tables, damage } = Recording.openNow(file);
  assert.equal(damage, "");
  assert.deepEqual(
    tables.colliders.map(({ from, to }) => [from, to]),
    [
      [0, 3],
      [2, Infinity],
    ],
  );
});

const real = process.env.FASE_RECORDING;
test(
  "a recording of the program decodes from end to end",
  { skip: real ? false : "skipped: FASE_RECORDING names no recording" },
  () => {
    const recording = Recording.openNow(new Uint8Array(readFileSync(real as string)));
    assert.equal(recording.damage, "");
    assert.ok(recording.frameCount > 0 && recording.tables.bodies.length > 0);
    const summaries = summariesOf(recording);
    assert.equal(summaries.length, recording.frameCount);
    for (let i = 0; i < recording.frameCount; ++i) {
      const frame = recording.frame(i);
      assert.ok(frame.positions.every(Number.isFinite) && frame.rotations.every(Number.isFinite));
      assert.equal(frame.step, summaries[i].step);
      const bodies = recording.tables.counterNames.indexOf("bodies");
      if (bodies >= 0 && frame.step > 0)
        assert.equal(
          frame.present.reduce((sum, x) => sum + x, 0),
          summaries[i].counters[bodies],
          `frame ${i}`,
        );
    }
  },
);
