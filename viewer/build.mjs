/** Builds the page: writes index.html, viewer.js and viewer.css. Usage: npm run build -- --out DIR */
import { copyFile, mkdir } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import path from "node:path";
import { parseArgs } from "node:util";
import { build } from "esbuild";

const here = path.dirname(fileURLToPath(import.meta.url));
const { values } = parseArgs({ options: { out: { type: "string", default: path.join(here, "dist") } } });

await mkdir(values.out, { recursive: true });
await build({
  absWorkingDir: here,
  entryPoints: { viewer: "src/main.ts" },
  outdir: path.resolve(values.out),
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  charset: "utf8",
  legalComments: "inline",
  logLevel: "warning",
});
for (const name of ["index.html", "viewer.css"])
  await copyFile(path.join(here, "src", name), path.join(values.out, name));
