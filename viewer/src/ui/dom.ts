/** Finds and creates elements. */

/** Returns the element with this id; a missing element is an internal error. */
export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
  const element = document.getElementById(id);
  if (!element) throw new Error(`the page has no #${id}`);
  return element as T;
}

export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  text = "",
  children: Node[] = [],
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  if (text) element.textContent = text;
  element.append(...children);
  return element;
}

export const cssColour = (rgb: number): string => `#${rgb.toString(16).padStart(6, "0")}`;

/** Creates a coloured square and a name, followed by `value` in bold. */
export function legendKey(colour: number, name: string, value = ""): HTMLElement {
  const swatch = make("i");
  swatch.style.background = cssColour(colour);
  const key = make("span", "", [swatch, document.createTextNode(name)]);
  key.className = "key";
  if (value) key.append(make("b", value));
  return key;
}

/** Resizes a canvas to the screen's pixels. Returns its context in CSS pixels, or null when the canvas has no size. */
export function sharpContext(canvas: HTMLCanvasElement): CanvasRenderingContext2D | null {
  const { width, height } = canvas.getBoundingClientRect();
  const ratio = Math.min(window.devicePixelRatio || 1, 2);
  const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (w === 0 || h === 0) return null;
  if (canvas.width !== w || canvas.height !== h) {
    canvas.width = w;
    canvas.height = h;
  }
  const context = canvas.getContext("2d");
  context?.setTransform(ratio, 0, 0, ratio, 0, 0);
  context?.clearRect(0, 0, width, height);
  return context;
}
