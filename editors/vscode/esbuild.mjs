// Bundles the extension, and the script of the timeline view, each into one file, and puts the pages of
// the codes and the licences of what is inside beside them.
import { cpSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { build } from "esbuild";

const common = { bundle: true, minify: true, metafile: true, logLevel: "warning", legalComments: "none" };

const extension = await build({
  ...common,
  entryPoints: ["src/extension.ts"],
  outfile: "dist/extension.js",
  platform: "node",
  format: "cjs",
  target: "node20",
  external: ["vscode"],
});
const view = await build({
  ...common,
  entryPoints: ["src/view/timeline.ts"],
  outfile: "dist/timeline.js",
  platform: "browser",
  format: "iife",
  target: "es2022",
});
cpSync("../../docs/codes", "dist/codes", { recursive: true });

/** The folder of the npm package that a bundled file belongs to, if it is of one. */
function packageOf(file) {
  return /^.*node_modules\/(?:@[^/]+\/)?[^/]+/.exec(file)?.[0];
}

const files = [extension, view].flatMap((bundle) => Object.keys(bundle.metafile.inputs));
const packages = [...new Set(files.map(packageOf).filter(Boolean))].sort();
const licences = packages.map((folder) => {
  const { name, version, license } = JSON.parse(readFileSync(`${folder}/package.json`, "utf8"));
  const file = readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
  if (!file) throw new Error(`${name} has no text of its licence`);
  return `${name} ${version}, ${license}\n\n${readFileSync(`${folder}/${file}`, "utf8").trim()}\n`;
});
writeFileSync("dist/THIRD-PARTY-LICENSES.txt", licences.join(`\n${"-".repeat(80)}\n\n`));
