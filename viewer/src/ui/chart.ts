/** A chart over all frames, stacked or lines, with a cursor at the current frame and one at the pointer. */
import { cssColour, sharpContext } from "./dom";

export interface Series {
  name: string;
  colour: number;
  /** one number per frame; grows while the recording is being read */
  values: number[];
}
export type ChartKind = "stacked" | "lines";

const padTop = 12;

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
      base.setTransform(this.canvas.width / width, 0, 0, this.canvas.height / height, 0, 0);
      this.drawBase(base, width, height);
      this.isStale = false;
    }
    context.drawImage(this.base, 0, 0, width, height);
    if (this.hovered !== null) this.drawCursor(context, this.hovered, "#ffffff66", width, height);
    this.drawCursor(context, frame, "#ffb961", width, height);
  }

  private drawCursor(
    context: CanvasRenderingContext2D,
    frame: number,
    colour: string,
    width: number,
    height: number,
  ): void {
    const x = Math.round(this.xOf(frame, width)) + 0.5;
    context.strokeStyle = colour;
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(x, 0);
    context.lineTo(x, height);
    context.stroke();
  }

  private drawBase(context: CanvasRenderingContext2D, width: number, height: number): void {
    const frames = Math.min(...this.series.map(({ values }) => values.length));
    if (!Number.isFinite(frames) || frames === 0) return;
    const columns = this.columns(frames, width);
    const plotHeight = height - padTop;
    if (this.kind === "stacked") {
      const totals = columns.map((frame) => this.series.reduce((sum, { values }) => sum + values[frame], 0));
      const top = Math.max(1e-6, highValue(totals, 0.01) * 1.1);
      this.drawScale(
        context,
        width,
        height,
        [
          [top, `${round(top)} ms`],
          [top / 2, ""],
        ],
        (v) => height - (v / top) * plotHeight,
      );
      const floor = new Array<number>(columns.length).fill(0);
      for (const { colour, values } of this.series) {
        context.fillStyle = cssColour(colour);
        context.beginPath();
        columns.forEach((frame, i) => context.lineTo(this.xOf(frame, width), height - (floor[i] / top) * plotHeight));
        for (let i = columns.length - 1; i >= 0; --i) {
          floor[i] += values[columns[i]];
          context.lineTo(this.xOf(columns[i], width), height - (floor[i] / top) * plotHeight);
        }
        context.fill();
      }
      return;
    }
    const maxValue = Math.max(
      1,
      ...this.series.map(({ values }) => columns.reduce((m, frame) => Math.max(m, values[frame]), 0)),
    );
    const top = Math.log10(1 + maxValue) * 1.04;
    const y = (value: number) => height - 1 - (Math.log10(1 + value) / top) * (plotHeight - 2);
    const marks: [number, string][] = [];
    for (let mark = 10; mark <= maxValue; mark *= 10) marks.push([mark, mark >= 1000 ? `${mark / 1000}k` : `${mark}`]);
    this.drawScale(context, width, height, marks, y);
    for (const { colour, values } of this.series) {
      context.strokeStyle = cssColour(colour);
      context.lineWidth = 1.5;
      context.lineJoin = "round";
      context.beginPath();
      for (const frame of columns) context.lineTo(this.xOf(frame, width), y(values[frame]));
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

  private drawScale(
    context: CanvasRenderingContext2D,
    width: number,
    height: number,
    marks: [number, string][],
    y: (value: number) => number,
  ): void {
    context.font = "10px system-ui, sans-serif";
    context.textBaseline = "bottom";
    let above = Infinity;
    for (const [value, text] of marks) {
      const lineY = Math.round(y(value)) + 0.5;
      if (lineY < 0 || lineY > height) continue;
      context.strokeStyle = "#ffffff1c";
      context.lineWidth = 1;
      context.beginPath();
      context.moveTo(0, lineY);
      context.lineTo(width, lineY);
      context.stroke();
      context.fillStyle = "#aeb9c7";
      if (text && above - lineY > 13) {
        context.fillText(text, 2, lineY - 1);
        above = lineY;
      }
    }
  }

  private xOf(frame: number, width: number): number {
    return this.frameCount > 1 ? (frame / (this.frameCount - 1)) * (width - 2) + 1 : width / 2;
  }

  private frameAt(event: PointerEvent): number {
    const { left, width } = this.canvas.getBoundingClientRect();
    const share = (event.clientX - left - 1) / Math.max(1, width - 2);
    return Math.max(0, Math.min(this.frameCount - 1, Math.round(share * (this.frameCount - 1))));
  }
}

/** Formats with three digits and no exponent. */
export function round(value: number): string {
  if (value >= 100) return Math.round(value).toString();
  return value.toFixed(value >= 10 ? 1 : value >= 0.1 ? 2 : 3);
}
