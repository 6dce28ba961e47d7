/** Bundles and runs the tests of one kind. Usage: node test/run.mjs unit|browser [options of node --test] */
import { mkdtemp, rm } from "node:fs/promises";
import { spawnSync } from "node:child_process";
import { fileURLToPath } from "node:url";
import os from "node:os";
import path from "node:path";
import { readdirSync } from "node:fs";
import { build } from "esbuild";

const here = path.dirname(fileURLToPath(import.meta.url));
const kind = process.argv[2];
if (kind !== "unit" && kind !== "browser") {
  console.error("usage: node test/run.mjs unit|browser");
  process.exit(2);
}
const out = await mkdtemp(path.join(os.tmpdir(), "fase-viewer-test-"));
const names = readdirSync(path.join(here, kind)).filter((name) => name.endsWith(".test.ts"));
let status = 1;
try {
  await build({
    entryPoints: names.map((name) => path.join(here, kind, name)),
    outdir: out,
    outExtension: { ".js": ".mjs" },
    bundle: true,
    platform: "node",
    format: "esm",
    target: "node18",
    sourcemap: "inline",
    logLevel: "warning",
  });
  const files = names.map((name) => path.join(out, name.replace(/\.ts$/, ".mjs")));
  const environment = { ...process.env, FASE_VIEWER: path.dirname(here) };
  status =
    spawnSync(
      process.execPath,
      ["--enable-source-maps", "--test", "--test-reporter=spec", ...process.argv.slice(3), ...files],
      {
        stdio: "inherit",
        env: environment,
      },
    ).status ?? 1;
} finally {
  await rm(out, { recursive: true, force: true });
}
process.exitCode = status;
