/** What the language server answers beyond the protocol; `docs/editors.md` describes it. */

/** The words of a state, as on the command line. */
export type State = "active" | "ineffective" | "inactive" | "unconfigured" | "unknown";

/** An axis at a block; in a loop or a subprogram there may be several states. */
export interface AxisStates {
  axis: string;
  before: State[];
  after: State[];
}

/** The answer of `frictcomp/states`: the axes at the block of a line. */
export interface States {
  axes: AxisStates[];
  /** All of it in one short line. */
  text: string;
}

/** Lines with the same states; they count from 0, and `to` is the first one after them. */
export interface Segment {
  from: number;
  to: number;
  states: State[];
}

/** The answer of `frictcomp/timeline`: the states after each line of a program. */
export interface Timeline {
  lines: number;
  axes: { axis: string; segments: Segment[] }[];
  /** What the states rest on, where that has to be said. */
  remark: string | null;
}

/** The answer of a command that shows a report: a page that needs nothing else. */
export interface Report {
  html: string;
}
