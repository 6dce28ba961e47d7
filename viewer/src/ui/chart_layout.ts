/** Where a chart draws: the plot, and left of it the labels of the scale, which no line of the plot can reach. */

/** Pixels from the top left corner of the chart. */
export interface Box {
  left: number;
  top: number;
  right: number;
  bottom: number;
}
export interface Label {
  text: string;
  box: Box;
}
/** A value of the scale and its text; "": a line without a label. */
export type Mark = [value: number, text: string];

export interface Layout {
  /** lines and areas are clipped to it */
  plot: Box;
  labels: Label[];
  /** heights of the lines of the scale */
  lines: number[];
  /** from a value to its height in the chart */
  y(value: number): number;
}

export const labelHeight = 12;
const gap = 5;
/** room above the highest mark */
const headroom = 7;

/**
 * Lays out a chart. `share`: from a value to its height, 0 at the bottom of the plot, 1 at the top mark. `measure`: the
 * width of a text. Labels that would touch another are left out; those first in `marks` are kept.
 */
export function layOut(
  width: number,
  height: number,
  marks: Mark[],
  share: (value: number) => number,
  measure: (text: string) => number,
): Layout {
  const left = Math.min(width / 2, Math.ceil(Math.max(0, ...marks.map(([, text]) => measure(text)))) + gap);
  const bottom = height - 1;
  const y = (value: number) => bottom - share(value) * (bottom - headroom);
  const labels: Label[] = [];
  const lines: number[] = [];
  for (const [value, text] of marks) {
    const line = Math.round(y(value)) + 0.5;
    if (line < 0 || line > height) continue;
    lines.push(line);
    const top = Math.max(0, Math.min(height - labelHeight, line - labelHeight / 2));
    const box = { left: left - gap - measure(text), top, right: left - gap, bottom: top + labelHeight };
    const isFree = labels.every((other) => other.box.bottom <= box.top || box.bottom <= other.box.top);
    if (text && box.left >= 0 && isFree) labels.push({ text, box });
  }
  return { plot: { left, top: 0, right: width, bottom: height }, labels, lines, y };
}

/** Returns the marks of a linear scale from 0 to `top`. */
export const linearMarks = (top: number, format: (value: number) => string): Mark[] =>
  [0, top, top / 2].map((value) => [value, value === 0 ? "0" : format(value)]);

/** Returns the marks of a logarithmic scale: 0 and the powers of ten up to `max`. */
export function logMarks(max: number): Mark[] {
  const marks: Mark[] = [[0, "0"]];
  for (let value = 10; value <= max; value *= 10) marks.push([value, shorten(value)]);
  return marks;
}

/** Formats a power of ten: 100, 1k, 10M. */
function shorten(value: number): string {
  const [unit, letter] = value >= 1e9 ? [1e9, "G"] : value >= 1e6 ? [1e6, "M"] : value >= 1e3 ? [1e3, "k"] : [1, ""];
  return `${Math.round(value / unit)}${letter}`;
}
