/** The timeline of a program as bars over its lines: geometry only, no page. */
import type { State, Timeline } from "../protocol";

export interface Bar {
  state: State;
  /** First and last line of the bar, as the editor numbers them. */
  first: number;
  last: number;
  /** Where it stands, in parts of the height. */
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
    .filter(({ segments }) => segments.some(({ state }) => state !== "unconfigured"))
    .map(({ axis, segments }) => ({
      axis,
      bars: segments.map(({ from, to, state }) => ({
        state,
        first: from + 1,
        last: to,
        top: from / lines,
        height: (to - from) / lines,
      })),
    }));
}

/** The line, counted from 0, at a height between 0 and 1. */
export function lineAt(height: number, lines: number): number {
  const last = Math.max(lines - 1, 0);
  return Math.min(Math.max(Math.floor(height * lines), 0), last);
}
