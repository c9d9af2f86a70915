import type { Report as PageReport } from "../../../bindings/web/page/report";

/** The answers of the language server beyond the protocol; `docs/editors.md` describes them. */

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
  /** States of all axes in one short line. */
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
  /** Basis of the states, if it has to be stated. */
  remark: string | null;
}

/** The part of the path that a block drives: a line through points of the picture. */
export interface Stretch {
  /** The number of its file, from 0. */
  file: number;
  /** Its line, from 0. */
  line: number;
  points: [number, number][];
  /** The machine time at its end in s. */
  end: number;
}

/** The answer of `frictcomp/contour`: the picture of the path, and the places in it. */
export interface Contour {
  /** The picture; none where nothing was driven. */
  svg: string | null;
  /** The URIs of the programs whose blocks are driven. */
  files: string[];
  /** The path block by block, in the order of driving. */
  stretches: Stretch[];
  /** The worst reversals, the worst first. */
  worst: { file: number; line: number; words: string }[];
  /** The verdict, then the figures in sentences and tables. */
  report: PageReport;
  /** Remarks on the basis of the contour, and on what is missing from it. */
  remarks: string[];
}

/** The answer of a command that shows a report: a page that needs nothing else. */
export interface Report {
  html: string;
}
