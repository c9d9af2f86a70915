// Programs that were changed here: which changes are not saved, and how the programs are written to a file.

import type { Fix } from "./answers";

/** The original texts of changed programs, and the changes that are not in a file yet. */
export class Edits {
  private readonly originals = new Map<string, Uint8Array>();
  private readonly unsaved = new Set<string>();

  /** A file arrived: earlier changes are gone. */
  arrived(path: string): void {
    this.originals.delete(path);
    this.unsaved.delete(path);
  }

  forgetAll(): void {
    this.originals.clear();
    this.unsaved.clear();
  }

  /** The bytes of a changed program, written like the dropped file. */
  change(path: string, before: Uint8Array, text: string): Uint8Array<ArrayBuffer> {
    const original = this.originals.get(path) ?? before;
    const bytes = encoded(text, original);
    if (isSame(bytes, original)) {
      this.arrived(path);
    } else {
      this.originals.set(path, original);
      this.unsaved.add(path);
    }
    return bytes;
  }

  saved(path: string): void {
    this.unsaved.delete(path);
  }

  /** Returns whether a program differs here from its file. */
  isEdited(path: string | null): boolean {
    return path !== null && this.originals.has(path);
  }

  /** Whether unsaved changes would be lost with the page. */
  get isUnsaved(): boolean {
    return this.unsaved.size > 0;
  }
}

function isSame(one: Uint8Array, other: Uint8Array): boolean {
  return one.length === other.length && one.every((byte, at) => byte === other[at]);
}

const MARK = [0xef, 0xbb, 0xbf];

/** The letters of code page 1252 from 128 to 159; those after them are as in Unicode. */
const LETTERS = Array.from(
  "\u20ac\u0081\u201a\u0192\u201e\u2026\u2020\u2021\u02c6\u2030\u0160\u2039\u0152\u008d\u017d\u008f"
  + "\u0090\u2018\u2019\u201c\u201d\u2022\u2013\u2014\u02dc\u2122\u0161\u203a\u0153\u009d\u017e\u0178",
);

/** The byte of a letter in code page 1252. */
function byteOf(letter: string): number | undefined {
  const code = letter.codePointAt(0) ?? 0;
  if (code < 128 || (code >= 160 && code < 256)) {
    return code;
  }
  const at = LETTERS.indexOf(letter);
  return at < 0 ? undefined : at + 128;
}

/** A text in the code page and with the line ends of a file; in UTF-8 where that code page lacks a letter. */
export function encoded(text: string, file: Uint8Array): Uint8Array<ArrayBuffer> {
  const lines = file.includes(13) ? text.replace(/\r?\n/g, "\r\n") : text;
  const utf8 = new TextEncoder().encode(lines);
  if (isUtf8(file)) {
    const hasMark = MARK.every((byte, at) => file[at] === byte);
    return hasMark ? Uint8Array.of(...MARK, ...utf8) : utf8;
  }
  const bytes = Array.from(lines, byteOf);
  return bytes.every((byte) => byte !== undefined) ? Uint8Array.from(bytes) : utf8;
}

function isUtf8(file: Uint8Array): boolean {
  try {
    new TextDecoder("utf-8", { fatal: true }).decode(file);
    return true;
  } catch {
    return false;
  }
}

/** A text with a fix applied. Columns count letters from 1. */
export function fixed(original: string, fix: Fix): string {
  const text = fix.also === undefined ? original : fixed(original, fix.also);
  const lines = text.split("\n");
  const offset = (line: number, column: number): number => {
    const above = lines.slice(0, line - 1).reduce((sum, one) => sum + one.length + 1, 0);
    const before = Array.from(lines[line - 1] ?? "").slice(0, column - 1).join("");
    return Math.min(text.length, above + before.length);
  };
  return text.slice(0, offset(fix.line, fix.column)) + fix.text + text.slice(offset(fix.end_line, fix.end_column));
}

/** The line from 1 that a user looks for: by its number, or the next one after `from` that contains the words. */
export function sought(text: string, words: string, from: number): number | null {
  const wanted = words.trim().toLowerCase();
  const lines = text.split("\n");
  if (/^\d+$/.test(wanted)) {
    const line = Number(wanted);
    return line >= 1 && line <= lines.length ? line : null;
  }
  if (wanted === "") {
    return null;
  }
  const order = lines.map((_, at) => (from + at) % lines.length);
  const at = order.find((index) => lines[index]?.toLowerCase().includes(wanted));
  return at === undefined ? null : at + 1;
}
