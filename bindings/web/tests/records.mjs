// The engine of the page gives the same records as the command line, byte by byte, over all programs.
//
//     node tests/records.mjs ENGINE.wasm COMMAND ROOT

import { spawnSync } from "node:child_process";
import { readFileSync, readdirSync, statSync } from "node:fs";
import { join } from "node:path";

const [wasm, command, root] = process.argv.slice(2);
const MAX_BLOCKS = 5000;
const PROGRAM = /\.(nc|cnc|mpf|spf|sub|cyc|iso|ngc|tap)$/i;

const { instance } = await WebAssembly.instantiate(readFileSync(wasm), {
  env: { progress: () => undefined, due: () => 0, told: () => undefined },
});
const engine = instance.exports;

function send(...pieces) {
  let at = engine.reserve(pieces.reduce((sum, piece) => sum + piece.length, 0));
  for (const piece of pieces) {
    new Uint8Array(engine.memory.buffer, at, piece.length).set(piece);
    at += piece.length;
  }
}

function ask(question) {
  send(new TextEncoder().encode(JSON.stringify(question)));
  const isAnswered = engine.ask() === 1;
  const bytes = new Uint8Array(engine.memory.buffer, engine.answer(), engine.answer_length());
  return { isAnswered, answer: Buffer.from(bytes.slice()) };
}

function below(folder) {
  return readdirSync(join(root, folder)).sort().flatMap((name) => {
    const path = `${folder}/${name}`;
    return statSync(join(root, path)).isDirectory() ? below(path) : [path];
  });
}

const files = below("programs");
for (const path of files) {
  const name = new TextEncoder().encode(path);
  send(name, readFileSync(join(root, path)));
  engine.put(name.length, 0);
}

let compared = 0;
for (const program of files.filter((path) => PROGRAM.test(path))) {
  const options = ["run", "--format", "ndjson", "--max-blocks", String(MAX_BLOCKS), program];
  const line = spawnSync(command, options, { cwd: root, maxBuffer: 1 << 28 });
  const { isAnswered, answer } = ask({
    ask: "records", program, settings: { maxBlocks: MAX_BLOCKS },
  });
  const same = isAnswered
    ? answer.equals(line.stdout)
    : line.stderr.toString().includes(JSON.parse(answer.toString()).message);
  if (!same) {
    console.error(`${program}: the records differ`);
    console.error(answer.toString().slice(0, 2000));
    console.error(line.stdout.toString().slice(0, 2000), line.stderr.toString().slice(0, 500));
    process.exit(1);
  }
  compared += 1;
}
if (compared < 150) {
  console.error(`only ${compared} programs were found`);
  process.exit(1);
}
console.log(`${compared} programs: the same records as the command line`);

const blocks = Array.from({ length: 1_000_000 }, (_, at) =>
  `N${at * 10} G1 X${at % 997} Y${at % 13}.5 F1000\n`);
blocks[500_000] = "N5 X[COMP OFF FRICT]\n";
const name = new TextEncoder().encode("million.nc");
send(name, new TextEncoder().encode(blocks.join("")));
engine.put(name.length, 1);
const before = performance.now();
const { isAnswered, answer } = ask({ ask: "run", program: "million.nc" });
const seconds = (performance.now() - before) / 1000;
if (!isAnswered || JSON.parse(answer.toString()).blocks !== 1_000_000) {
  console.error(answer.toString().slice(0, 500));
  process.exit(1);
}
console.log(`1 million blocks: ${seconds.toFixed(2)} s`);
