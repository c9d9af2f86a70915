// Bundles the extension, and the scripts of its views, each into one file, and puts the pages of the
// codes, the style of pictures and the licences of the contents next to them.
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
const views = await build({
  ...common,
  entryPoints: { timeline: "src/view/timeline.ts", contour: "src/contour/page.ts" },
  outdir: "dist",
  platform: "browser",
  format: "iife",
  target: "es2022",
});
cpSync("../../docs/codes", "dist/codes", { recursive: true });
// A webview indicates the theme by a class of its body, and not through `prefers-color-scheme`.
const report = (file) => readFileSync(`../../crates/report/src/${file}`, "utf8");
const dark = "body:is(.vscode-dark, .vscode-high-contrast:not(.vscode-high-contrast-light))";
const colours = report("colours.css").replace(
  /@media screen and \(prefers-color-scheme: dark\) \{\s*:root/,
  `@media screen {\n  ${dark}`,
);
writeFileSync("dist/picture.css", colours + report("bars.css") + report("svg/style.css"));

/** The folder of the npm package that a bundled file belongs to, if there is one. */
function packageOf(file) {
  return /^.*node_modules\/(?:@[^/]+\/)?[^/]+/.exec(file)?.[0];
}

const files = [extension, views].flatMap((bundle) => Object.keys(bundle.metafile.inputs));
const packages = [...new Set(files.map(packageOf).filter(Boolean))].sort();
const licences = packages.map((folder) => {
  const { name, version, license } = JSON.parse(readFileSync(`${folder}/package.json`, "utf8"));
  const file = readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
  if (!file) throw new Error(`${name} has no text of its licence`);
  return `${name} ${version}, ${license}\n\n${readFileSync(`${folder}/${file}`, "utf8").trim()}\n`;
});
writeFileSync("dist/THIRD-PARTY-LICENSES.txt", licences.join(`\n${"-".repeat(80)}\n\n`));
