/** Tests the page in a browser: user actions and error messages. */
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import os from "node:os";
import path from "node:path";
import { after, before, describe, test } from "node:test";
import type { Browser, BrowserContextOptions, Page } from "playwright-core";
import { Recording } from "../../src/recording";
import { chunk, fileHeader, join } from "../encode";
import { makeFixture } from "../fixtures";
import { buildPage, findBrowser, saveScreenshot, launch, PageServer, type Visit, visit } from "./page";

const skip = findBrowser() ? false : "skipped: no chromium on this system";
const real = process.env.FASE_RECORDING;
const fixture = makeFixture({ frames: 240 }).file;
const level = makeFixture({ frames: 40, columns: 8, courses: 6, tiles: 1280 }).file;
const phone: BrowserContextOptions = {
  viewport: { width: 375, height: 800 },
  hasTouch: true,
  isMobile: true,
  deviceScaleFactor: 2,
};

const frameOf = (page: Page) => page.evaluate(() => Number(document.documentElement.dataset.frame));
const waitForFrame = (page: Page, frame: number) =>
  page.waitForFunction((expected) => document.documentElement.dataset.frame === String(expected), frame, {
    timeout: 30_000,
  });
const waitForMore = (page: Page, frame: number) =>
  page.waitForFunction((passed) => Number(document.documentElement.dataset.frame) > passed, frame, { timeout: 30_000 });
const text = (page: Page, selector: string) => page.locator(selector).innerText();

/** Returns the page as shown, its charts complete: red, green, blue of every fourth pixel in each direction. */
async function pixels(page: Page): Promise<number[]> {
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  await page.waitForSelector("html[data-still=true][data-charts=complete]", { timeout: 60_000 });
  const png = (await page.screenshot({ animations: "disabled" })).toString("base64");
  return page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const canvas = new OffscreenCanvas(image.width / 4, image.height / 4);
    const context = canvas.getContext("2d") as OffscreenCanvasRenderingContext2D;
    context.drawImage(image, 0, 0, canvas.width, canvas.height);
    return Array.from(context.getImageData(0, 0, canvas.width, canvas.height).data).filter((_, i) => i % 4 !== 3);
  }, png);
}
function changed(a: number[], b: number[]): number {
  let count = 0;
  for (let i = 0; i < a.length; i += 3)
    if (Math.abs(a[i] - b[i]) + Math.abs(a[i + 1] - b[i + 1]) + Math.abs(a[i + 2] - b[i + 2]) > 12) ++count;
  return count / (a.length / 3);
}

/** What the page publishes for tests and for the console. */
interface ViewerWindow {
  fase: {
    recording: Recording;
    view: {
      saved: { share: number; shadows: boolean; coarser: number };
      poses: { positions: Float64Array };
      camera: { distance: number };
      pickAt(x: number, y: number): { body: number; shape: number | null } | null;
      project(p: number[]): { x: number; y: number };
    };
  };
}

/** Returns the distance of the camera from its target, in metres. */
const distanceOf = (page: Page) =>
  page.evaluate(() => (window as unknown as ViewerWindow).fase.view.camera.distance);

/** Returns a shape of the body "level" that no panel covers, and where it is in the window. */
const visibleTile = (page: Page) =>
  page.evaluate(() => {
    const { view } = (window as unknown as ViewerWindow).fase;
    for (let y = 340; y > 120; y -= 7)
      for (let x = 60; x < 740; x += 11) {
        const picked = view.pickAt(x, y);
        if (picked && picked.shape !== null && picked.shape > 8) return { shape: picked.shape, x, y };
      }
    throw new Error("no tile is visible");
  });

/** Returns the window position of a body. */
const positionOf = (page: Page, name: string) =>
  page.evaluate((bodyName) => {
    const { recording, view } = (window as unknown as ViewerWindow).fase;
    const row = recording.tables.bodies.findIndex((body) => body.name === bodyName);
    return view.project([...view.poses.positions.subarray(3 * row, 3 * row + 3)]);
  }, name);

