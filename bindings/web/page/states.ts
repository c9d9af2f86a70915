// States in words and marks.

import type { Axis, State } from "./answers";
import { h } from "./dom";

/** Meanings of the states, in the order of the legend. */
export const MEANINGS: readonly [state: State | "away", meaning: string][] = [
  ["active", "switched on, and a value list was accepted: it works"],
  ["away", "not as after a start of the control: the next program finds it so"],
  ["inactive", "switched off"],
  ["ineffective", "switched on, but no value list was accepted: it does nothing"],
  ["unconfigured", "P-AXIS-00522 of the axis is 0: it cannot be switched on"],
  ["unknown", "only the machine knows: frictcomp does not guess"],
];

/** Returns whether a state of an axis differs from the one after a start of the control. */
export function isAway(state: State | "changing", axis: Axis): boolean {
  return state !== axis.startUp && state !== "changing" && state !== "unknown";
}

/** A state as a word with its mark. */
export function word(state: State, axis: Axis): HTMLElement {
  const away = isAway(state, axis) ? " away" : "";
  return h("span", { class: `state ${state}${away}` }, h("span", { class: "word" }, state));
}

/** The axes that the timeline shows, by their positions. */
export function listed(axes: readonly Axis[]): number[] {
  return axes.flatMap((axis, at) => (axis.listed ? [at] : []));
}
