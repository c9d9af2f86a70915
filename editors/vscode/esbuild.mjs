// Bundles the extension, and the script of the timeline view, each into one file, and puts the pages of
// the codes beside them.
import { cpSync } from "node:fs";
import { build } from "esbuild";

const common = { bundle: true, minify: true, logLevel: "warning", legalComments: "none" };

await build({
  ...common,
  entryPoints: ["src/extension.ts"],
  outfile: "dist/extension.js",
  platform: "node",
  format: "cjs",
  target: "node20",
  external: ["vscode"],
});
await build({
  ...common,
  entryPoints: ["src/view/timeline.ts"],
  outfile: "dist/timeline.js",
  platform: "browser",
  format: "iife",
  target: "es2022",
});
cpSync("../../docs/codes", "dist/codes", { recursive: true });
