/** The player: connects a recording, its view and the panels. */
import { Charts } from "./ui/charts";
import { BodyPanel } from "./ui/body_panel";
import { byId, legendKey } from "./ui/dom";
import { listenToKeys } from "./ui/keys";
import { drawMarks } from "./ui/marks";
import { listenToTaps } from "./ui/taps";
import { SwitchButton } from "./ui/switches";
import { type PageState, readHash, type Switch, switches, writeHash } from "./hash";
import { IdleQueue } from "./idle";
import type { Frame, Selection } from "./model";
import { Playback, speeds } from "./playback";
import type { Recording } from "./recording";
import { type Colouring, colourings, legendOf } from "./scene/colours";
import { Quality, savesNothing } from "./scene/quality";
import { View } from "./scene/view";

const prepareAhead = 40;
const hashPauseMs = 400;
/** how long a motion must have ended before a picture without savings is drawn, which may be slow */
const settleMs = 150;
/** so many pictures later, the browser has drawn the last change */
const minStillTicks = 3;
const noContacts =
  "This recording has no contact points. To record them, add `--contacts` to `fase run SCENE --record FILE`.";
/** windows up to this width start without charts */
const narrow = 720;

export class Player {
  readonly playback: Playback;
  readonly view: View;
  private readonly idle: IdleQueue;
  private readonly charts: Charts;
  private readonly panel: BodyPanel;
  private readonly scrub = byId<HTMLInputElement>("scrub");
  private readonly quality: Quality;
  private readonly switches: Record<Switch, SwitchButton>;
  private isDirty = true;
  private wasMoving = false;
  private isFollowing = false;
  private drawn = -1;
  private lastTick = 0;
  private lastMotion = 0;
  private stillTicks = 0;
  private hashTimer = 0;
  private chartTimer = 0;
  private preparing = -1;

  /** `onNote` shows a message; the player continues. */
  constructor(
    private readonly recording: Recording,
    isSoftware: boolean,
    private readonly onNote: (text: string, isBrief?: boolean) => void,
  ) {
    const { tables, frameCount } = recording;
    const canvas = byId<HTMLCanvasElement>("scene");
    const dirty = () => this.invalidate();
    const pageState = readHash(location.hash);
    this.view = new View(canvas, tables, recording.frame(0), isSoftware, () => {
      this.isDirty = true;
      this.saveHash();
    });
    this.quality = new Quality(this.view.coarserSteps, isSoftware ? this.view.softwareLevel : 0);
    this.playback = new Playback(frameCount, tables.timeStep > 0 ? tables.timeStep : 1 / 60, dirty);
    this.idle = new IdleQueue((error) => this.onNote((error as Error).message));
    this.charts = new Charts(tables, frameCount, (frame) => this.playback.seek(frame));
    this.panel = new BodyPanel(tables, {
      follow: () => this.follow(!this.isFollowing),
      close: () => this.select(null),
    });
    document.title = `${tables.title || "recording"} – Fase`;
    this.scrub.max = String(frameCount - 1);
    this.switches = {
      boxes: new SwitchButton("boxes", (on) => (this.view.showsBoxes = on)),
      contacts: new SwitchButton("contacts", (on) => (this.view.showsContacts = on)),
      charts: new SwitchButton("chart-toggle", (on) => this.showCharts(on)),
    };
    this.connect(canvas);
    this.charts.draw(0);
    this.switches.charts.on = window.innerWidth > narrow;
    this.resize();
    new ResizeObserver(() => this.publishDockHeight()).observe(byId("dock"));
    this.view.reframe();
    this.setColouring("material");
    this.apply(pageState);
    if (pageState.frame === null && !matchMedia("(prefers-reduced-motion: reduce)").matches) this.playback.toggle();
    this.idle.add(recording.readSummaries(this.charts.summaries), { done: () => this.refreshCharts() });
    this.chartTimer = window.setInterval(() => this.refreshCharts(), 250);
    if (!tables.hasContacts) {
      byId("contacts").dataset.missing = "true";
      byId("contacts").title = noContacts.replaceAll("`", "");
    }
    requestAnimationFrame((now) => this.tick(now));
  }

