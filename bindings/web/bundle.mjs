// Makes the page: one file with style, script and engine in it.
//
//     node bundle.mjs ENGINE.wasm PAGE.html

import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";

/** The page has to fit on any USB stick and into any e-mail. */
const MOST_BYTES = 3 * 1024 * 1024;

const here = dirname(fileURLToPath(import.meta.url));
const [wasm, out] = process.argv.slice(2);

async function script(name, define = {}) {
  const bundled = await build({
    entryPoints: [join(here, "page", name)],
    bundle: true,
    write: false,
    minify: true,
    charset: "utf8",
    format: "esm",
    target: "es2022",
    loader: { ".nc": "text", ".lis": "text", ".toml": "text" },
    define,
  });
  // A closing tag in a text of a script would end the script.
  return bundled.outputFiles[0].text.trim().replaceAll("</", "<\\/").replaceAll("<!--", "<\\!--");
}

const { version } = JSON.parse(readFileSync(join(here, "package.json"), "utf8"));
const worker = await script("worker.ts");
const page = await script("page.ts", {
  WORKER: JSON.stringify(worker),
  VERSION: JSON.stringify(version),
});
const style = [...["colours", "states", "bars"].map((name) => `../../crates/report/src/${name}.css`), "page/style.css"]
  .map((file) => readFileSync(join(here, file), "utf8"))
  .join("");
const hash = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;
const policy = [
  "default-src 'none'",
  `script-src ${hash(page)} 'wasm-unsafe-eval'`,
  "worker-src blob:",
  `style-src ${hash(style)}`,
  "img-src blob:",
  "connect-src 'none'",
  "base-uri 'none'",
  "form-action 'none'",
].join("; ");
const parts = {
  POLICY: policy,
  STYLE: style,
  ENGINE: gzipSync(readFileSync(wasm), { level: 9 }).toString("base64"),
  SCRIPT: page,
};
const html = readFileSync(join(here, "page", "page.html"), "utf8")
  .replace(/(?<=[">])(POLICY|STYLE|ENGINE|SCRIPT)(?=["<])/g, (name) => parts[name]);
mkdirSync(dirname(out), { recursive: true });
writeFileSync(out, html);
const bytes = Buffer.byteLength(html);
console.log(`${out}: ${(bytes / 1e6).toFixed(2)} MB`);
if (bytes > MOST_BYTES) {
  console.error(`the page has more than ${MOST_BYTES} bytes`);
  process.exit(1);
}
