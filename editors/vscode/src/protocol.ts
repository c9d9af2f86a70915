/** What the language server answers beyond the protocol; `docs/editors.md` describes it. */

/** The words of a state, as on the command line. */
export type State = "active" | "ineffective" | "inactive" | "unconfigured" | "unknown" | "several";

export interface AxisState {
  axis: string;
  before: State;
  after: State;
}

/** The answer of `frictcomp/states`: the axes at the block of a line. */
export interface States {
  axes: AxisState[];
}

/** A run of lines in which an axis has one state; lines count from 0, `to` is not in it. */
export interface Segment {
  from: number;
  to: number;
  state: State;
}

/** The answer of `frictcomp/timeline`: the states after each line of a program. */
export interface Timeline {
  lines: number;
  axes: { axis: string; segments: Segment[] }[];
}
