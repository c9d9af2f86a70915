import { expect, test } from "vitest";
import { findBinary, type Surroundings } from "../../src/binary";

function around(files: string[], change: Partial<Surroundings> = {}): Surroundings {
  return {
    setting: "",
    workspace: "/home/cnc/parts",
    extension: "/ext/frictcomp",
    platform: "linux",
    path: "/usr/local/bin::/usr/bin",
    exists: (file) => files.includes(file),
    ...change,
  };
}

test("the program beside the extension comes before the one on PATH", () => {
  const files = ["/usr/bin/frictcomp", "/ext/frictcomp/bin/frictcomp"];
  expect(findBinary(around(files))).toEqual({ kind: "found", file: "/ext/frictcomp/bin/frictcomp" });
  expect(findBinary(around(files.slice(0, 1)))).toEqual({ kind: "found", file: "/usr/bin/frictcomp" });
});

test("a setting is the only place that is looked at", () => {
  const files = ["/usr/bin/frictcomp", "/home/cnc/parts/tools/frictcomp"];
  expect(findBinary(around(files, { setting: " tools/frictcomp " }))).toEqual({
    kind: "found",
    file: "/home/cnc/parts/tools/frictcomp",
  });
  expect(findBinary(around(files, { setting: "/opt/frictcomp" }))).toEqual({
    kind: "missing",
    looked: ["/opt/frictcomp"],
  });
});

test("on Windows the program ends in .exe and PATH is split at semicolons", () => {
  const windows: Partial<Surroundings> = {
    platform: "win32",
    extension: "C:\\ext",
    path: "C:\\Windows;D:\\CNC Tools",
  };
  expect(findBinary(around(["D:\\CNC Tools\\frictcomp.exe"], windows))).toEqual({
    kind: "found",
    file: "D:\\CNC Tools\\frictcomp.exe",
  });
  expect(findBinary(around(["\\\\server\\cnc\\frictcomp.exe"], { ...windows, setting: "\\\\server\\cnc\\frictcomp.exe" })))
    .toEqual({ kind: "found", file: "\\\\server\\cnc\\frictcomp.exe" });
});

test("what was looked at is told where nothing is found", () => {
  expect(findBinary(around([]))).toEqual({
    kind: "missing",
    looked: ["/ext/frictcomp/bin/frictcomp", "/usr/local/bin/frictcomp", "/usr/bin/frictcomp"],
  });
});
