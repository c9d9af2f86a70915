import { expect, test } from "vitest";
import { find, machineTime, nearest } from "../../src/contour/places";
import type { Stretch } from "../../src/protocol";

const PATH: Stretch[] = [
  { file: 0, line: 3, points: [[0, 0], [100, 0]], end: 1 },
  { file: 1, line: 0, points: [[100, 0], [100, 100]], end: 2 },
  { file: 0, line: 7, points: [[100, 100], [0, 100]], end: 3 },
  { file: 0, line: 3, points: [[0, 100], [0, 50]], end: 4 },
];

test("a line has all that it drives, and a line without a stretch the one above", () => {
  expect(find(PATH, 0, 3)).toEqual({ own: [PATH[0], PATH[3]], above: undefined });
  expect(find(PATH, 1, 0)).toEqual({ own: [PATH[1]], above: undefined });
  // What is driven last of the line above.
  expect(find(PATH, 0, 5)).toEqual({ own: [], above: PATH[3] });
  expect(find(PATH, 0, 99)).toEqual({ own: [], above: PATH[2] });
  expect(find(PATH, 0, 2)).toEqual({ own: [], above: undefined });
  expect(find([], 0, 2)).toEqual({ own: [], above: undefined });
});

test("a place leads to the block that is nearest, and to none where it is far", () => {
  expect(nearest(PATH, [40, 3], 14)).toBe(PATH[0]);
  expect(nearest(PATH, [97, 60], 14)).toBe(PATH[1]);
  expect(nearest(PATH, [50, 50], 14)).toBeUndefined();
  // Beyond an end, and at a block that is a point.
  expect(nearest(PATH, [-10, 0], 14)).toBe(PATH[0]);
  const point: Stretch = { file: 0, line: 1, points: [[5, 5]], end: 5 };
  expect(nearest([point], [6, 6], 2)).toBe(point);
});

test("a machine time is told in minutes where it is long", () => {
  // R12.18
  expect([0, 8.34, 59.94, 60, 245.4, 3600].map(machineTime)).toEqual(
    ["0.0 s", "8.3 s", "59.9 s", "1 min 0 s", "4 min 5 s", "60 min 0 s"],
  );
});
