import { describe, expect, it } from "vitest";
import { isTaken, picked, tidy } from "../page/intake";

describe("files on their way in", () => {
  it("have paths without a way out", () => {
    expect(tidy("/a/./b/../c.nc")).toBe("a/b/c.nc");
    expect(tidy("C:\\CNC\\part.nc")).toBe("C:/CNC/part.nc");
    expect(tidy("../../../etc/passwd")).toBe("etc/passwd");
    expect(tidy("<img src=x onerror=alert(1)>.nc")).toBe("<img src=x onerror=alert(1)>.nc");
  });

  it("are left out where they are hidden or too large", () => {
    expect(isTaken("a/part.nc", 50_000_000)).toBe(true);
    expect(isTaken("a/drawing.pdf", 50_000_000)).toBe(false);
    expect(isTaken("a/O1000", 1000)).toBe(true);
    expect(isTaken(".git/config", 10)).toBe(false);
    expect(isTaken("a/.hidden.nc", 10)).toBe(false);
  });

  it("are named where they were picked by themselves", () => {
    const file = new File(["M30"], "part.txt");
    const { incoming, leftOut } = picked([file]);
    expect(incoming).toEqual([{ path: "part.txt", file, named: true }]);
    expect(leftOut).toBe(0);
  });
});