describe("the viewer in a browser", { skip }, () => {
  let browser: Browser;
  let server: PageServer;
  let built: ReturnType<typeof buildPage>;
  const opened: Visit[] = [];

  before(async () => {
    built = buildPage();
    server = await PageServer.start(built.folder);
    browser = await launch();
  });
  after(async () => {
    await browser?.close();
    server?.stop();
    built?.remove();
  });

  /** Opens the page with a recording; finish() fails if the page has reported problems. */
  async function open(
    options: { file?: Uint8Array | null; hash?: string; context?: BrowserContextOptions } = {},
  ): Promise<Visit> {
    server.recording = options.file === undefined ? fixture : options.file;
    const visited = await visit(browser, server.url + (options.hash ?? ""), options.context);
    opened.push(visited);
    return visited;
  }
  async function finish(visited: Visit): Promise<void> {
    await visited.close();
    assert.deepEqual(visited.problems, []);
  }

  test("a recording loads without problems and its picture is not blank", async () => {
    const visited = await open({ hash: "#f=90" });
    const { page } = visited;
    assert.equal(await page.getAttribute("html", "data-state"), "ready");
    assert.match(await page.title(), /test wall/);
    assert.match(await text(page, "#summary"), /bodies, \d+ awake/);
    const seen = await pixels(page);
    const colours = new Set<number>();
    for (let i = 0; i < seen.length; i += 3)
      colours.add((seen[i] >> 4) * 256 + (seen[i + 1] >> 4) * 16 + (seen[i + 2] >> 4));
    assert.ok(colours.size > 60, `${colours.size} colours`);
    await saveScreenshot(page, "wall");
    await finish(visited);
  });

  test("play and pause work, and the picture changes", async () => {
    const visited = await open({ hash: "#f=60" });
    const { page } = visited;
    const still = await pixels(page);
    await page.click("#play");
    await page.waitForFunction(() => Number(document.documentElement.dataset.frame) > 66, null, { timeout: 30_000 });
    assert.equal(await page.getAttribute("#play", "aria-label"), "Pause");
    await page.click("#play");
    const paused = await frameOf(page);
    await page.waitForTimeout(300);
    assert.equal(await frameOf(page), paused);
    assert.ok(changed(still, await pixels(page)) > 0.001);
    await finish(visited);
  });

  test("a page without a frame in its address starts playing, unless the visitor prefers reduced motion", async () => {
    const moving = await open();
    await moving.page.waitForFunction(() => Number(document.documentElement.dataset.frame) > 2, null, {
      timeout: 30_000,
    });
    await finish(moving);
    const calm = await open({ context: { reducedMotion: "reduce" } });
    await pixels(calm.page);
    assert.equal(await frameOf(calm.page), 0);
    await finish(calm);
  });

  test("step buttons, keys and the scrub bar go to the right frame", async () => {
    const visited = await open({ hash: "#f=10" });
    const { page } = visited;
    await waitForFrame(page, 10);
    await page.click("#forward");
    await waitForFrame(page, 11);
    await page.click("#back");
    await page.click("#back");
    await waitForFrame(page, 9);
    await page.keyboard.press("ArrowRight");
    await waitForFrame(page, 10);
    await page.keyboard.press("Shift+ArrowRight");
    await waitForFrame(page, 70);
    await page.keyboard.press("End");
    await waitForFrame(page, 239);
    assert.ok(await page.isDisabled("#forward"));
    await page.keyboard.press("Home");
    await waitForFrame(page, 0);
    await page.keyboard.press("+");
    await page.waitForFunction(() => (document.getElementById("speed") as HTMLSelectElement).value === "2");
    const bar = await page.locator("#scrub").boundingBox();
    assert.ok(bar);
    await page.mouse.click(bar.x + bar.width / 2, bar.y + bar.height / 2);
    await page.waitForFunction(() => Math.abs(Number(document.documentElement.dataset.frame) - 119) < 8);
    const speed = await page.inputValue("#speed");
    await page.selectOption("#speed", "0.1");
    assert.equal(speed, "2");
    await page.locator("#scene").focus();
    await page.keyboard.press(" ");
    await page.waitForFunction(() => document.getElementById("play")?.getAttribute("aria-label") === "Pause");
    await page.keyboard.press(" ");
    await finish(visited);
  });

  test("colours, world boxes and contact points change the picture and restore it", async () => {
    const visited = await open({ hash: "#f=95" });
    const { page } = visited;
    const plain = await pixels(page);
    const pictures = [plain];
    for (const by of ["kind", "island", "sleep"]) {
      await page.selectOption("#colours", by);
      const now = await pixels(page);
      for (const other of pictures) assert.ok(changed(other, now) > 0.004, by);
      pictures.push(now);
      await saveScreenshot(page, `colours-${by}`);
    }
    await page.selectOption("#colours", "material");
    for (const id of ["boxes", "contacts"]) {
      const before = await pixels(page);
      await page.click(`#${id}`);
      assert.equal(await page.getAttribute(`#${id}`, "aria-pressed"), "true");
      const on = await pixels(page);
      assert.ok(changed(before, on) > 0.0005, id);
      await saveScreenshot(page, id);
      await page.click(`#${id}`);
      await page.mouse.move(500, 300);
      assert.ok(changed(before, await pixels(page)) < 0.002, id);
    }
    await finish(visited);
  });

  test("a click picks a body, its panel shows its state, and the camera follows it", async () => {
    const visited = await open({ hash: "#f=20" });
    const { page } = visited;
    await waitForFrame(page, 20);
    const { x, y } = await positionOf(page, "ball");
    await page.mouse.click(x, y);
    await page.waitForSelector("#body:not([hidden])");
    assert.equal(await text(page, "#body-name"), "ball");
    const state = await text(page, "#body-state");
    for (const words of ["dynamic", "awake", "sphere r 0.6 m", "1099511627777", "m/s", "100 kg"])
      assert.ok(state.includes(words), words);
    await saveScreenshot(page, "picked");
    await page.keyboard.press("f");
    for (let i = 0; i < 20; ++i) await page.keyboard.press("ArrowRight");
    await waitForFrame(page, 40);
    await pixels(page);
    const followed = await positionOf(page, "ball");
    assert.ok(Math.hypot(followed.x - x, followed.y - y) < 3, "it keeps its position in the window");
    await saveScreenshot(page, "followed");
    await page.keyboard.press("Escape");
    await page.waitForSelector("#body", { state: "hidden" });
    await finish(visited);
  });

  test("dragging rotates the camera, the wheel zooms, and the address stores camera and frame", async () => {
    const visited = await open({ hash: "#f=30" });
    const { page } = visited;
    const before = await pixels(page);
    await page.mouse.move(500, 250);
    await page.mouse.down();
    await page.mouse.move(640, 280, { steps: 5 });
    await page.mouse.up();
    const distance = await distanceOf(page);
    await page.mouse.wheel(0, -400);
    await page.waitForFunction((d) => (window as unknown as ViewerWindow).fase.view.camera.distance < d, distance);
    const rotated = await pixels(page);
    assert.ok(changed(before, rotated) > 0.02);
    assert.equal(await page.isVisible("#body"), false, "a drag is not a click");
    await page.waitForFunction(() => location.hash.includes("c="));
    const again = await open({ hash: await page.evaluate(() => location.hash) });
    assert.equal(await frameOf(again.page), 30);
    assert.ok(changed(rotated, await pixels(again.page)) < 0.01);
    await page.keyboard.press("r");
    assert.ok(changed(before, await pixels(page)) < 0.01, "r restores the initial view");
    await finish(again);
    await finish(visited);
  });

  test("charts show the frame at the pointer, and a click goes there", async () => {
    const visited = await open({ hash: "#f=0" });
    const { page } = visited;
    const box = await page.locator("#chart-times").boundingBox();
    assert.ok(box);
    await page.waitForSelector("html[data-charts=complete]");
    const left = Number(await page.getAttribute("#chart-times", "data-plot"));
    const quarter = box.x + left + (box.width - left) / 4;
    await page.mouse.move(quarter, box.y + box.height / 2);
    await page.waitForSelector("#tip:not([hidden])");
    const tip = await text(page, "#tip");
    for (const words of ["solve", "contact points"]) assert.ok(tip.includes(words), words);
    const frame = Number(/frame (\d+)/.exec(tip)?.[1]);
    assert.ok(Math.abs(frame - 60) <= 1, `frame ${frame}`);
    await saveScreenshot(page, "chart");
    await page.mouse.click(quarter, box.y + box.height / 2);
    await waitForFrame(page, frame);
    await page.keyboard.press("g");
    assert.equal(await page.isVisible("#charts"), false);
    await finish(visited);
  });

  test("no line, area or cursor of a chart crosses its labels", async () => {
    const visited = await open({ hash: "#f=0" });
    const { page } = visited;
    await pixels(page);
    for (const id of ["chart-times", "chart-counts"]) {
      const seen = await page.evaluate((name) => {
        const canvas = document.getElementById(name) as HTMLCanvasElement;
        const left = Math.floor((Number(canvas.dataset.plot) * canvas.width) / canvas.clientWidth) - 1;
        const { data } = (canvas.getContext("2d") as CanvasRenderingContext2D).getImageData(0, 0, canvas.width, canvas.height);
        const found = { text: 0, coloured: 0, plot: 0 };
        for (let i = 0; i < data.length; i += 4) {
          const [r, g, b, alpha] = data.subarray(i, i + 4);
          const isColoured = alpha > 40 && Math.max(r, g, b) - Math.min(r, g, b) > 50;
          if ((i / 4) % canvas.width >= left) found.plot += isColoured ? 1 : 0;
          else if (isColoured) ++found.coloured;
          else if (alpha > 100) ++found.text;
        }
        return found;
      }, id);
      assert.ok(seen.text > 20 && seen.plot > 200, `${id}: ${JSON.stringify(seen)}`);
      assert.equal(seen.coloured, 0, id);
    }
    await finish(visited);
  });

  test("without a graphics card, a heavy recording in motion leaves out pixels and shadows, and nothing when still", async () => {
    const heavy = makeFixture({ frames: 90, columns: 100, courses: 60 }).file;
    const visited = await open({ file: heavy, hash: "#f=0" });
    const { page } = visited;
    const still = await pixels(page);
    await saveScreenshot(page, "heavy");
    await page.click("#play");
    await waitForMore(page, 4);
    const saved = await page.evaluate(() => (window as unknown as ViewerWindow).fase.view.saved);
    assert.ok(saved.share < 1 && !saved.shadows, JSON.stringify(saved));
    await saveScreenshot(page, "heavy-moving");
    await page.click("#play");
    await page.keyboard.press("Home");
    await page.mouse.move(500, 300);
    const again = await pixels(page);
    await saveScreenshot(page, "heavy-still");
    assert.ok(changed(still, again) < 0.002, `${changed(still, again)}`);
    await finish(visited);
  });

  test("a link restores frame, camera, selection, colours and switches; broken links change nothing", async () => {
    const visited = await open({ file: level, hash: "#f=20" });
    const { page } = visited;
    await page.waitForSelector("html[data-charts=complete]");
    await page.selectOption("#colours", "kind");
    await page.click("#boxes");
    await page.keyboard.press("g");
    await page.mouse.move(400, 200);
    await page.mouse.down();
    await page.mouse.move(460, 240, { steps: 4 });
    await page.mouse.up();
    await page.waitForSelector("html[data-still=true]");
    const { shape, x, y } = await visibleTile(page);
    await page.mouse.click(x, y);
    await page.waitForSelector("#body:not([hidden])");
    const words = `number ${(shape + 1).toLocaleString("en-GB")} of 1,280`;
    assert.ok((await text(page, "#body-state")).includes(words), words);
    await page.mouse.move(400, 200);
    const shown = await pixels(page);
    await saveScreenshot(page, "picked-shape");
    await page.waitForFunction((n) => /by=kind/.test(location.hash) && location.hash.includes(`:${n}&`), shape + 1);
    const hash = await page.evaluate(() => location.hash);
    const again = await open({ file: level, hash });
    const other = again.page;
    await other.waitForFunction(() => document.documentElement.dataset.frame === "20");
    assert.ok(changed(shown, await pixels(other)) < 0.004, "a new page shows the same");
    assert.ok((await text(other, "#body-state")).includes(words), words);
    assert.equal(await other.isVisible("#charts"), false);
    assert.equal(await other.getAttribute("#boxes", "aria-pressed"), "true");
    for (const broken of ["#f=x&c=1,2&p=99999:3&by=pink&nothing", "#p=0:77&c=0,0,0,0,0,0", "#%%%"]) {
      await other.evaluate((text) => (location.hash = text), broken);
      assert.ok(changed(shown, await pixels(other)) < 0.004, broken);
    }
    await other.evaluate(() => (location.hash = "#f=3&p=none&by=material&show=charts"));
    await waitForFrame(other, 3);
    assert.equal(await other.isVisible("#body"), false);
    assert.ok(await other.isVisible("#charts"));
    await other.evaluate((text) => (location.hash = text), hash);
    await waitForFrame(other, 20);
    assert.ok(changed(shown, await pixels(other)) < 0.004, "so does an open page");
    await finish(again);
    await finish(visited);
  });

  test("the link button copies the address of the picture, also while it plays", async () => {
    const visited = await open({ context: { permissions: ["clipboard-read", "clipboard-write"] } });
    const { page } = visited;
    await waitForMore(page, 3);
    await page.click("#link");
    await page.waitForSelector("#note:not([hidden])");
    assert.match(await text(page, "#note"), /Copied/);
    const copied = await page.evaluate(() => navigator.clipboard.readText());
    assert.ok(copied.startsWith(`${server.url}#f=`) && /&c=.*&p=none&by=material&show=charts$/.test(copied), copied);
    await page.click("#note");
    assert.equal(await page.isVisible("#note"), false);
    await finish(visited);
  });

  test("the contacts button of a recording without contacts says how to record them", async () => {
    const file = makeFixture({ frames: 10, contacts: false }).file;
    for (const context of [{}, phone]) {
      const visited = await open({ file, hash: "#f=5", context });
      const { page } = visited;
      if (context === phone) await page.tap("#contacts");
      else await page.click("#contacts");
      await page.waitForSelector("#note:not([hidden])");
      assert.match(await text(page, "#note"), /no contact points.*--contacts/);
      assert.equal(await page.getAttribute("#contacts", "aria-pressed"), "false");
      await saveScreenshot(page, context === phone ? "phone-contacts" : "contacts-missing");
      await finish(visited);
    }
  });

  test("on a phone legends wrap within the screen, and help begins with touch", async () => {
    const visited = await open({ hash: "#f=20&show=charts&by=island", context: phone });
    const { page } = visited;
    await pixels(page);
    const outside = await page.evaluate(() =>
      [...document.querySelectorAll(".key, figcaption > *, #tools > *, #transport > *")]
        .map((element) => ({ text: element.textContent, box: element.getBoundingClientRect() }))
        .filter(({ box }) => box.width > 0 && (box.left < 0 || box.right > innerWidth || box.bottom > innerHeight))
        .map(({ text }) => text),
    );
    assert.deepEqual(outside, []);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), true);
    await saveScreenshot(page, "phone-charts");
    await page.tap("#help-open");
    const tops = await page.evaluate(() =>
      ["help-touch", "help-mouse", "help-keys"].map((id) => document.getElementById(id)?.getBoundingClientRect().top ?? 0),
    );
    assert.ok(tops[0] < tops[1] && tops[1] < tops[2]);
    await saveScreenshot(page, "phone-help");
    await finish(visited);
    const desk = await open({ hash: "#f=20" });
    await desk.page.keyboard.press("?");
    assert.ok(await desk.page.evaluate(() => {
      const top = (id: string) => document.getElementById(id)?.getBoundingClientRect().top ?? 0;
      return top("help-touch") > top("help-keys");
    }));
    await finish(desk);
  });

  test("panels can be hidden and shown; help opens and closes", async () => {
    const visited = await open({ hash: "#f=200" });
    const { page } = visited;
    await page.keyboard.press("h");
    for (const id of ["head", "tools", "dock"]) assert.equal(await page.isVisible(`#${id}`), false);
    await saveScreenshot(page, "bare");
    await page.click("#show-panels");
    assert.ok(await page.isVisible("#dock"));
    await page.keyboard.press("?");
    assert.ok(await page.isVisible("#help"));
    await saveScreenshot(page, "help");
    await page.keyboard.press("Escape");
    assert.equal(await page.isVisible("#help"), false);
    await finish(visited);
  });

  test("on a phone all controls fit, a tap picks, one finger rotates, two fingers zoom", async () => {
    const visited = await open({ hash: "#f=20", context: phone });
    const { page } = visited;
    await waitForFrame(page, 20);
    for (const id of ["head", "tools", "dock", "play", "scrub", "speed", "link", "help-open"]) {
      const box = await page.locator(`#${id}`).boundingBox();
      assert.ok(box && box.x >= 0 && box.y >= 0 && box.x + box.width <= 375 && box.y + box.height <= 800, id);
    }
    await saveScreenshot(page, "phone");
    const { x, y } = await positionOf(page, "ball");
    await page.touchscreen.tap(x, y);
    await page.waitForSelector("#body:not([hidden])");
    assert.equal(await text(page, "#body-name"), "ball");
    await saveScreenshot(page, "phone-picked");
    await page.tap("#body-close");
    const before = await pixels(page);
    const session = await page.context().newCDPSession(page);
    const touch = (type: string, points: [number, number][]) =>
      session.send("Input.dispatchTouchEvent", {
        type: type as "touchStart",
        touchPoints: points.map(([px, py], id) => ({ x: px, y: py, id })),
      });
    await touch("touchStart", [[150, 250]]);
    for (let i = 1; i <= 6; ++i) await touch("touchMove", [[150 + 15 * i, 250]]);
    await touch("touchEnd", []);
    const rotated = await pixels(page);
    assert.ok(changed(before, rotated) > 0.02, "one finger rotates");
    await touch("touchStart", [
      [180, 260],
      [210, 260],
    ]);
    for (let i = 1; i <= 6; ++i)
      await touch("touchMove", [
        [180 - 12 * i, 260],
        [210 + 12 * i, 260],
      ]);
    await touch("touchEnd", []);
    assert.ok(changed(rotated, await pixels(page)) > 0.05, "two fingers zoom");
    await finish(visited);
  });

  test("the page explains broken, missing, foreign and newer files", async () => {
    const cases: [Uint8Array | null, RegExp][] = [
      [fixture.subarray(0, 100), /no HEAD|inside a chunk/],
      [new TextEncoder().encode('{"asset": {"version": "2.0"}}'), /not a Fase recording/],
      [fileHeader(9), /version 9; this viewer reads 1/],
      [new Uint8Array(0), /empty|404/],
      [join(fileHeader(), chunk("HEAD", new Uint8Array([200]))), /HEAD, byte/],
      [null, /404/],
    ];
    for (const [file, reason] of cases) {
      const { page, close } = await open({ file });
      assert.equal(await page.getAttribute("html", "data-state"), "error");
      assert.ok(await page.isVisible("#error"));
      assert.match(await text(page, "#error-text"), reason);
      if (file === null) {
        await saveScreenshot(page, "error");
        await page.setInputFiles("#open", {
          name: "wall.faserec",
          mimeType: "application/octet-stream",
          buffer: Buffer.from(fixture),
        });
        await page.waitForSelector("html[data-state=ready]");
        assert.ok(await page.isHidden("#error"));
      }
      await close();
    }
  });

  test("a truncated recording plays up to its end and shows a note", async () => {
    const visited = await open({ file: fixture.subarray(0, Math.floor(fixture.length * 0.7)) });
    assert.match(await text(visited.page, "#note"), /end of this recording is missing.*\d+ frames/);
    await visited.page.keyboard.press("End");
    await visited.page.waitForFunction(() => Number(document.documentElement.dataset.frame) > 60);
    await finish(visited);
  });

  test("without WebGL the page explains what is missing", async () => {
    const blind = await launch(["--disable-3d-apis"]);
    server.recording = fixture;
    const context = await blind.newContext();
    const page = await context.newPage();
    await page.goto(server.url);
    await page.waitForSelector("#error:not([hidden])");
    assert.match(await text(page, "#error-text"), /WebGL/);
    await blind.close();
  });

  test("a self-contained page plays from a file", async () => {
    const read = (name: string) => readFileSync(path.join(built.folder, name), "utf8");
    const recording = Buffer.from(fixture).toString("base64");
    const html = read("index.html")
      .replace('<link rel="stylesheet" href="viewer.css">', () => `<style>${read("viewer.css")}</style>`)
      .replace(
        '<script src="viewer.js"></script>',
        () =>
          `<script id="recording" type="application/octet-stream;base64">${recording}</script>` +
          `<script>${read("viewer.js")}</script>`,
      );
    assert.ok(
      !/(src|href)="(?!#|data:)/.test(html.replace(/<script>[^]*<\/script>/, "")),
      "the page loads nothing from elsewhere",
    );
    const folder = mkdtempSync(path.join(os.tmpdir(), "fase-viewer-page-"));
    const file = path.join(folder, "page.html");
    writeFileSync(file, html);
    const visited = await visit(browser, `file://${file}#f=90`);
    assert.equal(await visited.page.getAttribute("html", "data-state"), "ready");
    assert.equal(await frameOf(visited.page), 90);
    await finish(visited);
    rmSync(folder, { recursive: true });
  });

  test(
    "a recording of the program plays",
    { skip: real ? false : "skipped: FASE_RECORDING names no recording" },
    async () => {
      const file = new Uint8Array(readFileSync(real as string));
      const last = Recording.openNow(file).frameCount - 1;
      const visited = await open({ file, hash: "#f=0", context: { viewport: { width: 1280, height: 800 } } });
      const { page } = visited;
      await saveScreenshot(page, "real-first");
      for (const share of [0.25, 0.5, 1]) {
        const frame = Math.round(share * last);
        await page.evaluate((f) => (location.hash = `#f=${f}`), frame);
        await waitForFrame(page, frame);
        await saveScreenshot(page, `real-${100 * share}`);
      }
      await page.keyboard.press("Home");
      await page.keyboard.press(" ");
      await page.waitForFunction((minFrame) => Number(document.documentElement.dataset.frame) >= minFrame, Math.min(10, last), {
        timeout: 60_000,
      });
      await finish(visited);
    },
  );
});
