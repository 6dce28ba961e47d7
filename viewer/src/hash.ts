/** Stores frame and camera in the address of the page: #f=120&c=… */

export interface PageState {
  frame: number | null;
  /** eye and target, six numbers */
  camera: number[] | null;
}

export function readHash(hash: string): PageState {
  const values = new URLSearchParams(hash.replace(/^#/, ""));
  const frame = Number(values.get("f") ?? NaN);
  const camera = (values.get("c") ?? "").split(",").map(Number);
  return {
    frame: Number.isInteger(frame) && frame >= 0 ? frame : null,
    camera: camera.length === 6 && camera.every(Number.isFinite) ? camera : null,
  };
}

export function writeHash({ frame, camera }: PageState): string {
  const digits = (x: number) => Number(x.toPrecision(6)).toString();
  return `#f=${frame ?? 0}${camera ? `&c=${camera.map(digits).join(",")}` : ""}`;
}
