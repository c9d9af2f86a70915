import { chmodSync, mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import * as path from "node:path";
import { expect, test } from "vitest";
import { isOlder, usable } from "../../src/version";

/** A program that prints a text and ends with a status. */
function program(text: string, status = 0): { kind: "found"; file: string } {
  const file = path.join(mkdtempSync(path.join(tmpdir(), "frictcomp-")), "frictcomp");
  writeFileSync(file, `#!/bin/sh\necho '${text}'\nexit ${String(status)}\n`);
  chmodSync(file, 0o755);
  return { kind: "found", file };
}

test("versions are compared number by number", () => {
  // R12.13
  expect(isOlder("0.9.0", "0.10.0")).toBe(true);
  expect(isOlder("0.10.0", "0.9.0")).toBe(false);
  expect(isOlder("1.0.0", "1.0.0")).toBe(false);
  expect(isOlder("1.2.9", "2.0.0")).toBe(true);
  expect(isOlder("2.0.0", "1.9.9")).toBe(false);
});

test("a program that is missing, older or something else is not started", async () => {
  // R12.13
  const now = program("frictcomp 0.3.0");
  expect(await usable(now, "0.3.0")).toEqual({ kind: "usable", file: now.file });
  const why = async (found: Parameters<typeof usable>[0]): Promise<string> => {
    const answer = await usable(found, "0.3.0");
    return answer.kind === "unusable" ? answer.why : "";
  };
  expect(await why(program("frictcomp 0.2.9"))).toContain("has version 0.2.9; this extension needs frictcomp 0.3.0");
  expect(await why(program("gcc 13.2.0"))).toContain("is not the program frictcomp");
  expect(await why(program("", 1))).toContain("does not run");
  expect(await why({ kind: "missing", looked: ["/opt/frictcomp"] })).toContain("not found at /opt/frictcomp");
  expect(await why({ kind: "missing", looked: ["/a", "/b"] })).toContain("on PATH");
});