  private connect(canvas: HTMLCanvasElement): void {
    const { playback, view } = this;
    const click = (id: string, act: () => void) => byId(id).addEventListener("click", act);
    const help = byId<HTMLDialogElement>("help");
    const commands = {
      toggle: () => playback.toggle(),
      step: (frames: number) => playback.step(frames),
      stepSecond: (direction: number) =>
        playback.step(direction * Math.max(1, Math.round(1 / playback.secondsPerFrame))),
      toEnd: (last: boolean) => playback.seek(last ? playback.last : 0),
      faster: (steps: number) => playback.faster(steps),
      nextColours: () => this.setColouring(colourings[(colourings.indexOf(view.colouring) + 1) % colourings.length]),
      toggleBoxes: () => this.press("boxes"),
      toggleContacts: () => this.press("contacts"),
      toggleCharts: () => this.press("charts"),
      togglePanels: () => this.togglePanels(),
      follow: () => this.follow(!this.isFollowing),
      reframe: () => {
        this.follow(false);
        view.reframe();
        this.invalidate();
      },
      copyLink: () => void this.copyLink(),
      deselect: () => this.select(null),
      help: () => (help.open ? help.close() : help.showModal()),
    };
    click("play", commands.toggle);
    click("back", () => commands.step(-1));
    click("forward", () => commands.step(1));
    click("boxes", commands.toggleBoxes);
    click("contacts", commands.toggleContacts);
    click("chart-toggle", commands.toggleCharts);
    click("reframe", commands.reframe);
    click("link", commands.copyLink);
    click("panels", commands.togglePanels);
    click("show-panels", commands.togglePanels);
    click("help-open", commands.help);
    click("help-close", commands.help);
    help.addEventListener("click", (event) => event.target === help && help.close());
    listenToKeys(commands);
    listenToTaps(canvas, (x, y) => this.select(view.pickAt(x, y)));

    const colours = byId<HTMLSelectElement>("colours");
    colours.addEventListener("change", () => this.setColouring(colours.value as Colouring));
    const speed = byId<HTMLSelectElement>("speed");
    speed.replaceChildren(...speeds.map((value) => new Option(`${value}×`, String(value))));
    speed.addEventListener("change", () => playback.setSpeed(Number(speed.value)));
    this.scrub.addEventListener("input", () => playback.seek(Number(this.scrub.value)));
    window.addEventListener("resize", () => this.resize());
    document.addEventListener("visibilitychange", () => (this.wasMoving = false));
    window.addEventListener("hashchange", () => this.apply(readHash(location.hash)));
  }

  private invalidate(): void {
    this.isDirty = true;
    this.drawn = -1;
    document.documentElement.dataset.still = "false";
    this.saveHash();
  }

  private tick(now: number): void {
    requestAnimationFrame((next) => this.tick(next));
    const interval = now - this.lastTick;
    this.playback.advance(interval / 1000);
    this.lastTick = now;
    const state = document.documentElement.dataset;
    const isMoving = this.isDirty;
    if (isMoving) this.lastMotion = now;
    const isSettled = now - this.lastMotion > settleMs;
    const isStill = !isMoving && !this.view.isCoarse;
    this.stillTicks = isStill ? this.stillTicks + 1 : 0;
    state.still = String(this.stillTicks >= minStillTicks);
    if (isStill || (!isMoving && !isSettled)) {
      this.wasMoving = false;
      return;
    }
    this.isDirty = false;
    if (this.drawn < 0) this.showFrame();
    if (isMoving && this.wasMoving) this.quality.record(interval);
    this.wasMoving = isMoving;
    if (this.view.draw(isMoving ? this.quality.saving : savesNothing)) this.isDirty = true;
    state.frame = String(this.playback.frame);
  }

  private showFrame(): void {
    const { playback, view } = this;
    let frame: Frame;
    try {
      frame = this.frameAt(playback.frame);
      view.show(frame, playback.share > 0 ? this.frameAt(playback.frame + 1) : frame, playback.share);
      this.showBody(frame);
    } catch (error) {
      playback.playing = false;
      this.onNote((error as Error).message);
      return;
    }
    this.drawn = playback.frame;
    this.prepareNext();
    this.showState(frame);
  }

  private frameAt(number: number): Frame {
    return this.recording.frame(Math.max(0, Math.min(this.playback.last, number)));
  }

  private prepareNext(): void {
    const ahead = this.playback.frame + prepareAhead;
    if (!this.playback.playing || Math.floor(ahead / 32) === this.preparing) return;
    this.preparing = Math.floor(ahead / 32);
    this.idle.add(this.recording.prepare(ahead), { first: true });
  }

  private showState(frame: Frame): void {
    const { playback, recording } = this;
    const { bodies, title } = recording.tables;
    let present = 0;
    let awake = 0;
    for (let row = 0; row < bodies.length; ++row) {
      present += frame.present[row];
      awake += frame.present[row] & frame.flags[row] & 1;
    }
    byId("summary").textContent =
      `${title ? `${title} · ` : ""}${present.toLocaleString("en-GB")} bodies, ${awake.toLocaleString("en-GB")} awake`;
    const isPlaying = playback.playing;
    const play = byId("play");
    play.setAttribute("aria-label", isPlaying ? "Pause" : "Play");
    play.querySelector("use")?.setAttribute("href", isPlaying ? "#icon-pause" : "#icon-play");
    this.scrub.value = String(playback.frame);
    this.scrub.setAttribute("aria-valuetext", `frame ${playback.frame}, ${frame.time.toFixed(2)} seconds`);
    const time = document.createElement("b");
    time.textContent = `${frame.time.toFixed(2)} s`;
    byId("clock").replaceChildren(time, ` ${playback.frame} / ${playback.last}`);
    byId<HTMLSelectElement>("speed").value = String(playback.speed);
    byId<HTMLButtonElement>("back").disabled = playback.frame === 0 && playback.share === 0;
    byId<HTMLButtonElement>("forward").disabled = playback.frame >= playback.last;
    if (!byId("charts").hidden) this.charts.draw(playback.frame);
  }

