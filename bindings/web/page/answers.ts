// The answers of the engine, as `src/run.rs`, `src/audits.rs` and their neighbours write them.

import type { Report } from "./report";

export type State = "active" | "inactive" | "ineffective" | "unconfigured" | "unknown";
export type Severity = "error" | "warning" | "info";
export type FileKind = "program" | "list" | "values" | "startup" | "configuration" | "recording" | "picture" | "foreign" | "other";
export type View = "all" | "notable";

/** A change to a text that does what a message advises; columns count letters from 1. */
export interface Fix {
  file: string;
  line: number;
  column: number;
  end_line: number;
  end_column: number;
  text: string;
  safety: string;
  /** A change further down that is made with it; left out where there is none. */
  also?: Fix;
}

export interface Diagnostic {
  /** Left out where there is none. */
  fixes?: Fix[];
  code: string;
  severity: Severity;
  message: string;
  help: string[];
  file: string;
  line: number;
  column: number;
  axis: string | null;
}

/** A message, and the block that it follows; 0 before the first. */
export interface Message extends Diagnostic {
  after: number;
}

/** From one block to another, both included. */
export type Stretch = [from: number, to: number, state: State | "changing"];

export interface Axis {
  name: string;
  startUp: State;
  start: State;
  end: State;
  listed: boolean;
  changes: number;
  changedBy: { file: string; line: number; number: number | null }[];
  /** The possible states at the end where it is unknown because ways differ. */
  possible: string | null;
  /** The feed moves without compensation, in words that follow the name. */
  uncompensated: string | null;
  bar: Stretch[];
}

export interface Machine {
  origin: string | null;
  isDescribed: boolean;
  lists: number;
  missing: number;
  said: Diagnostic[];
}

export interface Overview {
  program: string;
  name: string | null;
  axes: Axis[];
  axesAsTheyOccur: boolean;
  blocks: number;
  kept: number;
  endedBy: string | null;
  remark: string | null;
  errors: number;
  warnings: number;
  infos: number;
  messages: Message[];
  messagesLeftOut: number;
  passedOver: [word: string, times: number][];
  headline: Report["headline"] | null;
  machine: Machine;
  items: number;
  notableItems: number;
}

/** The states at a line of the timeline. */
export interface States {
  states: State[];
  /** The possible states of an axis that is unknown because ways differ; left out where there is none. */
  possible?: [axis: number, words: string][];
}

export interface BlockItem extends States {
  kind: "block";
  block: number;
  file: string | null;
  line: number;
  level: number;
  text: string;
  changes: number[];
}

export type Item =
  | BlockItem
  | States & { kind: "start" | "end" }
  | { kind: "message"; at: number };

export interface AuditCell {
  word: string;
  effect: string;
  by?: { file: string; line: number };
  reason?: { code?: string; message: string };
}

export interface Audit {
  headline: Report["headline"];
  notChecked: string | null;
  machines: {
    origin: string | null;
    axes: {
      axis: string;
      leavers: number;
      inheritors: number;
      unknown: number;
      hazards: number;
      cure: string;
    }[];
    programs: { file: string; cells: AuditCell[] }[];
  }[];
  failures: { message: string; help: string | null }[];
  words: [word: string, meaning: string][];
}

/** Settings of a run. */
export interface Settings {
  enable: string[];
  keepGoing: boolean;
}
