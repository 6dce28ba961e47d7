/** Tests of picking, world boxes, interpolation and playback, without drawing. */
import assert from "node:assert/strict";
import { test } from "node:test";
import { type PageState, readHash, writeHash } from "../../src/hash";
import type { Vec3 } from "../../src/model";
import { Playback } from "../../src/playback";
import { Recording } from "../../src/recording";
import { worldBox } from "../../src/scene/bounds";
import { makeParts, partsOfSelection } from "../../src/scene/parts";
import { pick } from "../../src/scene/pick";
import { Poses } from "../../src/scene/poses";
import { traitsOf } from "../../src/shapes/list";
import { describeShape, listShapes, speedBetween } from "../../src/ui/body_panel";
import { makeFixture, tileAt } from "../fixtures";

const recording = Recording.openNow(makeFixture({ frames: 100, columns: 8, courses: 6 }).file);
const posesAt = (number: number) => {
  const poses = new Poses(recording.tables.bodies.length);
  poses.mix(recording.frame(number), recording.frame(number), 0);
  return poses;
};

test("a ray from above picks the body under it, not the ground and not a sensor", () => {
  const poses = posesAt(0);
  const { tables } = recording;
  for (const name of ["ball", "capsule", "drum", "crystal", "lift"]) {
    const row = tables.bodies.findIndex((body) => body.name === name);
    const origin: Vec3 = [poses.positions[3 * row], 50, poses.positions[3 * row + 2]];
    assert.equal(pick(tables, poses, { origin, direction: [0, -1, 0] })?.body, row, name);
  }
  assert.equal(
    tables.bodies[pick(tables, poses, { origin: [40, 5, 0], direction: [0, -1, 0] })?.body ?? -1].name,
    "ground",
  );
  assert.equal(pick(tables, poses, { origin: [40, 5, 0], direction: [0, 1, 0] }), null);
});

test("a body that is not present cannot be picked", () => {
  const row = recording.tables.bodies.findIndex(({ name }) => name === "late");
  const over = (number: number) => {
    const poses = posesAt(number);
    const origin: Vec3 = [-6, 50, 2];
    return pick(recording.tables, poses, { origin, direction: [0, -1, 0] })?.body;
  };
  assert.notEqual(over(0), row);
  assert.equal(over(31), row);
});

test("world boxes are tight bounds of their shapes", () => {
  const poses = posesAt(60);
  const { tables } = recording;
  const parts = makeParts(tables);
  assert.ok(parts.length >= tables.bodies.length - 1);
  for (const collider of tables.colliders) {
    const shape = tables.shapes[collider.shape];
    const box = worldBox(tables, collider, poses);
    if (traitsOf(shape).isGround) {
      assert.equal(box, null);
      continue;
    }
    assert.ok(box);
    const middle = box.lo.map((x, i) => (x + box.hi[i]) / 2) as Vec3;
    for (let axis = 0; axis < 3; ++axis)
      for (const sign of [-1, 1]) {
        const plane = sign < 0 ? box.lo[axis] : box.hi[axis];
        assert.ok(Math.abs(plane - poses.positions[3 * collider.body + axis]) < 3);
        // rays parallel to a face, just outside of it, miss the shape
        const origin: Vec3 = [...middle];
        origin[axis] = plane + sign * 0.001;
        const along = (axis + 1) % 3;
        origin[along] -= 50;
        const direction: Vec3 = [0, 0, 0];
        direction[along] = 1;
        assert.notEqual(pick(tables, poses, { origin, direction })?.collider, tables.colliders.indexOf(collider));
      }
  }
});

test("between two frames positions are interpolated and rotations stay unit", () => {
  const [a, b] = [recording.frame(80), recording.frame(81)];
  const poses = new Poses(recording.tables.bodies.length);
  poses.mix(a, b, 0.25);
  for (let i = 0; i < a.positions.length; ++i)
    assert.ok(Math.abs(poses.positions[i] - (0.75 * a.positions[i] + 0.25 * b.positions[i])) < 1e-12);
  for (let row = 0; row < poses.count; ++row)
    assert.ok(Math.abs(Math.hypot(...poses.rotations.subarray(4 * row, 4 * row + 4)) - 1) < 1e-5);
});

test("speed is computed from two frames", () => {
  const row = recording.tables.bodies.findIndex(({ name }) => name === "ball");
  const speed = speedBetween(row, recording.frame(1), recording.frame(3));
  const time = 2 / 60;
  assert.ok(speed !== null && Math.abs(speed - Math.hypot(5.5 - 9.81 * time, 12.5)) < 0.05);
  assert.equal(speedBetween(row, recording.frame(1), recording.frame(1)), null);
});

