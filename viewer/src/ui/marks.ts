/** Draws events on the scrub bar: hits as bars, sensor events and added or removed bodies as ticks. */
import type { Summary } from "../model";
import { sharpContext } from "./dom";

const thumb = 8;

export function drawMarks(canvas: HTMLCanvasElement, summaries: Summary[], frameCount: number): void {
  const context = sharpContext(canvas);
  if (!context || frameCount < 2) return;
  const { width, height } = canvas.getBoundingClientRect();
  const trackWidth = width - 2 * thumb;
  const columns = Math.max(1, Math.min(frameCount, Math.floor(trackWidth)));
  const hits = new Float64Array(columns);
  const ticks: { x: number; colour: string }[] = [];
  summaries.forEach(({ hits: count, sensors, added, removed }, frame) => {
    const share = frame / (frameCount - 1);
    hits[Math.min(columns - 1, Math.floor(share * columns))] += count;
    if (sensors > 0) ticks.push({ x: thumb + share * trackWidth, colour: "#5ad8a6" });
    if (added + removed > 0) ticks.push({ x: thumb + share * trackWidth, colour: "#8fc1ff" });
  });
  const maxHits = hits.reduce((a, b) => Math.max(a, b), 0);
  const middle = height / 2;
  context.fillStyle = "#ffb96199";
  hits.forEach((count, i) => {
    if (count === 0) return;
    const barHeight = 2 + (middle - 6) * Math.sqrt(count / maxHits);
    context.fillRect(thumb + (i * trackWidth) / columns, middle - 3 - barHeight, trackWidth / columns, barHeight);
  });
  for (const { x, colour } of ticks) {
    context.fillStyle = colour;
    context.fillRect(Math.round(x) - 0.5, middle + 4, 1.5, 5);
  }
}
