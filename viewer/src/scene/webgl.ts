/** What the browser can draw with. */

export type Drawing = "none" | "software" | "hardware";

/** Looks before the scene is made: no WebGL 2, one that the processor emulates, or a graphics card. */
export function probeDrawing(): Drawing {
  const context = document.createElement("canvas").getContext("webgl2");
  if (!context) return "none";
  const info = context.getExtension("WEBGL_debug_renderer_info");
  const name = String(context.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : context.RENDERER));
  context.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name) ? "software" : "hardware";
}
