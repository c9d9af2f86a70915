import { describe, expect, it } from "vitest";
import { feeds, positionsOf } from "../page/simulations";

describe("what is written into a form", () => {
  it("says where axes stand", () => {
    expect(positionsOf("x0, Y-12.5 ; Z1=30")).toEqual([["X", 0], ["Y", -12.5], ["Z1", 30]]);
    expect(positionsOf("")).toEqual([]);
    // R13.18: the field says it.
    expect(positionsOf("X, 5, Yfast")).toBeNull();
  });

  it("gives feeds, or none where a word is no feed", () => {
    expect(feeds("500, 1000;2000 5000")).toEqual([500, 1000, 2000, 5000]);
    for (const wrong of ["", "fast", "500, x", "0", "-1", "1 2 3 4 5 6 7 8 9"]) {
      expect(feeds(wrong)).toEqual([]);
    }
  });
});
