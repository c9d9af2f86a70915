// The verdict of a run, in sentences. Nothing is called fine that was not checked.

import type { Axis, Message, Overview } from "./answers";
import { counted, grouped } from "./dom";
import { isAway } from "./states";

export type Weight = "error" | "warning" | "info" | "good";

export interface Sentence {
  weight: Weight;
  text: string;
}

/** What a run rests on in addition to the files. */
export interface Given {
  /** The axes on which friction compensation is assumed. */
  enable: readonly string[];
  /** How many start-up lists were dropped. */
  startups: number;
}

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

function names(axes: readonly Axis[]): string {
  return axes.map((axis) => axis.name).join(", ");
}

const START_UP = "Run after a start of the control, every axis ends as it began";

/** Whether a run asked for a file of this path. */
export function isMissing(overview: Overview, path: string): boolean {
  const last = (name: string): string => name.split(/[/\\]/).pop()?.toLowerCase() ?? "";
  return missing(overview).some((name) => last(name) === last(path));
}

/** The verdict of a run: the main sentence, and what it rests on. */
export function verdict(overview: Overview, given: Given): Sentence[] {
  const axes = overview.axes.filter((axis) => axis.listed);
  const sentences: Sentence[] = [];
  const say = (weight: Weight, text: string): void => {
    sentences.push({ weight, text });
  };
  // Messages before the first block are about the lists.
  const failed = overview.messages.filter((message: Message) =>
    message.severity === "error" && message.after > 0);
  const stop = failed[0];
  const isWhole = overview.endedBy !== null && !["error", "budget"].includes(overview.endedBy);
  if (overview.blocks === 0 && failed.length === 0) {
    say("warning", "There is no block in this program: nothing was run.");
  }
  if (overview.endedBy === "budget") {
    say("error", "A limit of frictcomp ended the run: what follows was not executed.");
  } else if (!isWhole) {
    const where = stop ? ` at line ${grouped(stop.line)}` : "";
    say("error", `The run stops${where}, as the control would: what follows was not executed.`);
  } else if (failed.length > 0) {
    say("error", `${counted(failed.length, "error")}: the control would have stopped.`);
  }
  const away = axes.filter((axis) => isAway(axis.end, axis));
  const unknown = axes.filter((axis) => axis.end === "unknown");
  if (away.length > 0) {
    const left = away.map((axis) => `${axis.name} ${axis.end}`).join(", ");
    say("warning", `Left for the next program: ${left}. The control starts with ${
      away.map((axis) => `${axis.name} ${axis.startUp}`).join(", ")}.`);
  }
  if (unknown.length > 0) {
    const left = unknown.map((axis) => axis.possible === null ? axis.name : `${axis.name} (${axis.possible})`);
    say("warning", `Not known at the end: ${left.join(", ")}. Only the machine decides it.`);
  }
  const idle = axes.filter((axis) => axis.end === "ineffective");
  if (idle.length > 0) {
    say("warning", `Switched on and without an accepted value list, so it does nothing: ${names(idle)}.`);
  }
  for (const axis of axes) {
    if (axis.uncompensated !== null) {
      say("warning", `${axis.name}${axis.uncompensated}.`);
    }
  }
  if (overview.remark !== null) {
    say("warning", sentence(overview.remark));
  }
  if (given.enable.length > 0) {
    say("warning", `Friction compensation is assumed on ${given.enable.join(", ")}; no list confirms it.`);
  }
  if (given.startups > 1 && overview.machine.origin === null) {
    say("warning", `${given.startups} start-up lists were dropped, and none is used: frictcomp.toml says which `
      + "one counts. Drop it, too, or only one of them.");
  }
  const { machine } = overview;
  if (machine.missing > 0) {
    say("warning", `${counted(machine.missing, "list")} not found: parameters that they would give have `
      + "their documented defaults. Drop the lists, too.");
  }
  const broken = machine.said.filter((said) => said.severity === "error").length;
  if (broken > 0) {
    say("error", `${counted(broken, "error")} in the lists: the control would not take them so.`);
  }
  const remarks = machine.said.length - broken;
  if (remarks > 0) {
    say("info", `${counted(remarks, "remark")} about the lists: see Machine.`);
  }
  for (const lost of overview.messages.filter((message) => message.code === "FC320")) {
    say("error", `${sentence(lost.message)} Drop that file, too.`);
  }
  if (overview.isAssumed) {
    say("warning", "The states rest on an assumption about what only the machine knows.");
  }
  if (overview.kept < overview.blocks) {
    say("info", `The timeline shows the first ${grouped(overview.kept)} of ${
      counted(overview.blocks, "block")}; messages and the end are those of all.`);
  }
  if (overview.messagesLeftOut > 0) {
    say("info", `${counted(overview.messagesLeftOut, "more message")} not shown.`);
  }
  const configured = axes.filter((axis) => axis.startUp !== "unconfigured");
  if (configured.length === 0 && machine.isDescribed) {
    say("info", "No axis of this program has friction compensation configured.");
    return sentences;
  }
  const isQuiet = overview.errors + overview.warnings + overview.infos === 0;
  const isHome = away.length === 0 && unknown.length === 0 && isWhole && machine.isDescribed;
  if (isHome && isQuiet && sentences.length === 0) {
    say("good", `${START_UP}. The audit says what it does after other programs.`);
  } else if (isHome && idle.length < configured.length) {
    say("info", `${START_UP}, as far as the program was understood: see its messages.`);
  }
  return sentences;
}

/** A clause in lower case as a sentence. */
export function sentence(text: string): string {
  // A name keeps its letters.
  const whole = /^[a-z]+( |$)/.test(text) ? text.charAt(0).toUpperCase() + text.slice(1) : text;
  return /[.!?]$/.test(whole) ? whole : `${whole}.`;
}
