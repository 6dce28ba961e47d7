/** Tests of what moving pictures leave out: the levels of savings, and simplified shapes. */
import assert from "node:assert/strict";
import { test } from "node:test";
import { Mesh } from "three";
import type { Triangles, Vec3 } from "../../src/model";
import { Recording } from "../../src/recording";
import { coarsest, DetailedBodies } from "../../src/scene/detail";
import { coarseTriangles } from "../../src/scene/geometries";
import { coarseShapes } from "../../src/scene/merged_batch";
import { makeParts } from "../../src/scene/parts";
import { Poses } from "../../src/scene/poses";
import { Quality } from "../../src/scene/quality";
import { simplify } from "../../src/scene/simplify";
import { traitsOf } from "../../src/shapes/list";
import { makeFixture } from "../fixtures";
import { examples, octahedron } from "../shapes";

/** Records pictures for some seconds on a machine that needs `cost(saving)` milliseconds for each. Returns the last interval. */
function play(quality: Quality, seconds: number, cost: (saving: Quality["saving"]) => number): number {
  let interval = 0;
  for (let ms = 0; ms < 1000 * seconds; ms += interval) {
    interval = Math.max(16, cost(quality.saving));
    quality.record(interval);
  }
  return interval;
}

test("a fast machine leaves nothing out", () => {
  const quality = new Quality(3);
  play(quality, 30, () => 4);
  assert.deepEqual(quality.saving, { share: 1, shadows: true, coarser: 0 });
});

test("where pixels are slow, moving pictures have fewer of them, and the rest stays", () => {
  const quality = new Quality(3);
  const last = play(quality, 20, ({ share }) => 5 + 120 * share * share);
  assert.ok(last < 50, `${last} ms`);
  assert.ok(quality.saving.shadows && quality.saving.coarser === 0);
});

test("where shapes are slow, shadows and detail are left out until five pictures a second are drawn", () => {
  const cost = ({ share, shadows, coarser }: Quality["saving"]) =>
    400 * share * share + ((shadows ? 2 : 1) * 1500) / 4 ** coarser;
  for (const level of [0, 2]) {
    const quality = new Quality(3, level);
    const last = play(quality, 20, cost);
    assert.ok(last <= 200, `${last} ms`);
    assert.equal(quality.saving.shadows, false);
    assert.ok(quality.saving.coarser >= 1);
  }
});

test("five slow pictures are enough to reach the coarsest level", () => {
  const quality = new Quality(2);
  for (let i = 0; i < 5; ++i) quality.record(1000);
  assert.equal(quality.saving.coarser, 2);
});

test("when a machine becomes fast again, detail, shadows and pixels come back", () => {
  const quality = new Quality(3, 4);
  play(quality, 60, () => 12);
  assert.deepEqual(quality.saving, { share: 1, shadows: true, coarser: 0 });
});

test("savings do not go up and down all the time", () => {
  const quality = new Quality(3);
  let changes = 0;
  let before = "";
  play(quality, 120, (saving) => {
    if (JSON.stringify(saving) !== before) ++changes;
    before = JSON.stringify(saving);
    return saving.shadows ? 300 : 25;
  });
  assert.ok(changes < 40, `${changes} changes in two minutes`);
});

test("simplified shapes stay within their box, keep most of its size, and have fewer triangles", () => {
  for (const shape of examples)
    for (const { form } of traitsOf(shape).pieces(shape)) {
      const fine = coarseTriangles(form, 1000);
      for (const cells of [5, 3, 2]) {
        const coarse = simplify(fine, cells);
        assert.ok(coarse.triangles.length > 0 && coarse.triangles.length <= fine.triangles.length);
        assert.ok(coarse.triangles.every((vertex) => 3 * vertex < coarse.vertices.length));
        for (let axis = 0; axis < 3; ++axis) {
          const range = (vertices: Float32Array) => {
            const along = vertices.filter((_, i) => i % 3 === axis);
            return [Math.min(...along), Math.max(...along)];
          };
          const [lo, hi] = range(fine.vertices);
          const [coarseLo, coarseHi] = range(coarse.vertices);
          assert.ok(coarseLo >= lo && coarseHi <= hi, `${shape.kind}, ${cells} cells`);
          assert.ok(coarseHi - coarseLo > 0.5 * (hi - lo), `${shape.kind}, ${cells} cells`);
        }
      }
      assert.ok(simplify(fine, 2).triangles.length <= 3 * 20, shape.kind);
    }
});

test("a box keeps its eight corners at any degree of detail", () => {
  const box = examples.find(({ kind }) => kind === "box");
  assert.ok(box);
  const { form } = traitsOf(box).pieces(box)[0];
  for (const cells of [5, 3, 2]) {
    const { vertices, triangles } = coarseTriangles(form, cells);
    assert.deepEqual([vertices.length / 3, triangles.length / 3], [8, 12]);
  }
});

test("what is static keeps its triangles", () => {
  const { tables } = Recording.openNow(makeFixture({ frames: 2, columns: 4, courses: 2, tiles: 100 }).file);
  const parts = makeParts(tables);
  const fine: Triangles = { ...octahedron(1), triangles: new Uint32Array(300).map((_, i) => i % 6) };
  const shapes = coarseShapes(
    parts.map((part) => ({ ...part, form: fine })),
    2,
  );
  assert.ok(parts.some(({ isStatic }) => isStatic) && parts.some(({ isStatic }) => !isStatic));
  shapes.forEach((shape, i) => assert.equal(shape === fine, parts[i].isStatic));
});

test("coarse bodies stand where the fine ones stand", () => {
  const opened = Recording.openNow(makeFixture({ frames: 90, columns: 8, courses: 6 }).file);
  const { tables } = opened;
  const origin: Vec3 = [1, 2, 3];
  const bodies = new DetailedBodies(tables, origin);
  const poses = new Poses(tables.bodies.length);
  for (const number of [10, 80]) {
    poses.mix(opened.frame(number), opened.frame(number), 0);
    assert.ok(bodies.show(poses, "material", coarsest));
    const brick = tables.bodies.length - 1;
    const middle = [0, 1, 2].map((i) => poses.positions[3 * brick + i] - origin[i]);
    const radius = Math.hypot(0.5, 0.25, 0.3);
    let nearest = Infinity;
    bodies.group.traverse((object) => {
      if (!(object instanceof Mesh)) return;
      const { array } = object.geometry.getAttribute("position");
      for (let v = 0; v < array.length; v += 3)
        nearest = Math.min(nearest, Math.abs(Math.hypot(...middle.map((x, i) => array[v + i] - x)) - radius));
    });
    assert.ok(nearest < 1e-5, `a corner of the last brick is missing by ${nearest}`);
    assert.equal(bodies.show(poses, "material"), false, "nothing moved");
  }
  assert.ok(bodies.trianglesAt(coarsest) < bodies.trianglesAt(0));
});