  private showBody(frame: Frame): void {
    const selection = this.view.selected;
    if (selection === null && this.panel.shown === null) return;
    const before = this.frameAt(frame.number - 1);
    const after = this.frameAt(frame.number + 1);
    const isIn = (other: Frame) => selection !== null && other.present[selection.body] === 1;
    this.panel.show(selection, frame, isIn(before) ? before : frame, isIn(after) ? after : frame, this.isFollowing);
  }

  private refreshCharts(): void {
    const { summaries } = this.charts;
    this.charts.appendNew();
    const isComplete = summaries.length >= this.recording.frameCount;
    if (isComplete) window.clearInterval(this.chartTimer);
    drawMarks(byId<HTMLCanvasElement>("marks"), summaries, this.recording.frameCount);
    if (!byId("charts").hidden) this.charts.draw(this.playback.frame);
    document.documentElement.dataset.charts = isComplete ? "complete" : "loading";
  }

  private select(selection: Selection | null): void {
    if (selection?.body !== this.view.selected?.body) this.follow(false);
    this.view.select(selection);
    this.invalidate();
  }

  private follow(on: boolean): void {
    const row = this.view.selected?.body ?? null;
    this.isFollowing = on && row !== null;
    this.view.follow(this.isFollowing ? row : null);
    this.invalidate();
  }

  private setColouring(by: Colouring): void {
    this.view.colouring = by;
    byId<HTMLSelectElement>("colours").value = by;
    byId("legend").replaceChildren(...legendOf(by).map(({ name, colour }) => legendKey(colour, name)));
    this.invalidate();
  }

  private press(name: Switch): void {
    if (name === "contacts" && !this.recording.tables.hasContacts) return this.onNote(noContacts, true);
    this.switches[name].on = !this.switches[name].on;
    this.invalidate();
  }

  private showCharts(on: boolean): void {
    byId("charts").hidden = !on;
    this.resize();
  }

  private togglePanels(): void {
    const bare = document.body.classList.toggle("bare");
    byId("show-panels").hidden = !bare;
    this.resize();
  }

  private resize(): void {
    this.publishDockHeight();
    this.view.resize(window.innerWidth, window.innerHeight, byId("dock").offsetHeight);
    this.charts.resize();
    this.refreshCharts();
    this.invalidate();
  }

  /** Publishes the height of the dock, so that other panels stay above it. */
  private publishDockHeight(): void {
    document.documentElement.style.setProperty("--dock", `${byId("dock").offsetHeight}px`);
  }

  private saveHash(): void {
    window.clearTimeout(this.hashTimer);
    this.hashTimer = window.setTimeout(() => {
      if (this.playback.playing) return this.saveHash();
      history.replaceState(null, "", writeHash(this.pageState));
    }, hashPauseMs);
  }

  private get pageState(): PageState {
    return {
      frame: this.playback.frame,
      camera: this.view.camera.eyeAndTarget,
      selection: this.view.selected ?? "none",
      colouring: this.view.colouring,
      shown: switches.filter((name) => this.switches[name].on),
    };
  }

  /** Shows what the address says; what it does not say, or says for another recording, stays as it is. */
  private apply({ frame, camera, selection, colouring, shown }: PageState): void {
    const { bodies, hasContacts } = this.recording.tables;
    if (shown)
      for (const name of switches)
        this.switches[name].on = shown.includes(name) && (name !== "contacts" || hasContacts);
    if (colouring) this.setColouring(colouring);
    if (selection === "none") this.select(null);
    else if (selection && (selection.shape ?? 0) < (bodies[selection.body]?.colliders.length ?? 0)) this.select(selection);
    if (camera) {
      this.follow(false);
      this.view.camera.eyeAndTarget = camera;
    }
    if (frame !== null) {
      this.playback.playing = false;
      this.playback.seek(frame);
    }
    this.invalidate();
  }

  /** Copies a link to this picture; without access to the clipboard, it stays in the address of the page. */
  private async copyLink(): Promise<void> {
    history.replaceState(null, "", writeHash(this.pageState));
    try {
      await navigator.clipboard.writeText(location.href);
      this.onNote("Copied a link to this picture.", true);
    } catch {
      this.onNote("The address of this page is the link to this picture; copy it from there.", true);
    }
  }
}
