/** Entry point of the page: loads the recording, starts the player, shows errors. */
import { RecordingError } from "./format/bytes";
import { embeddedBytes, fetchedBytes, openInSlices } from "./load";
import { Player } from "./player";
import { probeDrawing } from "./scene/webgl";
import { byId, make } from "./ui/dom";

function showProgress(text: string, share: number | null): void {
  byId("loading").hidden = false;
  byId("loading-text").textContent = text;
  const bar = byId<HTMLProgressElement>("loading-bar");
  if (share === null) bar.removeAttribute("value");
  else bar.value = share;
}

function showError(title: string, text: string): void {
  byId("loading").hidden = true;
  byId("error").hidden = false;
  byId("error-title").textContent = title;
  byId("error-text").textContent = text;
  document.body.classList.add("bare");
}

const briefNoteMs = 8000;
let noteTimer = 0;

/** Shows a message beside the running player; what is in `backticks` is code. A click hides it; a brief one hides itself. */
function showNote(text: string, isBrief = false): void {
  const note = byId("note");
  note.replaceChildren(...text.split("`").map((part, i) => (i % 2 ? make("code", part) : part)));
  note.hidden = false;
  window.clearTimeout(noteTimer);
  if (isBrief) noteTimer = window.setTimeout(hideNote, briefNoteMs);
}
const hideNote = () => (byId("note").hidden = true);

async function start(getBytes: () => Promise<Uint8Array>): Promise<void> {
  byId("error").hidden = true;
  document.body.classList.remove("bare");
  const drawing = probeDrawing();
  document.documentElement.classList.toggle("plain", drawing === "software");
  if (drawing === "none") {
    showError(
      "This browser cannot draw 3D",
      "The viewer needs WebGL 2. Turn on hardware acceleration in the browser's settings, or use a newer browser.",
    );
    return;
  }
  try {
    showProgress("Loading the recording", null);
    const bytes = await getBytes();
    const recording = await openInSlices(bytes, showProgress);
    byId("loading").hidden = true;
    const player = new Player(recording, drawing === "software", showNote);
    if (recording.damage) {
      const { frameCount, damage } = recording;
      showNote(`The end of this recording is missing (${damage}). The viewer shows the first ${frameCount} frames.`);
    }
    document.documentElement.dataset.state = "ready";
    Object.assign(window, { fase: player });
  } catch (error) {
    document.documentElement.dataset.state = "error";
    const isKnown = error instanceof RecordingError;
    showError(isKnown ? "This recording cannot be shown" : "The viewer failed", (error as Error).message);
    if (!isKnown) console.error(error);
  }
}

function openFile(file: File): void {
  if (document.documentElement.dataset.state === "ready") {
    showNote("A recording is already open. Reload the page to open another.");
    return;
  }
  void start(async () => new Uint8Array(await file.arrayBuffer()));
}

byId("note").addEventListener("click", hideNote);
byId<HTMLInputElement>("open").addEventListener("change", (event) => {
  const file = (event.target as HTMLInputElement).files?.[0];
  if (file) openFile(file);
});
void start(async () => (await embeddedBytes(showProgress)) ?? (await fetchedBytes(showProgress)));
