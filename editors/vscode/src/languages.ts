/**
 * The languages of programs and lists. ISG's extension declares `isg-cnc` and `isg-list`, and its
 * declaration comes after ours; if it is absent, ours apply.
 */
import * as path from "node:path";

const PROGRAM_LANGUAGES = ["isg-cnc", "frictcomp-nc"];
const LIST_LANGUAGES = ["isg-list", "frictcomp-list"];
const PROGRAM_ENDINGS = [".nc", ".cnc", ".cyc", ".sub", ".plc"];
const CONFIGURATION = "frictcomp.toml";
/** Texts of a user: files and unsaved texts. Versions from git would report every problem twice. */
const SCHEMES = ["file", "untitled"];

export interface Named {
  uri: { scheme: string };
  fileName: string;
  languageId: string;
}

/** The languages of programs; `further` are those that the user names. */
export function programLanguages(further: readonly string[]): string[] {
  return [...new Set([...PROGRAM_LANGUAGES, ...further])];
}

/** The documents that the language server is told about: programs, lists and the configuration. */
export function selector(further: readonly string[]): { scheme: string; language?: string; pattern?: string }[] {
  const languages = [...programLanguages(further), ...LIST_LANGUAGES];
  return [
    ...SCHEMES.flatMap((scheme) => languages.map((language) => ({ scheme, language }))),
    { scheme: "file", pattern: `**/${CONFIGURATION}` },
    { scheme: "file", pattern: `**/*.{${PROJECTS.join(",")}}` },
  ];
}

/** The endings of TwinCAT projects and their parts, which hold lists. */
const PROJECTS = ["tsproj", "xti"];

/** Returns whether the language server is informed about a document. */
export function isServed(document: Named, further: readonly string[]): boolean {
  return (
    SCHEMES.includes(document.uri.scheme) &&
    ([...programLanguages(further), ...LIST_LANGUAGES].includes(document.languageId) ||
      path.basename(document.fileName) === CONFIGURATION ||
      PROJECTS.includes(path.extname(document.fileName).slice(1).toLowerCase()))
  );
}

/** The language of a program whose file ending another extension claims, and that is then not checked. */
export function foreignLanguage(document: Named, further: readonly string[]): string | undefined {
  const isProgram = PROGRAM_ENDINGS.includes(path.extname(document.fileName).toLowerCase());
  const isFile = document.uri.scheme === "file";
  return isFile && isProgram && !isServed(document, further) ? document.languageId : undefined;
}
