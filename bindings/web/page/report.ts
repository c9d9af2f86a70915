// A report of the engine: its verdict, its picture, then sentences and tables.

import { h } from "./dom";
import type { Refusal } from "./engine";
import { withCode } from "./markdown";
import { picture } from "./pictures";
import { sentence, WEIGHTS } from "./verdict";

interface Table {
  caption: string | null;
  headings: string[];
  alignments: ("left" | "right")[];
  rows: string[][];
}

/** A report as `crates/report/src/document/shown.rs` writes it. */
export interface Report {
  headline: { standing: "good" | "bad" | "open" | "plain"; text: string };
  blocks: ({ line: string } | { table: Table })[];
}

export interface Drawn {
  svg: string | null;
  report: Report;
}

/** The verdict of a report, in the colour of its standing. */
export function lead({ headline }: Pick<Report, "headline">): HTMLElement {
  return h("p", { class: `lead notice ${WEIGHTS[headline.standing]}`, role: "status" },
    ...withCode(sentence(headline.text)));
}

/** Creates a notice with the reason why there is no report. */
export function refused({ message, help, said }: Refusal): HTMLElement {
  return h("div", { class: "notice error", role: "alert" },
    h("p", {}, ...withCode(sentence(message))), help !== null && h("p", {}, ...withCode(sentence(help))),
    ...said.map((one) => h("p", {}, ...withCode(`${one.file}:${one.line}: ${one.message}`))));
}

/** Creates the part of a report after its verdict. */
export function figures({ blocks }: Report): HTMLElement {
  return h("div", { class: "figures" }, ...blocks.map((block) =>
    "line" in block ? h("p", {}, ...withCode(block.line.trim())) : table(block.table)));
}

function table({ caption, headings, alignments, rows }: Table): HTMLElement {
  const cells = (scope: "col" | "row", row: readonly string[]): HTMLElement[] => row.map((cell, at) => {
    const isNumber = alignments[at] === "right";
    const isHeading = scope === "col" || (at === 0 && !isNumber);
    return h(isHeading ? "th" : "td", { class: isNumber && "num", scope: isHeading && scope }, ...withCode(cell));
  });
  return h("div", { class: "wide", tabindex: 0, role: "region", "aria-label": caption ?? headings.join(", ") },
    h("table", {},
      caption !== null && h("caption", {}, ...withCode(caption)),
      headings.some((heading) => heading !== "") && h("thead", {}, h("tr", {}, ...cells("col", headings))),
      h("tbody", {}, ...rows.filter((row) => row.length > 0).map((row) => h("tr", {}, ...cells("row", row))))));
}

/** Shows a picture between the verdict and the rest of its report. */
export function showDrawn(root: HTMLElement, { svg, report }: Drawn, told: string, ...between: HTMLElement[]): void {
  picture(root, svg, told, [lead(report)], [...between, figures(report)]);
}
