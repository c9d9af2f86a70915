import { describe, expect, it } from "vitest";
import { Edits, encoded, fixed, sought } from "../page/edits";

const utf8 = (text: string): Uint8Array<ArrayBuffer> => new TextEncoder().encode(text);
const bytes = (...all: number[]): Uint8Array => Uint8Array.from(all);

// R13.12
describe("a changed program", () => {
  it("is written as its file is", () => {
    expect(encoded("a\nü", utf8("x\ny"))).toEqual(utf8("a\nü"));
    expect(encoded("a\nü", utf8("x\r\ny"))).toEqual(utf8("a\r\nü"));
    expect([...encoded("(Ü€)\n", bytes(40, 0xdc, 41, 13, 10))]).toEqual([40, 0xdc, 0x80, 41, 13, 10]);
    expect([...encoded("a", bytes(0xef, 0xbb, 0xbf, 65))]).toEqual([0xef, 0xbb, 0xbf, 97]);
    expect(encoded("Ω", bytes(0xdc))).toEqual(utf8("Ω"));
  });

  it("is marked by itself, until it is what it was", () => {
    const edits = new Edits();
    const original = utf8("M30\n");
    const changed = edits.change("a.nc", original, "X1\nM30\n");
    expect(edits.isEdited("a.nc") && !edits.isEdited("b.nc") && edits.isUnsaved).toBe(true);
    edits.saved("a.nc");
    expect(edits.isEdited("a.nc") && !edits.isUnsaved).toBe(true);
    edits.change("a.nc", changed, "M30\n");
    expect(edits.isEdited("a.nc") || edits.isUnsaved).toBe(false);
    edits.change("a.nc", original, "M2\n");
    edits.arrived("a.nc");
    expect(edits.isEdited("a.nc") || edits.isUnsaved).toBe(false);
  });

  it("takes a fix at its place", () => {
    const fix = (line: number, column: number, end_line: number, end_column: number, text: string) =>
      ({ file: "a.nc", line, column, end_line, end_column, text, safety: "unsafe" });
    expect(fixed("N10 X1\nM30\n", fix(2, 1, 2, 1, "X[COMP ON FRICT]\n"))).toBe("N10 X1\nX[COMP ON FRICT]\nM30\n");
    expect(fixed("(😀) X[COMP ON FRIKT]", fix(1, 15, 1, 20, "FRICT"))).toBe("(😀) X[COMP ON FRICT]");
    expect(fixed("M30", fix(2, 1, 2, 1, "X1"))).toBe("M30X1");
    // R12.20
    const both = { ...fix(1, 1, 1, 1, "A\n"), also: fix(2, 1, 2, 1, "B\n") };
    expect(fixed("N10 X1\nM30\n", both)).toBe("A\nN10 X1\nB\nM30\n");
  });
});

describe("a search", () => {
  it("finds lines by their number or their words, and goes round", () => {
    const text = "N10 X1\nN20 COMP\nN30\nn40 comp\n";
    expect(sought(text, "3", 0)).toBe(3);
    expect(sought(text, "99", 0)).toBeNull();
    expect(sought(text, "comp", 0)).toBe(2);
    expect(sought(text, "comp", 2)).toBe(4);
    expect(sought(text, "comp", 4)).toBe(2);
    expect(sought(text, "nothing", 0)).toBeNull();
    expect(sought(text, " ", 0)).toBeNull();
  });
});
