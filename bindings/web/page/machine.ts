// What describes the machine: its parameters, the curves of its value lists, the messages about them.

import type { Overview } from "./answers";
import { counted, fill, h, part } from "./dom";
import { type Explain, told } from "./messages";
import { picture } from "./pictures";
import type { Session } from "./session";

interface Parameters {
  tables: { name: string; rows: [number: string, key: string, value: string, origin: string][] }[];
  svg: string | null;
}

/** Shows where the machine of a run comes from, and the messages about its lists. */
export function described({ machine: { origin, isDescribed, lists, said } }: Overview, explain: Explain): void {
  const from = origin === null ? "No machine is described: neither frictcomp.toml nor one start-up list "
    + "was dropped. Every axis has the documented default, P-AXIS-00522 = 0."
    : `Described by ${origin}; ${counted(lists, "file")} read.`;
  fill(
    part("machine"),
    h("p", {}, from),
    !isDescribed && origin !== null && h("p", {}, "It names no axis with friction compensation."),
    said.length > 0 && h("h3", {}, "About the lists"),
    said.length > 0 && h("ul", { class: "messages" }, ...said.map((one) =>
      h("li", { class: one.severity }, told(one, explain)))),
  );
}

/** Shows the effective parameters of a program, and the curves. */
export async function parameters(session: Session, program: string, enable: string[]): Promise<void> {
  const found = await session.json<Parameters>({ ask: "parameters", program, enable });
  fill(part("parameters"), ...found.tables.map(({ name, rows }) =>
    h("details", {},
      h("summary", {}, `${name}: ${counted(rows.length, "parameter")}`),
      table(name, rows))));
  picture(part("curves"), found.svg, "The value lists that the control takes, as curves");
}

function table(name: string, rows: Parameters["tables"][number]["rows"]): HTMLElement {
  const titles = ["number", "key", "value", "origin"];
  return h("div", { class: "wide", tabindex: 0, role: "region", "aria-label": `Parameters: ${name}` },
    h("table", {},
      h("thead", {}, h("tr", {}, ...titles.map((title) => h("th", { scope: "col" }, title)))),
      h("tbody", {}, ...rows.map(([number, key, value, origin]) => h("tr", {},
        h("th", { scope: "row" }, number), h("td", {}, h("code", {}, key)),
        h("td", {}, value), h("td", { class: "quiet" }, origin))))));
}
