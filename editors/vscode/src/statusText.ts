/** The states at the cursor as the status bar shows them. */
import type { AxisStates, State } from "./protocol";

const SIGNS: Record<State, string> = {
  active: "$(check)",
  ineffective: "$(warning)",
  inactive: "$(circle-slash)",
  unconfigured: "$(dash)",
  unknown: "$(question)",
};

/** One sign for each axis that has the compensation; the words are in the tooltip. */
export function statusText(axes: readonly AxisStates[]): string {
  const shown = axes.filter(({ after }) => after.some((state) => state !== "unconfigured"));
  if (shown.length === 0) {
    return "no axis has compensation";
  }
  return shown.map(({ axis, after }) => `${axis} ${after.map((state) => SIGNS[state]).join("")}`).join("  ");
}

/** The states in words, one line for each axis. */
export function statusTooltip(axes: readonly AxisStates[]): string {
  const lines = axes.map(({ axis, before, after }) => {
    const [from, to] = [inWords(before), inWords(after)];
    return from === to ? `${axis}: ${to}` : `${axis}: ${from} → ${to}`;
  });
  return ["Friction compensation after this block", ...lines].join("\n");
}

/** `active or inactive`, where the runs of a block differ. */
export function inWords(states: readonly State[]): string {
  return states.join(" or ");
}
