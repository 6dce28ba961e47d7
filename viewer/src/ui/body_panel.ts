/** The panel that reads out the state of the picked body. */
import { type Body, flagAwake, flagBroken, type Frame, kindNames, kindOf, type Shape, type Tables } from "../model";
import { byId, make } from "./dom";

/** The body's name, or one made from its place in the world. */
export const nameOf = (body: Body): string => body.name || `body ${body.index}`;

/** Fixed digits, and no minus before a zero. */
const fixed = (x: number, digits: number): string => x.toFixed(digits).replace(/^-(0\.?0*)$/, "$1");

function shapeInWords(shape: Shape): string {
  const size = (x: number) => Number(x.toPrecision(3)).toString();
  switch (shape.kind) {
    case "sphere":
      return `sphere r ${size(shape.radius)} m`;
    case "box":
      return `box ${shape.half.map((half) => size(2 * half)).join(" × ")} m`;
    case "capsule":
      return `capsule r ${size(shape.radius)}, length ${size(2 * shape.halfLength)} m`;
    case "cylinder":
      return `cylinder r ${size(shape.radius)}, height ${size(2 * shape.halfHeight)} m`;
    case "convex hull":
      return `hull of ${shape.mesh.vertices.length / 3} points`;
    case "mesh":
      return `mesh of ${shape.mesh.triangles.length / 3} triangles`;
    case "half-space":
      return "half-space";
  }
}

/** Roll, pitch and yaw would leap about; axis and angle do not. */
function rotationInWords(x: number, y: number, z: number, w: number): string {
  const side = w < 0 ? -1 : 1;
  const sine = Math.hypot(x, y, z);
  const degrees = (2 * Math.atan2(sine, Math.abs(w)) * 180) / Math.PI;
  if (sine < 1e-4) return "0°";
  return `${degrees.toFixed(1)}° about ${[x, y, z].map((c) => fixed((side * c) / sine, 2)).join(", ")}`;
}

/** Metres a second, from two frames; null when the body is not in both. */
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

  /** Shows the body at `frame`; speed is taken between `before` and `after`. */
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
      const { shape, sensor, from, to } = this.tables.colliders[index];
      if (frame.number < from || frame.number >= to) continue;
      const words = shapeInWords(this.tables.shapes[shape]) + (sensor ? " (sensor)" : "");
      shapes.set(words, (shapes.get(words) ?? 0) + 1);
    }
    return [
      ["index", `${body.index} · generation ${body.generation}`],
      ["kind", kindNames[kind]],
      ["state", isBroken ? "taken out of play" : kind === 0 ? "static" : flags & flagAwake ? "awake" : "asleep"],
      ...(body.mass > 0 ? [["mass", `${Number(body.mass.toPrecision(4))} kg`]] : []),
      ["position", `${p.map((x) => fixed(x, 3)).join(", ")} m`],
      ["rotation", rotationInWords(x, y, z, w)],
      ["speed", speed === null ? "–" : `${speed.toFixed(3)} m/s`],
      ["island", island === 0 ? "none" : String(island - 1)],
      ["user number", body.user.toString()],
      ...[...shapes].map(([words, count], i) => [i === 0 ? "shapes" : "", count > 1 ? `${count} × ${words}` : words]),
    ];
  }
}
