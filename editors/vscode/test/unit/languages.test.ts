import { expect, test } from "vitest";
import manifest from "../../package.json";
import { foreignLanguage, isServed, selector } from "../../src/languages";

const file = (fileName: string, languageId: string, scheme = "file"): Parameters<typeof isServed>[0] => ({
  uri: { scheme },
  fileName,
  languageId,
});

test("programs, lists and the configuration are served, and nothing else", () => {
  // R12.12, R12.13
  for (const served of [
    file("/parts/a.nc", "isg-cnc"),
    file("/parts/a.nc", "frictcomp-nc"),
    file("/lists/x.lis", "isg-list"),
    file("/parts/frictcomp.toml", "toml"),
    file("Untitled-1", "isg-cnc", "untitled"),
  ]) {
    expect(isServed(served, [])).toBe(true);
  }
  for (const other of [
    file("/parts/Cargo.toml", "toml"),
    file("/parts/a.nc", "gcode"),
    file("/parts/a.nc", "isg-cnc", "git"),
    file("/parts/a.nc", "isg-cnc", "vscode-vfs"),
  ]) {
    expect(isServed(other, [])).toBe(false);
  }
  expect(isServed(file("/parts/a.nc", "gcode"), ["gcode"])).toBe(true);
  expect(selector(["gcode"])).toContainEqual({ scheme: "untitled", language: "gcode" });
  expect(selector([]).every(({ scheme }) => ["file", "untitled"].includes(scheme))).toBe(true);
});

test("a program that another extension claims is asked about", () => {
  // R12.12
  expect(foreignLanguage(file("/parts/A.NC", "gcode"), [])).toBe("gcode");
  expect(foreignLanguage(file("/parts/A.NC", "gcode"), ["gcode"])).toBeUndefined();
  expect(foreignLanguage(file("/parts/a.nc", "isg-cnc"), [])).toBeUndefined();
  expect(foreignLanguage(file("/parts/a.gcode", "gcode"), [])).toBeUndefined();
  expect(foreignLanguage(file("/parts/a.nc", "gcode", "git"), [])).toBeUndefined();
});

test("languages and their endings are declared before anything runs", () => {
  // R12.12
  const [programs, lists] = manifest.contributes.languages;
  expect(programs?.extensions).toEqual([".nc", ".cnc", ".cyc", ".sub", ".plc"]);
  expect(lists?.extensions).toEqual([".lis"]);
});

test("what is offered is not taken for Enter", () => {
  // R12.11
  const defaults = manifest.contributes.configurationDefaults;
  for (const language of ["[frictcomp-nc]", "[frictcomp-list]"] as const) {
    expect(defaults[language]["editor.suggest.selectionMode"]).toBe("never");
    expect(defaults[language]["editor.wordBasedSuggestions"]).toBe("off");
  }
  // Suggestions of ISG's extension are selected as before, but not after a blank of ours.
  expect(defaults["[isg-cnc]"]["editor.suggest.selectionMode"]).toBe("whenQuickSuggestion");
  expect(defaults["[isg-cnc]"]["editor.wordBasedSuggestions"]).toBe("off");
});
