/** The states at the cursor as the status bar shows them. */
import type { AxisState } from "./protocol";

const SIGNS: Record<string, string> = {
  active: "$(check)",
  ineffective: "$(warning)",
  inactive: "$(circle-slash)",
  unknown: "$(question)",
  several: "$(list-unordered)",
};

/** One sign for each axis that has the compensation; the words are in the tooltip. */
export function statusText(axes: readonly AxisState[]): string {
  const shown = axes.filter((axis) => axis.after !== "unconfigured");
  if (shown.length === 0) {
    return "no axis has compensation";
  }
  return shown.map((axis) => `${axis.axis} ${SIGNS[axis.after] ?? axis.after}`).join("  ");
}

/** The states in words, one line for each axis. */
export function statusTooltip(axes: readonly AxisState[]): string {
  const lines = axes.map((axis) =>
    axis.before === axis.after
      ? `${axis.axis}: ${axis.after}`
      : `${axis.axis}: ${axis.before} → ${axis.after}`,
  );
  return ["Friction compensation after this block", ...lines].join("\n");
}
