/** Detects how the browser can draw. */

export type Drawing = "none" | "software" | "hardware";

/** Returns none (no WebGL 2), software (emulated by the processor) or hardware. */
export function probeDrawing(): Drawing {
  const context = document.createElement("canvas").getContext("webgl2");
  if (!context) return "none";
  const info = context.getExtension("WEBGL_debug_renderer_info");
  const name = String(context.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : context.RENDERER));
  context.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name) ? "software" : "hardware";
}
