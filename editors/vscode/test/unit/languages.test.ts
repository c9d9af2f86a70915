import { expect, test } from "vitest";
import { ownLanguage } from "../../src/languages";

const plain = (fileName: string): { fileName: string; languageId: string } => ({ fileName, languageId: "plaintext" });

test("without ISG's extension, programs and lists get a language by their ending", () => {
  for (const name of ["a.nc", "A.NC", "x.cnc", "l.cyc", "l.ecy", "u.sub", "p.plc"]) {
    expect(ownLanguage(plain(`/parts/${name}`), ["plaintext"])).toBe("frictcomp-nc");
  }
  expect(ownLanguage(plain("C:\\lists\\hochlauf.lis"), [])).toBe("frictcomp-list");
  expect(ownLanguage(plain("/parts/readme.txt"), [])).toBeUndefined();
});

test("beside ISG's extension nothing is set", () => {
  const declared = ["plaintext", "isg-cnc", "isg-list"];
  expect(ownLanguage(plain("/parts/a.nc"), declared)).toBeUndefined();
  expect(ownLanguage(plain("/parts/a.lis"), declared)).toBeUndefined();
});

test("a language that somebody chose stays", () => {
  expect(ownLanguage({ fileName: "/parts/a.nc", languageId: "gcode" }, [])).toBeUndefined();
});
