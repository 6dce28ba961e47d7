/** Tests of the list of shapes; each test runs over all kinds. */
import assert from "node:assert/strict";
import { test } from "node:test";
import { Reader } from "../../src/format/bytes";
import type { Vec3 } from "../../src/model";
import { hash01 } from "../../src/scene/maths";
import { readShape, type Shape, shapeKinds, traitsOf } from "../../src/shapes/list";
import { isTriangles, type Ray } from "../../src/shapes/traits";
import { Writer } from "../encode";
import { contains, examples, writeShape } from "../shapes";

const intersect = (shape: Shape, ray: Ray) => traitsOf(shape).intersect(shape, ray);
const bounded = examples.filter((shape) => Number.isFinite(traitsOf(shape).radius(shape)));
const bytesOf = (shape: Shape): Uint8Array => {
  const out = new Writer();
  writeShape(out, shape);
  return out.done();
};
/** Returns pseudo-random numbers in [-1, 1). */
const randomVector = (n: number): Vec3 => [0, 1, 2].map((k) => 2 * hash01(n * 7 + k + 1) - 1) as Vec3;

test("every kind is listed once and has an example", () => {
  assert.equal(new Set(shapeKinds.map(({ kind }) => kind)).size, shapeKinds.length);
  assert.equal(examples.length, shapeKinds.length);
});

test("every shape is read from its bytes; truncated bytes and unknown kinds are refused", () => {
  for (const shape of examples) {
    const bytes = bytesOf(shape);
    const read = new Reader(bytes, "test");
    const copy = readShape(read);
    assert.equal(copy.kind, shape.kind);
    assert.equal(read.left, 0);
    assert.deepEqual(bytesOf(copy), bytes);
    assert.throws(() => readShape(new Reader(bytes.subarray(0, -1), "test")), { name: "RecordingError" });
  }
  const count = shapeKinds.length;
  const unknown = new Reader(new Uint8Array([count]), "test");
  assert.throws(() => readShape(unknown), new RegExp(`found shape kind ${count}; expected 0 to ${count - 1}$`));
});

test("ray intersections agree with marching along the ray", () => {
  const step = 0.002;
  for (const shape of examples)
    for (let n = 0; n < 150; ++n) {
      const random = (k: number) => 2 * hash01(n * 7 + k + 1) - 1;
      const origin: Vec3 = [3 * random(0), 2 + random(1), 3 * random(2)];
      const aim: Vec3 = [0.6 * random(3), 0.9 * random(4), 0.6 * random(5)];
      const towards = aim.map((x, i) => x - origin[i]);
      const length = Math.hypot(...towards);
      const direction = towards.map((x) => x / length) as Vec3;
      let marched: number | null = null;
      for (let t = 0; t < 8 && marched === null; t += step)
        if (contains(shape, origin.map((x, i) => x + direction[i] * t) as Vec3)) marched = t;
      const met = intersect(shape, { origin, direction });
      if (marched === null)
        assert.ok(met === null || met > 7.99 || grazes(shape, origin, direction, met), `${shape.kind} ${n}: ${met}`);
      else
        assert.ok(
          met !== null && Math.abs(met - marched) <= 2 * step,
          `${shape.kind} ${n}: ${met}, marched ${marched}`,
        );
    }
});

/** Whether the ray only touches a corner, which the march may miss. */
function grazes(shape: Shape, origin: Vec3, direction: Vec3, met: number): boolean {
  return !contains(shape, origin.map((x, i) => x + direction[i] * (met + 0.004)) as Vec3);
}

test("rays along the axes (division by zero) hit boxes and cylinders", () => {
  assert.equal(intersect({ kind: "box", half: [1, 1, 1] }, { origin: [0, 5, 0], direction: [0, -1, 0] }), 4);
  assert.equal(intersect({ kind: "box", half: [1, 1, 1] }, { origin: [2, 5, 0], direction: [0, -1, 0] }), null);
  assert.equal(intersect({ kind: "cylinder", radius: 1, halfHeight: 2 }, { origin: [0.5, 5, 0], direction: [0, -1, 0] }), 3);
  assert.equal(intersect({ kind: "capsule", radius: 1, halfLength: 2 }, { origin: [0, 5, 0], direction: [0, -1, 0] }), 2);
  assert.equal(intersect({ kind: "sphere", radius: 1 }, { origin: [0, 0, 0], direction: [0, -1, 0] }), 0);
});

test("extent and radius are tight bounds of the points of a shape", () => {
  const extent = new Float64Array(2);
  for (const shape of bounded) {
    const radius = traitsOf(shape).radius(shape);
    const tries = Array.from({ length: 20000 }, (_, n) => randomVector(n).map((x) => 1.05 * radius * x) as Vec3);
    const points = tries.filter((point) => contains(shape, point));
    for (let n = 0; n < 10; ++n) {
      const aim = randomVector(n + 30000);
      const [x, y, z] = aim.map((c) => c / Math.hypot(...aim));
      traitsOf(shape).extent(shape, x, y, z, extent);
      const along = points.map((point) => x * point[0] + y * point[1] + z * point[2]);
      const [lo, hi] = [Math.min(...along), Math.max(...along)];
      assert.ok(extent[0] <= lo && hi <= extent[1], `${shape.kind}: a point is outside`);
      assert.ok(Math.max(extent[1], -extent[0]) <= radius + 1e-9, `${shape.kind}: the radius is too small`);
      assert.ok(lo - extent[0] < 0.2 && extent[1] - hi < 0.2, `${shape.kind}: ${extent}; found ${lo} to ${hi}`);
    }
  }
  for (const shape of examples.filter((one) => !bounded.includes(one))) {
    traitsOf(shape).extent(shape, 1, 0, 0, extent);
    assert.deepEqual([...extent], [-Infinity, Infinity]);
  }
});

test("every shape has a label, and is ground or has pieces; forms have unique names and unit size", () => {
  const forms = new Map<string, unknown>();
  for (const shape of examples) {
    const traits = traitsOf(shape);
    assert.match(traits.describe(shape), /^[a-z]/);
    assert.equal(traits.pieces(shape).length === 0, traits.isGround, shape.kind);
    for (const { form } of traits.pieces(shape)) {
      if (isTriangles(form)) continue;
      assert.equal(forms.get(form.name) ?? form, form, form.name);
      forms.set(form.name, form);
      const geometry = form.geometry(32);
      geometry.computeBoundingBox();
      assert.equal(geometry.boundingBox?.max.y.toFixed(6), "1.000000", form.name);
      for (const x of geometry.getAttribute("position").array) assert.ok(Math.abs(x) <= 1 + 1e-6, form.name);
    }
  }
});
