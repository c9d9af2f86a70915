/** Check that a program that was found is frictcomp, and new enough for this extension. */
import { execFile } from "node:child_process";
import { promisify } from "node:util";
import type { Found } from "./binary";

const run = promisify(execFile);

/** Time limit for the program to print its version, in ms. */
const PATIENCE = 10_000;

export type Usable = { kind: "usable"; file: string } | { kind: "unusable"; why: string };

/** The program if it can be used, otherwise the reason in a sentence for the user. */
export async function usable(found: Found, wanted: string): Promise<Usable> {
  if (found.kind === "missing") {
    const [only, ...others] = found.looked;
    const where = only !== undefined && others.length === 0 ? `at ${only}` : "in this extension or on PATH";
    return { kind: "unusable", why: `The program frictcomp was not found ${where}.` };
  }
  const { file } = found;
  let told: string;
  try {
    told = (await run(file, ["--version"], { timeout: PATIENCE })).stdout;
  } catch {
    return { kind: "unusable", why: `${file} does not run as the program frictcomp.` };
  }
  const version = /^frictcomp (\d+\.\d+\.\d+)/.exec(told)?.[1];
  if (version === undefined) {
    return { kind: "unusable", why: `${file} is not the program frictcomp.` };
  }
  if (isOlder(version, wanted)) {
    const why = `${file} has version ${version}; this extension needs frictcomp ${wanted} or newer.`;
    return { kind: "unusable", why };
  }
  return { kind: "usable", file };
}

/** Returns whether a version comes before another one. */
export function isOlder(version: string, wanted: string): boolean {
  const parts = (text: string): number[] => text.split(".").map((part) => parseInt(part, 10));
  const [found, needed] = [parts(version), parts(wanted)];
  const at = needed.findIndex((part, index) => part !== found[index]);
  return at >= 0 && (found[at] ?? 0) < (needed[at] ?? 0);
}
