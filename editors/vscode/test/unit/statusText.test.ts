import { expect, test } from "vitest";
import { statusText, statusTooltip } from "../../src/statusText";

test("each axis that has compensation is one sign, and the words are in the tooltip", () => {
  const axes = [
    { axis: "X", before: "active", after: "inactive" },
    { axis: "Y", before: "active", after: "active" },
    { axis: "Z", before: "unconfigured", after: "unconfigured" },
    { axis: "C", before: "unknown", after: "unknown" },
  ] as const;
  expect(statusText(axes)).toBe("X $(circle-slash)  Y $(check)  C $(question)");
  expect(statusTooltip(axes)).toBe(
    "Friction compensation after this block\nX: active → inactive\nY: active\nZ: unconfigured\nC: unknown",
  );
});

test("a machine without compensation says so", () => {
  expect(statusText([{ axis: "X", before: "unconfigured", after: "unconfigured" }])).toBe("no axis has compensation");
  expect(statusText([])).toBe("no axis has compensation");
});
