import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import oniguruma from "vscode-oniguruma";
import textmate from "vscode-textmate";
import { expect, test } from "vitest";

const wasm = readFileSync(createRequire(import.meta.url).resolve("vscode-oniguruma/release/onig.wasm"));
await oniguruma.loadWASM(wasm);
const registry = new textmate.Registry({
  onigLib: Promise.resolve({
    createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
    createOnigString: (text) => new oniguruma.OnigString(text),
  }),
  loadGrammar: (scope) => {
    const name = scope === "source.frictcomp-nc" ? "nc" : "list";
    const file = `syntaxes/${name}.tmLanguage.json`;
    return Promise.resolve(textmate.parseRawGrammar(readFileSync(file, "utf8"), file));
  },
});

/** The words of a text, each with the first part of what it is. */
async function scopes(text: string, scope = "source.frictcomp-nc"): Promise<string[]> {
  const grammar = await registry.loadGrammar(scope);
  if (!grammar) throw new Error(`there is no grammar ${scope}`);
  const words: string[] = [];
  let stack = textmate.INITIAL;
  for (const line of text.split("\n")) {
    const { tokens, ruleStack } = grammar.tokenizeLine(line, stack);
    stack = ruleStack;
    for (const { startIndex, endIndex, scopes: found } of tokens) {
      const word = line.slice(startIndex, endIndex).trim();
      const last = found.at(-1) ?? "";
      if (word !== "" && last !== scope) {
        words.push(`${word} ${last.split(".").slice(0, 2).join(".")}`);
      }
    }
  }
  return words;
}

test("words need no blanks between them", async () => {
  // R12.12
  expect(await scopes("N10G1X100F200")).toEqual([
    "N10 entity.name",
    "G1 support.function",
    "X variable.other",
    "100 constant.numeric",
    "F variable.other",
    "200 constant.numeric",
  ]);
  expect(await scopes("g01x-1.5y=p1")).toEqual([
    "g01 support.function",
    "x variable.other",
    "- keyword.operator",
    "1.5 constant.numeric",
    "y variable.other",
    "= keyword.operator",
    "p1 variable.parameter",
  ]);
});

test("comments lie in each other and end with their line", async () => {
  // R12.12
  const words = await scopes("N10 (a (b) c) X1 ; (d\nN20 (open\nG1");
  expect(words.filter((word) => word.startsWith("X"))).toEqual(["X variable.other"]);
  expect(words.filter((word) => !word.includes("comment"))).toEqual([
    "N10 entity.name",
    "X variable.other",
    "1 constant.numeric",
    "N20 entity.name",
    "G1 support.function",
  ]);
});

test("commands, variables and brackets are told apart", async () => {
  // R12.12
  expect(await scopes("X[COMP OFF FRICT]")).toEqual([
    "X variable.other",
    "[ punctuation.section",
    "COMP keyword.control",
    "OFF keyword.control",
    "FRICT constant.language",
    "] punctuation.section",
  ]);
  expect(await scopes("$IF V.A.ABS.X > @P1")).toEqual([
    "$IF keyword.control",
    "V.A.ABS.X variable.parameter",
    "> keyword.operator",
    "@P1 variable.parameter",
  ]);
  expect(await scopes("frict_comp.mode 3 (on (now))", "source.frictcomp-list")).toContain("3 constant.numeric");
});
