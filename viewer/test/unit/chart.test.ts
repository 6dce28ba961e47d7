/** Tests of the layout of charts: labels have room of their own. */
import assert from "node:assert/strict";
import { test } from "node:test";
import { type Box, labelHeight, layOut, linearMarks, logMarks, type Mark } from "../../src/ui/chart_layout";
import { round } from "../../src/ui/chart";

const measure = (text: string) => 6.1 * text.length;
const overlap = (a: Box, b: Box) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
const sizes: [number, number][] = [
  [660, 92],
  [340, 58],
  [300, 44],
  [120, 30],
];
const scales: [Mark[], (value: number) => number][] = [
  ...[0.001, 0.12, 9.5, 36.2, 12345].map((top): [Mark[], (value: number) => number] => [
    linearMarks(top, (value) => `${round(value)} ms`),
    (value) => value / top,
  ]),
  ...[1, 9, 10, 5e4, 3e7, 2e10].map((max): [Mark[], (value: number) => number] => [
    logMarks(max),
    (value) => Math.log10(1 + value) / Math.log10(1 + max) / 1.04,
  ]),
];

test("no label touches the plot, another label or the edge, at any size and scale", () => {
  for (const [width, height] of sizes)
    for (const [marks, share] of scales) {
      const { plot, labels } = layOut(width, height, marks, share, measure);
      assert.ok(labels.length > 0);
      labels.forEach(({ text, box }, i) => {
        assert.ok(!overlap(box, plot), `${text} is in the plot`);
        assert.ok(box.right < plot.left);
        assert.ok(box.left >= 0 && box.top >= 0 && box.bottom <= height, `${text} is outside`);
        assert.ok(Math.abs(box.right - box.left - measure(text)) < 1e-9 && box.bottom - box.top === labelHeight);
        for (const other of labels.slice(i + 1)) assert.ok(!overlap(box, other.box), `${text} touches ${other.text}`);
      });
      assert.ok(plot.right === width && plot.right - plot.left >= width / 2);
    }
});

test("labels stand at their lines, and the top of a linear scale is labelled", () => {
  const { labels, lines, y } = layOut(600, 92, linearMarks(40, (value) => `${value} ms`), (value) => value / 40, measure);
  assert.deepEqual(labels.map(({ text }) => text).sort(), ["0", "20 ms", "40 ms"]);
  assert.equal(lines.length, 3);
  assert.ok(y(40) > 0 && y(40) < 12 && y(0) > 85 && y(0) < 92);
  const middle = labels.find(({ text }) => text === "20 ms");
  assert.ok(middle && Math.abs((middle.box.top + middle.box.bottom) / 2 - y(20)) < 1);
});

test("powers of ten are written short", () => {
  const texts = logMarks(3e9).map(([, text]) => text);
  assert.deepEqual(texts, ["0", "10", "100", "1k", "10k", "100k", "1M", "10M", "100M", "1G"]);
});