test("playback runs at its speed, stops at the end and restarts", () => {
  let changes = 0;
  const playback = new Playback(11, 0.1, () => ++changes);
  playback.advance(1);
  assert.equal(playback.frame, 0, "it does not move before it is started");
  playback.toggle();
  playback.advance(0.05);
  assert.equal(playback.frame, 0);
  assert.ok(Math.abs(playback.share - 0.5) < 1e-9);
  playback.setSpeed(4);
  playback.advance(0.05);
  assert.equal(playback.frame, 2);
  for (let i = 0; i < 10; ++i) playback.advance(0.1);
  assert.equal(playback.frame, 10);
  assert.equal(playback.playing, false);
  playback.toggle();
  assert.equal(playback.frame, 0);
  assert.ok(changes > 5);
});

test("steps and seeks stay within the recording", () => {
  const playback = new Playback(5, 0.1, () => {});
  playback.step(-1);
  assert.equal(playback.frame, 0);
  playback.seek(99);
  assert.equal(playback.frame, 4);
  playback.step(1);
  assert.equal(playback.frame, 4);
  playback.step(-1);
  assert.equal(playback.frame, 3);
  playback.faster(1);
  assert.equal(playback.speed, 2);
  for (let i = 0; i < 9; ++i) playback.faster(-1);
  assert.equal(playback.speed, 0.1);
});

test("everything that is shown round-trips through the address", () => {
  const state: PageState = {
    frame: 120,
    camera: [1.5, -2, 3.25, 0, 0.125, 1e6],
    selection: { body: 7, shape: 1203 },
    colouring: "island",
    shown: ["boxes", "charts"],
  };
  assert.deepEqual(readHash(writeHash(state)), state);
  for (const selection of ["none", { body: 0, shape: null }, { body: 3, shape: 0 }] as const)
    assert.deepEqual(readHash(writeHash({ ...state, selection })).selection, selection);
  for (const shown of [[], ["contacts"], ["boxes", "contacts", "charts"]] as PageState["shown"][])
    assert.deepEqual(readHash(writeHash({ ...state, shown })).shown, shown);
});

test("an address that says nothing, or nothing valid, changes nothing", () => {
  const nothing = { frame: null, camera: null, selection: null, colouring: null, shown: null };
  assert.deepEqual(readHash(""), nothing);
  for (const hash of [
    "#f=-3&c=1,2,x&p=&by=pink",
    "#f=1.5&c=1,2,3,4,5&p=x&by=",
    "#f=&c=0,0,0,0,0,0&p=3:0",
    "#f=9e99&c=,,,,,&p=1:2:3",
    "#f=0x10&p=-1&c=1,2,3,4,5,Infinity&by=constructor",
    "#%E0%A4%A&nonsense&=&f",
  ])
    assert.deepEqual(readHash(hash), nothing, hash);
  assert.deepEqual(readHash("#show=charts,pink,boxes").shown, ["boxes", "charts"]);
  assert.equal(readHash("#c=1,x&f=12").frame, 12, "the rest of a broken address counts");
});

test("of a body with many shapes, the one that was hit is picked, outlined and named", () => {
  const tiles = 1280;
  const level = Recording.openNow(makeFixture({ frames: 4, columns: 4, courses: 2, tiles }).file);
  const { tables } = level;
  const row = tables.bodies.findIndex(({ name }) => name === "level");
  const poses = new Poses(tables.bodies.length);
  poses.mix(level.frame(0), level.frame(0), 0);
  const parts = makeParts(tables);
  for (const n of [1, 39, 40, 1279]) {
    const tile = tileAt(n);
    const origin = tile.map((x, i) => x + poses.positions[3 * row + i]) as Vec3;
    const picked = pick(tables, poses, { origin: [origin[0], 20, origin[2]], direction: [0, -1, 0] });
    assert.equal(picked?.body, row);
    const shape = tables.bodies[row].colliders.indexOf(picked.collider);
    assert.equal(shape, n);
    const shown = partsOfSelection(tables, parts, { body: row, shape });
    assert.equal(shown.length, 1);
    shown[0].pose.position.forEach((x, i) => assert.ok(Math.abs(x - tile[i]) < 1e-5));
    assert.deepEqual(describeShape(tables, { body: row, shape }), [
      ["shape", "box 0.6 × 0.6 × 0.6 m"],
      ["", `number ${(n + 1).toLocaleString("en-GB")} of 1,280`],
    ]);
    assert.deepEqual(listShapes(tables, level.frame(0), row), [
      ["shapes", "64 × box 0.6 × 0.6 × 0.6 m"],
      ["", "and 1,216 more"],
    ]);
  }
  assert.equal(partsOfSelection(tables, parts, { body: row, shape: null }).length, tiles);
  const ball = tables.bodies.findIndex(({ name }) => name === "ball");
  assert.deepEqual(describeShape(tables, { body: ball, shape: 0 }), []);
  assert.deepEqual(listShapes(tables, level.frame(0), ball), [["shapes", "sphere r 0.6 m"]]);
});
