/** Which documents are programs: by the known languages, and those that the user names. */
import * as vscode from "vscode";
import { programLanguages } from "./languages";

/** The languages that the user names in `frictcomp.languages`. */
export function furtherLanguages(): string[] {
  return vscode.workspace.getConfiguration("frictcomp").get<string[]>("languages", []);
}

export function isProgram(document: vscode.TextDocument): boolean {
  return programLanguages(furtherLanguages()).includes(document.languageId);
}
