/** The timeline of a program as bars over its lines: geometry only, no page. */
import type { State, Timeline } from "../protocol";
import { inWords } from "../statusText";

/** The data that a bar is drawn from. */
export type Look = State | "changing";

export interface Bar {
  look: Look;
  /** The states in words. */
  words: string;
  /** First and last line of the bar, as the editor numbers them. */
  first: number;
  last: number;
  /** Its place, as fractions of the height. */
  top: number;
  height: number;
}

export interface Column {
  axis: string;
  bars: Bar[];
}

/** One column for each axis that has compensation somewhere, its bars from the first line down. */
export function columns(timeline: Timeline): Column[] {
  const lines = Math.max(timeline.lines, 1);
  return timeline.axes
    .filter(({ segments }) => segments.some(({ states }) => states.some((state) => state !== "unconfigured")))
    .map(({ axis, segments }) => ({
      axis,
      bars: segments.map(({ from, to, states }) => ({
        look: look(states),
        words: inWords(states),
        first: from + 1,
        last: to,
        top: from / lines,
        height: (to - from) / lines,
      })),
    }));
}

function look(states: readonly State[]): Look {
  const [first, ...others] = states;
  return first === undefined || others.length > 0 ? "changing" : first;
}

/** The line, counted from 0, at a height between 0 and 1. */
export function lineAt(height: number, lines: number): number {
  const last = Math.max(lines - 1, 0);
  return Math.min(Math.max(Math.floor(height * lines), 0), last);
}
