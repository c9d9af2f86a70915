// The effect of the order of all dropped programs.

import type { Audit, AuditCell } from "./answers";
import { fill, h } from "./dom";
import { lead } from "./report";

const CURES: Record<string, string> = {
  none: "none needed",
  leavers: "one block before the end of those that leave it",
  inheritors: "one block before the first motion of those that inherit it",
};

/** Shows an audit; `open` receives the requested program and line. */
export function audit(root: HTMLElement, found: Audit, open: (file: string, line: number) => void): void {
  const failures = found.failures.map((failure) =>
    h("li", {}, `${failure.message}${failure.help === null ? "" : `: ${failure.help}`}`));
  fill(
    root,
    lead(found),
    found.notChecked !== null && h("p", { class: "notice warning" }, `Not checked: ${found.notChecked}. `
      + "Pick such a file by itself, or add its extension to frictcomp.toml."),
    failures.length > 0 && h("div", { class: "notice error" },
      h("p", {}, "Not audited, so nothing is known about these:"), h("ul", {}, ...failures)),
    ...found.machines.flatMap((machine) => [
      found.machines.length > 1 && h("h3", {}, machine.origin ?? "No machine is described"),
      machine.axes.length === 0
        ? h("p", { class: "notice warning" }, "No axis has friction compensation configured here, so "
          + "there is nothing to audit. Drop frictcomp.toml or the start-up list with its axis lists, "
          + "or assume friction compensation.")
        : axes(machine),
      machine.axes.length > 0 && programs(machine, open),
    ]),
    h("dl", { class: "legend" }, ...found.words.flatMap(([word, meaning]) => [
      h("dt", { class: `word ${word}` }, word), h("dd", {}, meaning)])),
  );
}

/** A name of a table that is unique among those of several machines. */
function named(words: string, { origin }: Audit["machines"][number]): string {
  return origin === null ? words : `${words}: ${origin}`;
}

function axes(machine: Audit["machines"][number]): HTMLElement {
  const all = machine.axes;
  const rows = all.map((axis) =>
    h("tr", {},
      h("th", { scope: "row" }, axis.axis),
      ...[axis.leavers, axis.inheritors, axis.unknown, axis.hazards].map((count) =>
        h("td", { class: "num" }, String(count))),
      h("td", { class: "cure" }, CURES[axis.cure] ?? axis.cure)));
  const titles = ["axis", "leave it away", "inherit it", "unknown", "hazardous pairs", "cheapest cure"];
  return h("div", { class: "wide", tabindex: 0, role: "region", "aria-label": named("Axes", machine) }, h("table", {},
    h("caption", { class: "unseen" }, "Axes"),
    h("thead", {}, h("tr", {}, ...titles.map((title) => h("th", { scope: "col" }, title)))),
    h("tbody", {}, ...rows)));
}

function programs(
  machine: Audit["machines"][number], open: (file: string, line: number) => void,
): HTMLElement {
  const rows = machine.programs.map((program) =>
    h("tr", {},
      h("th", { scope: "row" },
        h("button", { class: "place", onclick: () => { open(program.file, 1); } }, program.file)),
      ...program.cells.map((cell) => h("td", {}, told(cell, program.file, open)))));
  return h("div", { class: "wide", tabindex: 0, role: "region", "aria-label": named("Programs and axes", machine) }, h("table", { class: "programs" },
    h("caption", { class: "unseen" }, "Programs and axes"),
    h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "program"),
      ...machine.axes.map((axis) => h("th", { scope: "col" }, axis.axis)))),
    h("tbody", {}, ...rows)));
}

function told(cell: AuditCell, file: string, open: (file: string, line: number) => void): HTMLElement {
  const title = cell.reason?.message ?? cell.effect;
  const by = cell.by;
  return h("span", { class: `word ${cell.word}`, title }, cell.word,
    by && ["both", "leaves"].includes(cell.word) && h("button", {
      class: "place", onclick: () => { open(by.file === file ? file : by.file, by.line); },
    }, `line ${by.line}`));
}
