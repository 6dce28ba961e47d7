/** What happened when, drawn on the scrub bar: hits as a low hill, sensors and bodies that come or go as ticks. */
import type { Summary } from "../model";
import { sharpContext } from "./dom";

const thumb = 8;

export function drawMarks(canvas: HTMLCanvasElement, summaries: Summary[], frameCount: number): void {
  const context = sharpContext(canvas);
  if (!context || frameCount < 2) return;
  const { width, height } = canvas.getBoundingClientRect();
  const room = width - 2 * thumb;
  const columns = Math.max(1, Math.min(frameCount, Math.floor(room)));
  const hits = new Float64Array(columns);
  const ticks: { x: number; colour: string }[] = [];
  summaries.forEach(({ hits: count, sensors, added, removed }, frame) => {
    const at = frame / (frameCount - 1);
    hits[Math.min(columns - 1, Math.floor(at * columns))] += count;
    if (sensors > 0) ticks.push({ x: thumb + at * room, colour: "#5ad8a6" });
    if (added + removed > 0) ticks.push({ x: thumb + at * room, colour: "#8fc1ff" });
  });
  const most = hits.reduce((a, b) => Math.max(a, b), 0);
  const middle = height / 2;
  context.fillStyle = "#ffb96199";
  hits.forEach((count, i) => {
    if (count === 0) return;
    const tall = 2 + (middle - 6) * Math.sqrt(count / most);
    context.fillRect(thumb + (i * room) / columns, middle - 3 - tall, room / columns, tall);
  });
  for (const { x, colour } of ticks) {
    context.fillStyle = colour;
    context.fillRect(Math.round(x) - 0.5, middle + 4, 1.5, 5);
  }
}
