/** The place of the `frictcomp` program: in the setting, in the extension, or on `PATH`. */
import * as path from "node:path";

export interface Surroundings {
  /** The setting `frictcomp.path`; empty where it is not set. */
  setting: string;
  /** The folder of the workspace, against which a relative setting is resolved. */
  workspace: string | undefined;
  /** The folder of the extension. */
  extension: string;
  platform: NodeJS.Platform;
  /** The variable `PATH`. */
  path: string;
  /** Returns whether a path names a file that can be run. */
  exists(file: string): boolean;
}

export type Found = { kind: "found"; file: string } | { kind: "missing"; looked: string[] };

/**
 * The first program of the setting, the `bin` folder of the extension, and the folders of `PATH`. A
 * setting that names no file is not skipped: a program other than the requested one would answer.
 */
export function findBinary(around: Surroundings): Found {
  const paths = around.platform === "win32" ? path.win32 : path.posix;
  const name = around.platform === "win32" ? "frictcomp.exe" : "frictcomp";
  const setting = around.setting.trim();
  const candidates =
    setting === ""
      ? [
          paths.join(around.extension, "bin", name),
          ...around.path
            .split(paths.delimiter)
            .filter((folder) => folder !== "")
            .map((folder) => paths.join(folder, name)),
        ]
      : [paths.isAbsolute(setting) ? setting : paths.join(around.workspace ?? "", setting)];
  const file = candidates.find((candidate) => around.exists(candidate));
  return file === undefined ? { kind: "missing", looked: candidates } : { kind: "found", file };
}
