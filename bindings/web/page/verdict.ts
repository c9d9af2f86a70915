// The verdict of a run, and what it rests on. Nothing is called fine that was not checked.

import type { Overview } from "./answers";
import { counted, grouped } from "./dom";
import type { Report } from "./report";

export type Weight = "error" | "warning" | "info" | "good";

export interface Sentence {
  weight: Weight;
  text: string;
}

/** Basis of a run in addition to the files. */
export interface Given {
  /** Number of dropped start-up lists. */
  startups: number;
}

/** The weight of a verdict. */
export const WEIGHTS: Record<Report["headline"]["standing"], Weight> =
  { good: "good", bad: "error", open: "warning", plain: "info" };

/** The files that a run asked for and that were not dropped. */
export function missing(overview: Overview): string[] {
  const called = overview.messages.filter((message) => message.code === "FC320");
  const lists = overview.machine.said.filter((said) => said.code === "FC123");
  return [...new Set([...lists, ...called].map((said) => quoted(said.message)))];
}

/** The first quoted part of a message. */
function quoted(message: string): string {
  return /`([^`]+)`/.exec(message)?.[1] ?? message;
}

/** Returns whether a run asked for a file of this path. */
export function isMissing(overview: Overview, path: string): boolean {
  const last = (name: string): string => name.split(/[/\\]/).pop()?.toLowerCase() ?? "";
  return missing(overview).some((name) => last(name) === last(path));
}

/** The verdict of a run, which is good only where nothing else is to be said, and what it rests on. */
export function verdict(overview: Overview, given: Given): Sentence[] {
  const notes = [...doubts(overview, given)];
  const { headline } = overview;
  if (headline !== null) {
    const weight = headline.standing === "good" && (notes.length > 0 || !isQuiet(overview))
      ? "info" : WEIGHTS[headline.standing];
    return [{ weight, text: sentence(headline.text) }, ...notes];
  }
  const isConfigured = overview.axes.some((axis) => axis.startUp !== "unconfigured");
  if (!isConfigured && overview.machine.isDescribed) {
    notes.push({ weight: "info", text: "No axis of this program has friction compensation configured." });
  }
  return notes;
}

/** Returns whether a run on a described machine came to its end without messages. */
function isQuiet({ errors, warnings, infos, endedBy, machine }: Overview): boolean {
  const isWhole = endedBy !== null && !["error", "budget"].includes(endedBy);
  return isWhole && machine.isDescribed && errors + warnings + infos === 0;
}

/** Yields what a verdict does not say of the run and of the dropped files. */
function* doubts(overview: Overview, given: Given): Generator<Sentence> {
  if (overview.blocks === 0) {
    yield { weight: "warning", text: "There is no block in this program: nothing was run." };
  }
  for (const axis of overview.axes) {
    if (axis.listed && axis.end === "unknown" && axis.possible !== null) {
      yield { weight: "info", text: `${axis.name} at the end: ${axis.possible}.` };
    }
    if (axis.uncompensated !== null) {
      yield { weight: "warning", text: `${axis.name}${axis.uncompensated}.` };
    }
  }
  if (overview.remark !== null) {
    yield { weight: "warning", text: sentence(overview.remark) };
  }
  const { machine } = overview;
  if (given.startups > 1 && machine.origin === null) {
    yield { weight: "warning", text: `${given.startups} start-up lists were dropped, and none is used: `
      + "frictcomp.toml says which one counts. Drop it, too, or only one of them." };
  }
  if (machine.missing > 0) {
    yield { weight: "warning", text: `${counted(machine.missing, "list")} not found: parameters that they `
      + "would give have their documented defaults. Drop the lists, too." };
  }
  const broken = machine.said.filter((said) => said.severity === "error").length;
  if (broken > 0) {
    yield { weight: "error", text: `${counted(broken, "error")} in the lists: the control would not take them so.` };
  }
  const remarks = machine.said.length - broken;
  if (remarks > 0) {
    yield { weight: "info", text: `${counted(remarks, "remark")} about the lists: see Machine.` };
  }
  for (const lost of overview.messages.filter((message) => message.code === "FC320")) {
    yield { weight: "error", text: `${sentence(lost.message)} Drop that file, too.` };
  }
  if (overview.kept < overview.blocks) {
    yield { weight: "info", text: `The timeline shows the first ${grouped(overview.kept)} of ${
      counted(overview.blocks, "block")}; messages and the end are those of all.` };
  }
  if (overview.messagesLeftOut > 0) {
    yield { weight: "info", text: `${counted(overview.messagesLeftOut, "more message")} not shown.` };
  }
}

/** A clause in lower case as a sentence. */
export function sentence(text: string): string {
  // A name keeps its letters.
  const whole = /^[a-z]+( |$)/.test(text) ? text.charAt(0).toUpperCase() + text.slice(1) : text;
  return /[.!?]$/.test(whole) ? whole : `${whole}.`;
}
