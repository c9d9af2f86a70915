/**
 * The languages of programs and lists. ISG's extension declares `isg-cnc` and `isg-list`; where it is
 * installed, its languages are used and nothing of our own is set.
 */
import * as path from "node:path";

export const PROGRAM_LANGUAGES = ["isg-cnc", "frictcomp-nc"];
export const LIST_LANGUAGES = ["isg-list", "frictcomp-list"];

const PROGRAM_ENDINGS = [".nc", ".cnc", ".cyc", ".ecy", ".sub", ".plc"];
const LIST_ENDINGS = [".lis"];

/** What the language server is told of: programs, lists and the configuration. */
export const SELECTOR = [
  ...[...PROGRAM_LANGUAGES, ...LIST_LANGUAGES].map((language) => ({ language })),
  { pattern: "**/frictcomp.toml" },
];

/**
 * Our own language for a document to which no other extension gave one; `undefined` where it has a
 * language already, or where ISG's languages are declared.
 */
export function ownLanguage(
  document: { fileName: string; languageId: string },
  declared: readonly string[],
): string | undefined {
  if (document.languageId !== "plaintext") {
    return undefined;
  }
  const ending = path.extname(document.fileName).toLowerCase();
  if (PROGRAM_ENDINGS.includes(ending) && !declared.includes("isg-cnc")) {
    return "frictcomp-nc";
  }
  if (LIST_ENDINGS.includes(ending) && !declared.includes("isg-list")) {
    return "frictcomp-list";
  }
  return undefined;
}
