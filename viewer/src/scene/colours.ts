/** The colours of bodies, and their legend. */
import { type BodyKind, type Frame, flagAwake, flagBroken, kindOf, noIsland } from "../model";
import { hash01 } from "./maths";

export const colourings = ["material", "kind", "island", "sleep"] as const;
export type Colouring = (typeof colourings)[number];

/** sRGB, 0xrrggbb */
const palette = {
  static: 0x7d8794,
  kinematic: 0x35b8a6,
  dynamic: 0xe0a458,
  awake: 0xf28c5a,
  asleep: 0x5b7ea8,
  broken: 0xe0457b,
};
/** Default colours of dynamic bodies: stone and clay tones. */
const clay = [0xe3d3b5, 0xd9c39c, 0xd8b898, 0xe6dcc8, 0xcbb592, 0xdcbf8a];
const kindColours: Record<BodyKind, number> = { 0: palette.static, 1: palette.kinematic, 2: palette.dynamic };

const toLinear = (c: number) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
const linear = Float32Array.from({ length: 256 }, (_, i) => toLinear(i / 255));

/** Returns a bright colour for a number; consecutive numbers are far apart on the colour wheel (golden angle). */
function wheel(n: number): number {
  const hue = (n * 0.61803398875) % 1;
  const value = 0.74 + 0.22 * hash01(n + 7);
  const saturation = 0.34 + 0.2 * hash01(n + 3);
  const channel = (k: number) => {
    const t = (k + hue * 6) % 6;
    return Math.round(255 * (value - value * saturation * Math.max(0, Math.min(t, 4 - t, 1))));
  };
  return (channel(5) << 16) | (channel(3) << 8) | channel(1);
}

/** Returns the sRGB colour of a body at a frame; `own`: the colour of its part, or null. */
export function colourOf(row: number, own: number | null, frame: Frame, by: Colouring): number {
  const flags = frame.flags[row];
  if (by === "material") {
    if (own !== null) return own;
    const kind = kindOf(flags);
    return kind === 2 ? clay[Math.floor(hash01(row) * clay.length)] : kindColours[kind];
  }
  if (by === "kind") return kindColours[kindOf(flags)];
  if (kindOf(flags) === 0) return palette.static;
  if (by === "sleep") {
    if (flags & flagBroken) return palette.broken;
    return flags & flagAwake ? palette.awake : palette.asleep;
  }
  const island = frame.islands[row];
  if (island === noIsland) return kindOf(flags) === 1 ? palette.kinematic : 0x8791a0;
  return wheel(island);
}

/** Writes a colour as linear RGB, scaled by `shade` (1: unchanged). */
export function writeLinear(out: Float32Array, index: number, colour: number, shade: number): void {
  out[index] = linear[(colour >> 16) & 255] * shade;
  out[index + 1] = linear[(colour >> 8) & 255] * shade;
  out[index + 2] = linear[colour & 255] * shade;
}

/** A small random brightness per body, so that neighbours of the same colour can be distinguished. */
export const shadeOf = (row: number): number => 0.9 + 0.2 * hash01(row * 2 + 1);

export interface LegendKey {
  name: string;
  colour: number;
}
export function legendOf(by: Colouring): LegendKey[] {
  switch (by) {
    case "kind":
      return [
        { name: "static", colour: palette.static },
        { name: "kinematic", colour: palette.kinematic },
        { name: "dynamic", colour: palette.dynamic },
      ];
    case "sleep":
      return [
        { name: "awake", colour: palette.awake },
        { name: "asleep", colour: palette.asleep },
        { name: "static", colour: palette.static },
      ];
    case "island":
      return [
        { name: "one colour per island", colour: wheel(5) },
        { name: "none or asleep", colour: 0x8791a0 },
        { name: "static", colour: palette.static },
      ];
    case "material":
      return [];
  }
}
