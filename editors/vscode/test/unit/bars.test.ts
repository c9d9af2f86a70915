import { expect, test } from "vitest";
import { columns, lineAt } from "../../src/view/bars";

test("bars fill the height in the order of the lines", () => {
  const shown = columns({
    lines: 10,
    remark: null,
    axes: [
      {
        axis: "X",
        segments: [
          { from: 0, to: 4, states: ["active"] },
          { from: 4, to: 10, states: ["inactive", "active"] },
        ],
      },
      { axis: "Z", segments: [{ from: 0, to: 10, states: ["unconfigured"] }] },
    ],
  });
  expect(shown).toEqual([
    {
      axis: "X",
      bars: [
        { look: "active", words: "active", first: 1, last: 4, top: 0, height: 0.4 },
        { look: "changing", words: "inactive or active", first: 5, last: 10, top: 0.4, height: 0.6 },
      ],
    },
  ]);
});

test("every height leads to a line of the program", () => {
  expect(lineAt(0, 10)).toBe(0);
  expect(lineAt(0.45, 10)).toBe(4);
  expect(lineAt(1, 10)).toBe(9);
  expect(lineAt(-0.2, 10)).toBe(0);
  expect(lineAt(0.5, 0)).toBe(0);
});
