import { describe, expect, it } from "vitest";
import { TALLEST, firstLine, height, isSquashed, scrollOf } from "../page/window";

describe("a long list", () => {
  const short = { line: 20, total: 1000, seen: 400 };
  const long = { line: 20, total: 4_000_002, seen: 400 };

  it("has its own height, or what browsers bear", () => {
    expect(height(short)).toBe(20_000);
    expect(height(long)).toBe(TALLEST);
    expect([isSquashed(short), isSquashed(long)]).toEqual([false, true]);
  });

  it("can be scrolled to every line", () => {
    for (const line of [0, 1, 17, 1_999_999, 3_999_982]) {
      expect(firstLine(long, scrollOf(long, line))).toBe(line);
    }
    expect(firstLine(short, scrollOf(short, 500))).toBe(500);
  });

  it("ends with its last line", () => {
    const end = height(long) - long.seen;
    expect(firstLine(long, end) + long.seen / long.line).toBe(long.total);
  });
});
