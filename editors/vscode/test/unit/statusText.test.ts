import { expect, test } from "vitest";
import type { AxisStates, State } from "../../src/protocol";
import { statusText, statusTooltip } from "../../src/statusText";

const states = (axis: string, before: State[], after: State[]): AxisStates => ({ axis, before, after });

test("each axis that has compensation is one sign, and the words are in the tooltip", () => {
  const axes = [
    states("X", ["active"], ["inactive"]),
    states("Y", ["active", "inactive"], ["active"]),
    states("Z", ["unconfigured"], ["unconfigured"]),
    states("C", ["unknown"], ["unknown", "active"]),
  ];
  expect(statusText(axes)).toBe("X $(circle-slash)  Y $(check)  C $(question)$(check)");
  expect(statusTooltip(axes)).toBe(
    "Friction compensation after this block\nX: active → inactive\nY: active or inactive → active\nZ: unconfigured\nC: unknown → unknown or active",
  );
});

test("a machine without compensation says so", () => {
  expect(statusText([states("X", ["unconfigured"], ["unconfigured"])])).toBe("no axis has compensation");
  expect(statusText([])).toBe("no axis has compensation");
});
