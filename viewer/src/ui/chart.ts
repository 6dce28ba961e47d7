/** A chart over all frames, stacked or lines, with a cursor at the current frame and one at the pointer. */
import { type Layout, layOut, linearMarks, logMarks, type Mark } from "./chart_layout";
import { cssColour, sharpContext } from "./dom";

export interface Series {
  name: string;
  colour: number;
  /** one number per frame; grows while the recording is being read */
  values: number[];
}
export type ChartKind = "stacked" | "lines";

const font = "10px system-ui, sans-serif";

/** Returns the value that all but `share` of the values do not exceed. */
function highValue(values: number[], share: number): number {
  const sorted = Float64Array.from(values).sort();
  return sorted[Math.floor((sorted.length - 1) * (1 - share))] ?? 0;
}

export class Chart {
  private readonly base = document.createElement("canvas");
  private isStale = true;
  private hovered: number | null = null;
  private frame = 0;
  /** the first and the last pixel of the plot; left of it are labels */
  private plot = { left: 0, right: 1 };

  constructor(
    readonly canvas: HTMLCanvasElement,
    private readonly kind: ChartKind,
    private readonly series: Series[],
    private readonly frameCount: number,
    on: { seek(frame: number): void; hover(frame: number | null, x: number, y: number): void },
  ) {
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      on.seek(this.frameAt(event));
    });
    canvas.addEventListener("pointermove", (event) => {
      const frame = this.frameAt(event);
      if (canvas.hasPointerCapture(event.pointerId)) on.seek(frame);
      this.hovered = frame;
      on.hover(frame, event.clientX, event.clientY);
      this.draw(this.frame);
    });
    for (const name of ["pointerleave", "pointerup", "pointercancel"] as const)
      canvas.addEventListener(name, (event) => {
        if (name === "pointerup" && event.pointerType === "mouse") return;
        this.hovered = null;
        on.hover(null, 0, 0);
        this.draw(this.frame);
      });
  }

  /** Marks values or size as changed: the next draw() redraws everything. */
  refresh(): void {
    this.isStale = true;
  }

  draw(frame: number): void {
    this.frame = frame;
    const context = sharpContext(this.canvas);
    if (!context) return;
    const { width, height } = this.canvas.getBoundingClientRect();
    if (this.isStale || this.base.width !== this.canvas.width || this.base.height !== this.canvas.height) {
      this.base.width = this.canvas.width;
      this.base.height = this.canvas.height;
      const base = this.base.getContext("2d");
      if (!base) return;
      base.save();
      base.setTransform(this.canvas.width / width, 0, 0, this.canvas.height / height, 0, 0);
      this.drawBase(base, width);
      base.restore();
      this.isStale = false;
    }
    context.drawImage(this.base, 0, 0, width, height);
    if (this.hovered !== null) this.drawCursor(context, this.hovered, "#ffffff66", height);
    this.drawCursor(context, frame, "#ffb961", height);
  }

  private drawCursor(context: CanvasRenderingContext2D, frame: number, colour: string, height: number): void {
    const x = Math.round(this.xOf(frame)) + 0.5;
    context.strokeStyle = colour;
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(x, 0);
    context.lineTo(x, height);
    context.stroke();
  }

  private drawBase(context: CanvasRenderingContext2D, width: number): void {
    const frames = Math.min(...this.series.map(({ values }) => values.length));
    if (!Number.isFinite(frames) || frames === 0) return;
    context.font = font;
    const columns = this.columns(frames, width);
    const layout = this.kind === "stacked" ? this.layOutTimes(context, columns) : this.layOutCounts(context, columns);
    this.plot = layout.plot;
    this.canvas.dataset.plot = String(layout.plot.left);
    drawScale(context, layout);
    const { left, top, right, bottom } = layout.plot;
    context.beginPath();
    context.rect(left, top, right - left, bottom - top);
    context.clip();
    if (this.kind === "stacked") this.drawAreas(context, columns, layout);
    else this.drawLines(context, columns, layout);
  }

  private layOutTimes(context: CanvasRenderingContext2D, columns: number[]): Layout {
    const totals = columns.map((frame) => this.series.reduce((sum, { values }) => sum + values[frame], 0));
    const top = Math.max(1e-6, highValue(totals, 0.01) * 1.1);
    return this.layOut(context, linearMarks(top, (value) => `${round(value)} ms`), (value) => value / top);
  }
  private layOutCounts(context: CanvasRenderingContext2D, columns: number[]): Layout {
    const ofSeries = ({ values }: Series) => columns.reduce((max, frame) => Math.max(max, values[frame]), 0);
    const max = Math.max(1, ...this.series.map(ofSeries));
    const top = Math.log10(1 + max) * 1.04;
    return this.layOut(context, logMarks(max), (value) => Math.log10(1 + value) / top);
  }
  private layOut(context: CanvasRenderingContext2D, marks: Mark[], share: (value: number) => number): Layout {
    const { width, height } = this.canvas.getBoundingClientRect();
    return layOut(width, height, marks, share, (text) => context.measureText(text).width);
  }

  private drawAreas(context: CanvasRenderingContext2D, columns: number[], { y }: Layout): void {
    const floor = new Array<number>(columns.length).fill(0);
    for (const { colour, values } of this.series) {
      context.fillStyle = cssColour(colour);
      context.beginPath();
      columns.forEach((frame, i) => context.lineTo(this.xOf(frame), y(floor[i])));
      for (let i = columns.length - 1; i >= 0; --i) {
        floor[i] += values[columns[i]];
        context.lineTo(this.xOf(columns[i]), y(floor[i]));
      }
      context.fill();
    }
  }

  private drawLines(context: CanvasRenderingContext2D, columns: number[], { y }: Layout): void {
    for (const { colour, values } of this.series) {
      context.strokeStyle = cssColour(colour);
      context.lineWidth = 1.5;
      context.lineJoin = "round";
      context.beginPath();
      for (const frame of columns) context.lineTo(this.xOf(frame), y(values[frame]));
      context.stroke();
    }
  }

  /** Returns at most one frame per half pixel: the one with the largest sum. */
  private columns(frames: number, width: number): number[] {
    const maxColumns = Math.max(2, Math.floor(width * 2));
    if (frames <= maxColumns) return Array.from({ length: frames }, (_, i) => i);
    const sums = (frame: number) => this.series.reduce((sum, { values }) => sum + values[frame], 0);
    return Array.from({ length: maxColumns }, (_, column) => {
      const from = Math.floor((column * frames) / maxColumns);
      const to = Math.max(from + 1, Math.floor(((column + 1) * frames) / maxColumns));
      let best = from;
      for (let frame = from + 1; frame < to; ++frame) if (sums(frame) > sums(best)) best = frame;
      return best;
    });
  }

  private xOf(frame: number): number {
    const { left, right } = this.plot;
    return this.frameCount > 1 ? left + 1 + (frame / (this.frameCount - 1)) * (right - left - 2) : (left + right) / 2;
  }

  private frameAt(event: PointerEvent): number {
    const { left, right } = this.plot;
    const x = event.clientX - this.canvas.getBoundingClientRect().left;
    const share = (x - left - 1) / Math.max(1, right - left - 2);
    return Math.max(0, Math.min(this.frameCount - 1, Math.round(share * (this.frameCount - 1))));
  }
}

/** Draws the lines of the scale and, outside the plot, its labels. */
function drawScale(context: CanvasRenderingContext2D, { plot, labels, lines }: Layout): void {
  context.strokeStyle = "#ffffff1c";
  context.lineWidth = 1;
  for (const y of lines) {
    context.beginPath();
    context.moveTo(plot.left, y);
    context.lineTo(plot.right, y);
    context.stroke();
  }
  context.fillStyle = "#aeb9c7";
  context.textBaseline = "middle";
  for (const { text, box } of labels) context.fillText(text, box.left, (box.top + box.bottom) / 2);
}

/** Formats with three digits and no exponent. */
export function round(value: number): string {
  if (value >= 100) return Math.round(value).toString();
  return value.toFixed(value >= 10 ? 1 : value >= 0.1 ? 2 : 3);
}
