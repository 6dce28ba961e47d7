/** The panel that shows the state of the selected body and which of its shapes is selected. */
import { type Body, flagAwake, flagBroken, type Frame, kindNames, kindOf, type Selection, type Tables } from "../model";
import { existsAt } from "../scene/bounds";
import { traitsOf } from "../shapes/list";
import { byId, make } from "./dom";

/** of a body with many shapes, so many are described */
const maxDescribed = 64;
const maxLines = 4;
const count = (n: number): string => n.toLocaleString("en-GB");

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
  private selection: Selection | null = null;

  constructor(
    private readonly tables: Tables,
    on: { follow(): void; close(): void },
  ) {
    byId("follow").addEventListener("click", on.follow);
    byId("body-close").addEventListener("click", on.close);
  }

  /** Shows a body at `frame`; the speed is that between `before` and `after`. */
  show(selection: Selection | null, frame: Frame, before: Frame, after: Frame, isFollowed: boolean): void {
    this.root.hidden = selection === null;
    this.selection = selection;
    if (selection === null) return;
    const row = selection.body;
    const body = this.tables.bodies[row];
    byId("body-name").textContent = nameOf(body);
    byId("follow").setAttribute("aria-pressed", String(isFollowed));
    const lines = frame.present[row]
      ? [
          ...describeShape(this.tables, selection),
          ...this.lines(row, body, frame, speedBetween(row, before, after)),
          ...listShapes(this.tables, frame, row),
        ]
      : [["state", "not in the world"]];
    byId("body-state").replaceChildren(...lines.flatMap(([name, value]) => [make("dt", name), make("dd", value)]));
  }

  get shown(): Selection | null {
    return this.selection;
  }

  private lines(row: number, body: Body, frame: Frame, speed: number | null): string[][] {
    const flags = frame.flags[row];
    const kind = kindOf(flags);
    const p = Array.from(frame.positions.subarray(3 * row, 3 * row + 3));
    const [x, y, z, w] = frame.rotations.subarray(4 * row, 4 * row + 4);
    const island = frame.islands[row];
    const isBroken = (flags & flagBroken) !== 0;
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
    ];
  }
}

/** Names the selected shape and its number among the shapes of its body; of a body with one shape: no lines. */
export function describeShape(tables: Tables, { body, shape }: Selection): string[][] {
  const { colliders } = tables.bodies[body];
  if (shape === null || colliders.length < 2) return [];
  return [
    ["shape", describeCollider(tables, colliders[shape])],
    ["", `number ${count(shape + 1)} of ${count(colliders.length)}`],
  ];
}

/** Lists a few of the shapes that a body has at the frame, equal ones together, then how many more there are. */
export function listShapes(tables: Tables, frame: Frame, row: number): string[][] {
  const existing = tables.bodies[row].colliders.filter((index) => existsAt(tables.colliders[index], frame));
  const groups = new Map<string, number>();
  for (const index of existing.slice(0, maxDescribed)) {
    const words = describeCollider(tables, index);
    groups.set(words, (groups.get(words) ?? 0) + 1);
  }
  const listed = [...groups].slice(0, maxLines);
  const values = listed.map(([words, n]) => (n > 1 ? `${count(n)} × ${words}` : words));
  const left = existing.length - listed.reduce((sum, [, n]) => sum + n, 0);
  if (left > 0) values.push(`and ${count(left)} more`);
  return values.map((value, i) => [i === 0 ? "shapes" : "", value]);
}

function describeCollider(tables: Tables, index: number): string {
  const { shape: at, sensor } = tables.colliders[index];
  const shape = tables.shapes[at];
  return traitsOf(shape).describe(shape) + (sensor ? " (sensor)" : "");
}
