// What a program leaves, axis by axis.

import type { Axis, Overview } from "./answers";
import { counted, grouped, h } from "./dom";
import { word } from "./states";

/** The maximum number of changing blocks that are named. */
const NAMED = 3;

/** The table of axes; `jump` receives the requested line of the program. */
export function left(overview: Overview, jump: (line: number) => void): HTMLElement {
  const axes = overview.axes.filter((axis) => axis.listed);
  if (axes.length === 0) {
    return h("p", { class: "quiet" }, "No axis occurs in this program.");
  }
  const rows = axes.map((axis) =>
    h("tr", {},
      h("th", { scope: "row" }, axis.name),
      h("td", {}, word(axis.start, axis)),
      h("td", {}, word(axis.end, axis), axis.possible !== null && `: ${axis.possible}`),
      h("td", { class: "by" }, ...changedBy(axis, overview.program, jump))));
  return h(
    "table", { class: "left" },
    h("caption", { class: "unseen" }, "What the program leaves"),
    h("thead", {}, h("tr", {}, ...["axis", "at start", "at end", "changed by"].map((title) =>
      h("th", { scope: "col" }, title)))),
    h("tbody", {}, ...rows),
  );
}

function changedBy(axis: Axis, program: string, jump: (line: number) => void): (HTMLElement | string)[] {
  if (axis.changes === 0) {
    return ["\u2013"];
  }
  const last = axis.changedBy.slice(-NAMED);
  const named = last.flatMap((block) => {
    const number = block.number === null ? "" : `N${block.number}, `;
    const place = block.file === program ? `line ${grouped(block.line)}` : `${block.file}:${block.line}`;
    const go = (): void => { jump(block.line); };
    return block.file === program
      ? [h("button", { class: "place", onclick: go }, `${number}${place}`), " "]
      : [`${number}${place} `];
  });
  const more = axis.changes - last.length;
  return more > 0 ? [...named, `after ${counted(more, "other change")}`] : named;
}
