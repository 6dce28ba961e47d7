/** The panel that shows the state of the picked body. */
import { type Body, flagAwake, flagBroken, type Frame, kindNames, kindOf, type Tables } from "../model";
import { traitsOf } from "../shapes/list";
import { byId, make } from "./dom";

/** Returns the body's name, or one made from its index. */
export const nameOf = (body: Body): string => body.name || `body ${body.index}`;

/** Formats with fixed digits, without a minus sign before zero. */
const fixed = (x: number, digits: number): string => x.toFixed(digits).replace(/^-(0\.?0*)$/, "$1");

/** Describes a rotation by axis and angle, which are continuous, unlike roll, pitch and yaw. */
function describeRotation(x: number, y: number, z: number, w: number): string {
  const side = w < 0 ? -1 : 1;
  const sine = Math.hypot(x, y, z);
  const degrees = (2 * Math.atan2(sine, Math.abs(w)) * 180) / Math.PI;
  if (sine < 1e-4) return "0°";
  return `${degrees.toFixed(1)}° about ${[x, y, z].map((c) => fixed((side * c) / sine, 2)).join(", ")}`;
}

/** Returns metres per second from two frames; null when the body is not in both. */
export function speedBetween(row: number, a: Frame, b: Frame): number | null {
  if (!a.present[row] || !b.present[row] || a.time === b.time) return null;
  const at = 3 * row;
  const moved = Math.hypot(...[0, 1, 2].map((i) => b.positions[at + i] - a.positions[at + i]));
  return moved / Math.abs(b.time - a.time);
}

export class BodyPanel {
  private readonly root = byId("body");
  private row: number | null = null;

  constructor(
    private readonly tables: Tables,
    on: { follow(): void; close(): void },
  ) {
    byId("follow").addEventListener("click", on.follow);
    byId("body-close").addEventListener("click", on.close);
  }

  /** Shows a body at `frame`; the speed is that between `before` and `after`. */
  show(row: number | null, frame: Frame, before: Frame, after: Frame, isFollowed: boolean): void {
    this.root.hidden = row === null;
    this.row = row;
    if (row === null) return;
    const body = this.tables.bodies[row];
    byId("body-name").textContent = nameOf(body);
    byId("follow").setAttribute("aria-pressed", String(isFollowed));
    const lines = frame.present[row]
      ? this.lines(row, body, frame, speedBetween(row, before, after))
      : [["state", "not in the world"]];
    byId("body-state").replaceChildren(...lines.flatMap(([name, value]) => [make("dt", name), make("dd", value)]));
  }

  get shown(): number | null {
    return this.row;
  }

  private lines(row: number, body: Body, frame: Frame, speed: number | null): string[][] {
    const flags = frame.flags[row];
    const kind = kindOf(flags);
    const p = Array.from(frame.positions.subarray(3 * row, 3 * row + 3));
    const [x, y, z, w] = frame.rotations.subarray(4 * row, 4 * row + 4);
    const island = frame.islands[row];
    const isBroken = (flags & flagBroken) !== 0;
    const shapes = new Map<string, number>();
    for (const index of body.colliders) {
      const { shape: at, sensor, from, to } = this.tables.colliders[index];
      if (frame.number < from || frame.number >= to) continue;
      const shape = this.tables.shapes[at];
      const words = traitsOf(shape).describe(shape) + (sensor ? " (sensor)" : "");
      shapes.set(words, (shapes.get(words) ?? 0) + 1);
    }
    return [
      ["index", `${body.index} · generation ${body.generation}`],
      ["kind", kindNames[kind]],
      ["state", isBroken ? "disabled" : kind === 0 ? "static" : flags & flagAwake ? "awake" : "asleep"],
      ...(body.mass > 0 ? [["mass", `${Number(body.mass.toPrecision(4))} kg`]] : []),
      ["position", `${p.map((x) => fixed(x, 3)).join(", ")} m`],
      ["rotation", describeRotation(x, y, z, w)],
      ["speed", speed === null ? "–" : `${speed.toFixed(3)} m/s`],
      ["island", island === 0 ? "none" : String(island - 1)],
      ["user number", body.user.toString()],
      ...[...shapes].map(([words, count], i) => [i === 0 ? "shapes" : "", count > 1 ? `${count} × ${words}` : words]),
    ];
  }
}
