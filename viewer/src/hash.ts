/**
 * Stores what the page shows in its address, so that a link shows the same picture:
 * #f=120&c=…&p=7:2&by=island&show=boxes,charts
 */
import type { Selection } from "./model";
import { type Colouring, colourings } from "./scene/colours";

/** What can be shown or hidden. */
export const switches = ["boxes", "contacts", "charts"] as const;
export type Switch = (typeof switches)[number];

/** null: the address does not say it, or not in a valid way */
export interface PageState {
  frame: number | null;
  /** eye and target, six numbers */
  camera: number[] | null;
  selection: Selection | "none" | null;
  colouring: Colouring | null;
  shown: Switch[] | null;
}

export function readHash(hash: string): PageState {
  const values = new URLSearchParams(hash.replace(/^#/, ""));
  const frame = naturalNumber(values.get("f"));
  const camera = (values.get("c") ?? "").split(",").map((text) => (text.trim() ? Number(text) : NaN));
  const shown = values.get("show");
  return {
    frame,
    camera: camera.length === 6 && camera.every(Number.isFinite) && isView(camera) ? camera : null,
    selection: readSelection(values.get("p")),
    colouring: colourings.find((name) => name === values.get("by")) ?? null,
    shown: shown === null ? null : switches.filter((name) => shown.split(",").includes(name)),
  };
}

export function writeHash({ frame, camera, selection, colouring, shown }: PageState): string {
  const digits = (x: number) => Number(x.toPrecision(7)).toString();
  const parts = [`f=${frame ?? 0}`];
  if (camera) parts.push(`c=${camera.map(digits).join(",")}`);
  if (selection === "none") parts.push("p=none");
  else if (selection) parts.push(`p=${selection.body}${selection.shape === null ? "" : `:${selection.shape + 1}`}`);
  if (colouring) parts.push(`by=${colouring}`);
  if (shown) parts.push(`show=${shown.join(",")}`);
  return `#${parts.join("&")}`;
}

/** Reads "7", "7:2" (the second shape of row 7) or "none". */
function readSelection(text: string | null): PageState["selection"] {
  if (text === "none") return "none";
  const [first, second, ...more] = (text ?? "").split(":");
  const body = naturalNumber(first);
  const number = second === undefined ? null : naturalNumber(second);
  const isBroken = second !== undefined && !number;
  if (body === null || isBroken || more.length > 0) return null;
  return { body, shape: number === null ? null : number - 1 };
}

function naturalNumber(text: string | null): number | null {
  return text !== null && /^\d{1,9}$/.test(text) ? Number(text) : null;
}

/** Whether the eye is apart from its target. */
const isView = (camera: number[]): boolean => Math.hypot(...[0, 1, 2].map((i) => camera[i] - camera[i + 3])) > 1e-6;
