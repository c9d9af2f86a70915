import { spawnSync } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { pathToFileURL } from "node:url";
import { expect, test } from "vitest";

const HERE = path.resolve(import.meta.dirname, "../..");
const PROGRAMS = path.resolve(HERE, "../../programs");
const TAPLO = path.join(HERE, "node_modules/.bin/taplo");
const PATIENCE = 120_000;

/** The files that do not fit a schema for Taplo, on which the TOML support of many editors is built. */
function refused(schema: string, files: readonly string[]): string[] {
  const url = pathToFileURL(path.join(HERE, "schemas", schema)).href;
  const { stderr } = spawnSync(TAPLO, ["lint", "--colors", "never", "--schema", url, ...files], {
    encoding: "utf8",
    shell: process.platform === "win32",
  });
  expect(stderr).toContain(`total=${files.length.toString()}`);
  return files.filter((file) => stderr.includes(`path=${JSON.stringify(file)}`));
}

/** The configurations among the programs. */
function configurations(): string[] {
  const names = fs.readdirSync(PROGRAMS, { recursive: true, encoding: "utf8" });
  const wrong = path.join("machines", "err");
  const isOne = (name: string): boolean =>
    path.basename(name) === "frictcomp.toml" || (path.dirname(name) === wrong && name.endsWith(".toml"));
  return names.filter(isOne).map((name) => path.join(PROGRAMS, name));
}

test("a TOML editor refuses the configurations with a wrong key and no other", { timeout: PATIENCE }, () => {
  // R17.6
  const files = configurations();
  const wrong = files.filter((file) => path.basename(file).startsWith("FC110"));
  expect(files.length - wrong.length).toBeGreaterThan(10);
  expect(wrong.length).toBeGreaterThan(0);
  expect(refused("frictcomp.json", files)).toEqual(wrong);
});

const RIGHT = {
  "frictcomp.json": ['[machine]\nprogram_dirs = ["cycles"]\n', '[[axis]]\nname = "X"\nfrict_comp = true\n'],
  "plant.json": ["m = 500\n[x]\nFs = 300\nFc = 200\n"],
};

const WRONG = {
  "frictcomp.json": [
    "[[axis]]\nname = 1\n",
    '[[axis]]\nname = "X"\nfrict_comp = "yes"\n',
    '[machine]\ncycle_time_ms = "2"\n',
    '[machine]\nprogram_dirs = "cycles"\n',
    "axis = 1\n",
    "program_dirs = []\n",
    "[[axis\n",
  ],
  "plant.json": ['m = "a"\n', "mass = 1\n", 'base = "soggy"\n'],
};

test.each(["frictcomp.json", "plant.json"] as const)("a TOML editor refuses wrong values by %s", { timeout: PATIENCE }, (schema) => {
  // R17.6
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "frictcomp-schema-"));
  const written = (text: string, at: number, kind: string): string => {
    const file = path.join(folder, `${kind}-${at.toString()}.toml`);
    fs.writeFileSync(file, text);
    return file;
  };
  try {
    const right = RIGHT[schema].map((text, at) => written(text, at, "right"));
    const wrong = WRONG[schema].map((text, at) => written(text, at, "wrong"));
    expect(refused(schema, [...right, ...wrong])).toEqual(wrong);
  } finally {
    fs.rmSync(folder, { recursive: true });
  }
});
