/** Tests atlases of `fase atlas` in a browser: PixiJS draws each sprite equal to its image. */
import assert from "node:assert/strict";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer, type Server } from "node:http";
import type { AddressInfo } from "node:net";
import { spawnSync } from "node:child_process";
import os from "node:os";
import path from "node:path";
import { after, before, describe, test } from "node:test";
import type { Browser } from "playwright-core";
import { crc32, type Picture, pngOf } from "../png";
import { findBrowser, saveScreenshot, launch, visit } from "./page";

const program = process.env.FASE_PROGRAM;
const skip = !findBrowser()
  ? "skipped: no chromium on this system"
  : !program
    ? "skipped: FASE_PROGRAM does not name the command fase"
    : false;
const pixi = path.join(process.env.FASE_VIEWER ?? process.cwd(), "node_modules/pixi.js/dist/pixi.min.js");
const width = 400;
const height = 300;

/** Draws all sprites of the sheet in rows; window.drawn has their positions, window.pixels() returns the canvas. */
const script = `
const { Application, Assets, Rectangle, Sprite } = PIXI;
const sheet = new URLSearchParams(location.search).get("sheet");
(async () => {
  const app = new Application();
  await app.init({ width: ${width}, height: ${height}, backgroundAlpha: 0, antialias: false, resolution: 1,
                   preference: "webgl", preserveDrawingBuffer: true });
  document.body.appendChild(app.canvas);
  const loaded = await Assets.load(sheet);
  const textures = Object.assign({}, ...[loaded, ...loaded.linkedSheets].map((one) => one.textures));
  let x = 2, y = 2, row = 0;
  window.drawn = {};
  for (const name of Object.keys(textures).sort()) {
    const sprite = new Sprite(textures[name]);
    textures[name].source.scaleMode = "nearest";
    if (x + sprite.width + 2 > ${width}) { x = 2; y += row + 2; row = 0; }
    sprite.position.set(x, y);
    window.drawn[name] = { x, y, width: sprite.width, height: sprite.height, rotated: textures[name].rotate !== 0 };
    x += sprite.width + 2;
    row = Math.max(row, sprite.height);
    app.stage.addChild(sprite);
  }
  app.render();
  window.pixels = () => Array.from(app.renderer.extract.pixels({
    target: app.stage, frame: new Rectangle(0, 0, ${width}, ${height}), resolution: 1 }).pixels);
  document.documentElement.dataset.state = "drawn";
})().catch((error) => { console.error(String(error)); document.documentElement.dataset.state = "failed"; });
`;
const page = `<!doctype html><meta charset="utf-8"><title>atlas</title><link rel="icon" href="data:,">
<style>body { margin: 0; background: #456 }</style><body><script src="/pixi.js"></script><script src="/page.js"></script>`;

/** Returns an asymmetric image of many colours, opaque except for a border of `edge` transparent pixels. */
function noiseImage(w: number, h: number, seed: number, edge = 0): Picture {
  const pixels = new Uint8Array(4 * w * h);
  for (let y = edge; y < h - edge; ++y)
    for (let x = edge; x < w - edge; ++x) {
      const bits = crc32(Uint8Array.of(x, y, seed));
      pixels.set([bits & 255, (bits >> 8) & 255, (bits >> 16) & 255, 255], 4 * (y * w + x));
    }
  return { width: w, height: h, pixels };
}

describe("an atlas in PixiJS", { skip }, () => {
  const images: Record<string, Picture> = {};
  let folder: string;
  let server: Server;
  let browser: Browser;

  before(async () => {
    folder = mkdtempSync(path.join(os.tmpdir(), "fase-atlas-"));
    mkdirSync(path.join(folder, "sprites", "more"), { recursive: true });
    for (let i = 0; i < 24; ++i) {
      const name = `${i % 3 === 0 ? "more/" : ""}s${i}.png`;
      images[name] = noiseImage(5 + ((i * 7) % 41), 4 + ((i * 11) % 23), i, i % 4 === 1 ? 1 : 0);
      writeFileSync(path.join(folder, "sprites", name), pngOf(images[name]));
    }
    server = createServer((request, response) => {
      const name = new URL(request.url ?? "/", "http://127.0.0.1").pathname;
      const fixed: Record<string, [string, string | Buffer]> = {
        "/": ["text/html", page],
        "/page.js": ["text/javascript", script],
        "/pixi.js": ["text/javascript", readFileSync(pixi)],
      };
      try {
        const [type, body] = fixed[name] ?? [
          name.endsWith(".png") ? "image/png" : "application/json",
          readFileSync(path.join(folder, path.basename(name))),
        ];
        response.writeHead(200, { "Content-Type": type }).end(body);
      } catch {
        response.writeHead(404).end();
      }
    });
    await new Promise<void>((resolve) => server.listen(0, "127.0.0.1", resolve));
    browser = await launch();
  });
  after(async () => {
    await browser?.close();
    server?.closeAllConnections?.();
    server?.close();
    if (folder) rmSync(folder, { recursive: true, force: true });
  });

  for (const { what, options, first, pages } of [
    { what: "one page", options: ["--padding", "1"], first: "sheet.json", pages: 1 },
    { what: "trimmed, with repeated edges", options: ["--trim", "--extrude", "2"], first: "sheet.json", pages: 1 },
    { what: "powers of two, without rotation", options: ["--power-of-two", "--no-rotate"], first: "sheet.json", pages: 1 },
    { what: "several pages", options: ["--max", "64", "--trim"], first: "sheet-0.json", pages: 2 },
  ]) {
    test(`draws each sprite equal to its image: ${what}`, async () => {
      const made = spawnSync(
        program as string,
        ["atlas", path.join(folder, "sprites"), "-o", path.join(folder, "sheet"), "--tries", "40", "--json", ...options],
        { encoding: "utf8" },
      );
      assert.equal(made.status, 0, made.stderr);
      const figures = JSON.parse(made.stdout) as { count: number; pages: number };
      assert.equal(figures.count, Object.keys(images).length);
      assert.ok(figures.pages >= pages, `${figures.pages} pages`);
      const { port } = server.address() as AddressInfo;
      const opened = await visit(browser, `http://127.0.0.1:${port}/?sheet=/${first}`);
      try {
        assert.deepEqual(opened.problems, []);
        type Drawn = Record<string, { x: number; y: number; width: number; height: number; rotated: boolean }>;
        const { drawn, shown } = await opened.page.evaluate(() => {
          const own = window as unknown as { drawn: Drawn; pixels(): number[] };
          return { drawn: own.drawn, shown: own.pixels() };
        });
        await saveScreenshot(opened.page, `atlas ${what}`);
        assert.deepEqual(Object.keys(drawn).sort(), Object.keys(images).sort());
        const rotated = Object.values(drawn).filter((one) => one.rotated).length;
        if (options.includes("--no-rotate")) assert.equal(rotated, 0);
        else assert.ok(rotated > 0, "found no rotated sprite; rotation is not tested");
        for (const [name, image] of Object.entries(images)) {
          const at = drawn[name];
          assert.deepEqual([at.width, at.height], [image.width, image.height], name);
          for (let y = 0; y < image.height; ++y) {
            const start = 4 * ((at.y + y) * width + at.x);
            const row = shown.slice(start, start + 4 * image.width);
            const expected = Array.from(image.pixels.subarray(4 * y * image.width, 4 * (y + 1) * image.width));
            assert.deepEqual(row, expected, `${name}, row ${y}`);
          }
        }
      } finally {
        await opened.close();
      }
    });
  }
});
