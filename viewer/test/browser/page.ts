/** Serves the built page with a recording, with the same security headers as `fase view`, and opens it in a browser. */
import { mkdirSync, mkdtempSync, existsSync, readFileSync, rmSync } from "node:fs";
import { createServer, type Server } from "node:http";
import { createRequire } from "node:module";
import type { AddressInfo } from "node:net";
import { spawnSync } from "node:child_process";
import os from "node:os";
import path from "node:path";
import type { Browser, BrowserContextOptions, Page } from "playwright-core";

const viewer = process.env.FASE_VIEWER ?? process.cwd();
const { chromium } = createRequire(path.join(viewer, "package.json"))(
  "playwright-core",
) as typeof import("playwright-core");

const types: Record<string, string> = {
  "/": "text/html; charset=utf-8",
  "/viewer.js": "text/javascript; charset=utf-8",
  "/viewer.css": "text/css; charset=utf-8",
  "/recording": "application/octet-stream",
};

/** Returns the path of the browser: $CHROMIUM, or a standard place; null: not found. */
export function findBrowser(): string | null {
  const places = [process.env.CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
  return places.find((place) => place && existsSync(place)) ?? null;
}

/** Builds the page into a temporary folder, or uses $FASE_VIEWER_PAGE, the build's output. */
export function buildPage(): { folder: string; remove: () => void } {
  const built = process.env.FASE_VIEWER_PAGE;
  if (built) return { folder: built, remove: () => {} };
  const folder = mkdtempSync(path.join(os.tmpdir(), "fase-viewer-page-"));
  const { status, stderr } = spawnSync(process.execPath, [path.join(viewer, "build.mjs"), "--out", folder], {
    encoding: "utf8",
  });
  if (status !== 0) throw new Error(`the page does not build: ${stderr}`);
  return { folder, remove: () => rmSync(folder, { recursive: true, force: true }) };
}

/** A server on 127.0.0.1. `recording` can change while it runs; null: responds with 404. */
export class PageServer {
  recording: Uint8Array | null = null;
  private constructor(private readonly server: Server) {}

  static start(folder: string): Promise<PageServer> {
    const files: Record<string, Uint8Array> = {
      "/": readFileSync(path.join(folder, "index.html")),
      "/viewer.js": readFileSync(path.join(folder, "viewer.js")),
      "/viewer.css": readFileSync(path.join(folder, "viewer.css")),
    };
    const server = createServer((request, response) => {
      const name = (request.url ?? "").split("?")[0];
      const body = name === "/recording" ? made.recording : files[name];
      if (!body) {
        response.writeHead(404, { "Content-Type": "text/plain" }).end("not found");
        return;
      }
      response.writeHead(200, {
        "Content-Type": types[name],
        "Content-Length": body.length,
        "Content-Security-Policy": "default-src 'self'; img-src 'self' data: blob:",
        "X-Content-Type-Options": "nosniff",
      });
      response.end(body);
    });
    const made = new PageServer(server);
    return new Promise((resolve) => server.listen(0, "127.0.0.1", () => resolve(made)));
  }
  get url(): string {
    return `http://127.0.0.1:${(this.server.address() as AddressInfo).port}/`;
  }
  stop(): void {
    this.server.closeAllConnections?.();
    this.server.close();
  }
}

export function launch(more: string[] = []): Promise<Browser> {
  return chromium.launch({
    executablePath: findBrowser() as string,
    headless: true,
    args: [
      "--no-sandbox",
      "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
      "--no-first-run",
      "--disable-quic",
      ...more,
    ],
  });
}

/** A page with its errors and warnings. */
export interface Visit {
  page: Page;
  problems: string[];
  close(): Promise<void>;
}

export async function visit(browser: Browser, url: string, options: BrowserContextOptions = {}): Promise<Visit> {
  const context = await browser.newContext({ viewport: { width: 800, height: 600 }, ...options });
  const page = await context.newPage();
  const problems: string[] = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type()) && !isDriverWarning(message.text()))
      problems.push(message.text());
  });
  page.on("response", (response) => {
    if (response.status() >= 400) problems.push(`${response.status()} ${response.url()}`);
  });
  page.on("pageerror", (error) => problems.push(error.message));
  await page.goto(url);
  await page.waitForSelector("html[data-state]", { timeout: 60_000 });
  return { page, problems, close: () => context.close() };
}

/** Whether a message is the browser's warning about slow software drawing. */
const isDriverWarning = (text: string): boolean => /GL Driver Message|GPU stall|swiftshader/i.test(text);

/** Saves a screenshot in $FASE_SCREENSHOTS, if set. */
export async function saveScreenshot(page: Page, name: string): Promise<void> {
  const folder = process.env.FASE_SCREENSHOTS;
  if (!folder) return;
  mkdirSync(folder, { recursive: true });
  await page.screenshot({ path: path.join(folder, `${name}.png`) });
}
