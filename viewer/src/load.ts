/** Loads the bytes of a recording from the page itself, from the server, or from a file that the user opens. */
import { RecordingError } from "./format/bytes";
import { Recording } from "./recording";

export type Progress = (text: string, share: number | null) => void;

const base64Piece = 4 * 1024 * 1024;

/** Returns the recording embedded in `<script id="recording">`, or null. */
export async function embeddedBytes(progress: Progress): Promise<Uint8Array | null> {
  const element = document.getElementById("recording");
  if (!element) return null;
  const text = (element.textContent ?? "").trim();
  element.remove();
  const padding = text.endsWith("==") ? 2 : text.endsWith("=") ? 1 : 0;
  const bytes = new Uint8Array(Math.max(0, Math.floor((text.length * 3) / 4) - padding));
  let filled = 0;
  for (let from = 0; from < text.length; from += base64Piece) {
    let piece: string;
    try {
      piece = atob(text.slice(from, from + base64Piece));
    } catch {
      throw new RecordingError("the recording inside this page is damaged (not base64)");
    }
    for (let i = 0; i < piece.length; ++i) bytes[filled++] = piece.charCodeAt(i);
    progress("Unpacking the page", from / text.length);
    await pause();
  }
  return bytes.subarray(0, filled);
}

/** Downloads /recording from the server. */
export async function fetchedBytes(progress: Progress): Promise<Uint8Array> {
  let response: Response;
  try {
    response = await fetch("/recording");
  } catch {
    throw new RecordingError("the server does not respond; check that `fase view` is running");
  }
  if (!response.ok || !response.body) {
    const details = (await response.text().catch(() => "")).trim().slice(0, 500);
    throw new RecordingError(
      `the server responds with ${response.status} ${response.statusText}${details ? `\n${details}` : ""}`,
    );
  }
  const length = Number(response.headers.get("Content-Length")) || 0;
  const pieces: Uint8Array[] = [];
  let filled = 0;
  const reader = response.body.getReader();
  for (;;) {
    let step: ReadableStreamReadResult<Uint8Array>;
    try {
      step = await reader.read();
    } catch {
      throw new RecordingError(`the connection ended after ${filled} bytes`);
    }
    if (step.done) break;
    pieces.push(step.value);
    filled += step.value.length;
    progress(`Loading ${(filled / 1e6).toFixed(1)} MB`, length ? filled / length : null);
  }
  const bytes = new Uint8Array(filled);
  let at = 0;
  for (const piece of pieces) {
    bytes.set(piece, at);
    at += piece.length;
  }
  return bytes;
}

/** Opens a recording in slices, so that the page stays responsive. */
export async function openInSlices(bytes: Uint8Array, progress: Progress): Promise<Recording> {
  const work = Recording.open(bytes);
  let last = performance.now();
  for (;;) {
    const step = work.next();
    if (step.done) return step.value;
    if (performance.now() - last < 12) continue;
    progress("Checking", step.value);
    await pause();
    last = performance.now();
  }
}

const pause = () => new Promise<void>((resume) => setTimeout(resume));
