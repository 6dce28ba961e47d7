/** The two charts of a recording, their legends and the tooltip at the pointer. */
import type { Summary, Tables } from "../model";
import { Chart, round, type Series } from "./chart";
import { byId, legendKey, make } from "./dom";

const colours = [0x5b8ff9, 0x5ad8a6, 0xf6bd16, 0xe8684a, 0x9d7be0, 0x6dc8ec, 0xff9d4d, 0xc2c8d5, 0xd66ba0, 0x8bbf3f];
/** counters to show, where the recording has them */
const preferred = ["awake", "pairs", "manifolds", "contact_points", "contacts", "islands"];
const maxLines = 5;

export const displayName = (name: string): string => name.replaceAll("_", " ");
const thousands = (value: number): string => value.toLocaleString("en-GB");

export class Charts {
  readonly summaries: Summary[] = [];
  private readonly stages: Series[];
  private readonly counts: Series[];
  /** index of each line's counter */
  private readonly counters: number[];
  private readonly charts: Chart[];
  private readonly tip = byId("tip");
  private used = 0;

  constructor(
    private readonly tables: Tables,
    frameCount: number,
    seek: (frame: number) => void,
  ) {
    const { stageNames, counterNames } = tables;
    this.stages = stageNames.map((name, i) => ({ name, colour: colours[i % colours.length], values: [] }));
    const indices = preferred.map((name) => counterNames.indexOf(name)).filter((index) => index >= 0);
    this.counters = (indices.length ? indices : counterNames.map((_, i) => i)).slice(0, maxLines);
    this.counts = this.counters.map((counter, i) => ({ name: counterNames[counter], colour: colours[i], values: [] }));
    const on = { seek, hover: (frame: number | null, x: number, y: number) => this.showTooltip(frame, x, y) };
    this.charts = [
      new Chart(byId<HTMLCanvasElement>("chart-times"), "stacked", this.stages, frameCount, on),
      new Chart(byId<HTMLCanvasElement>("chart-counts"), "lines", this.counts, frameCount, on),
    ];
  }

  /** Appends the summaries read since the last call. */
  appendNew(): void {
    if (this.used === this.summaries.length) return;
    for (; this.used < this.summaries.length; ++this.used) {
      const { stages, counters } = this.summaries[this.used];
      this.stages.forEach((series, i) => series.values.push(stages[i]));
      this.counts.forEach((series, i) => series.values.push(counters[this.counters[i]]));
    }
    this.resize();
  }

  resize(): void {
    for (const chart of this.charts) chart.refresh();
  }

  draw(frame: number): void {
    for (const chart of this.charts) chart.draw(frame);
    const summary = this.summaries[frame];
    byId("legend-times").replaceChildren(
      make("b", `step ${summary ? round(summary.total) : "–"} ms`),
      ...this.stages.map(({ name, colour, values }) =>
        legendKey(colour, displayName(name), values[frame] === undefined ? "–" : round(values[frame])),
      ),
    );
    byId("legend-counts").replaceChildren(
      ...this.counts.map(({ name, colour, values }) =>
        legendKey(colour, displayName(name), values[frame] === undefined ? "–" : thousands(values[frame])),
      ),
    );
  }

  private showTooltip(frame: number | null, x: number, y: number): void {
    const summary = frame === null ? undefined : this.summaries[frame];
    this.tip.hidden = !summary;
    if (!summary) return;
    const rows: [string, string][] = [
      ["step", `${round(summary.total)} ms`],
      ...this.stages.map(({ name }, i): [string, string] => [displayName(name), `${round(summary.stages[i])} ms`]),
      ...this.tables.counterNames.map((name, i): [string, string] => [displayName(name), thousands(summary.counters[i])]),
    ];
    this.tip.replaceChildren(
      make("b", `frame ${frame}, ${summary.time.toFixed(2)} s`),
      ...rows.flatMap(([name, value]) => [make("span", name), make("span", value)]),
    );
    const { width, height } = this.tip.getBoundingClientRect();
    this.tip.style.left = `${Math.max(8, Math.min(window.innerWidth - width - 8, x + 14))}px`;
    this.tip.style.top = `${Math.max(8, Math.min(window.innerHeight - height - 8, y - height - 14))}px`;
  }
}
