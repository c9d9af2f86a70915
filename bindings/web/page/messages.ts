// Every message with what to do about it.

import type { Diagnostic, Fix, Message, Overview } from "./answers";
import { grouped, h } from "./dom";

export interface Wanted {
  /** Called to show the block of a message. */
  jump(message: Message): void;
  /** Called to apply a fix. */
  fix(fix: Fix): void;
  explain: Explain;
}

/** Finds the page about a code. */
export type Explain = (code: string) => Promise<string>;

/** The messages of a run, with what can be done about each. */
export function messages(overview: Overview, wanted: Wanted): HTMLElement {
  if (overview.messages.length === 0) {
    return h("p", { class: "quiet" }, "There is no message about this program.");
  }
  const items = overview.messages.map((message) =>
    h("li", { class: message.severity },
      told(message, wanted.explain, () => { wanted.jump(message); }),
      ...(message.fixes ?? []).map((fix) => h("p", { class: "fix" },
        h("button", { class: "apply", onclick: () => { wanted.fix(fix); } }, `Apply: ${inWords(fix)}`)))));
  return h("ul", { class: "messages" }, ...items);
}

/** A message as words, with its place. */
export function told(said: Diagnostic, explain: Explain, jump?: () => void): HTMLElement {
  const place = `${said.file}:${grouped(said.line)}:${said.column}`;
  const helps = said.help.map((help) => h("li", {}, help));
  return h(
    "div", {},
    h("span", { class: "sev" }, `${said.severity} ${said.code}`), " ",
    h("span", {}, said.message), " ",
    jump ? h("button", { class: "place", onclick: jump }, place) : h("span", { class: "place" }, place),
    helps.length > 0 && h("ul", { class: "help" }, ...helps),
    about(said.code, explain),
  );
}

/** The page about a code, which is requested when it is first opened. */
function about(code: string, explain: Explain): HTMLElement {
  const page = h("pre", { class: "page" });
  const box = h("details", { class: "about", ontoggle: () => {
    if (box.open && page.textContent === "") {
      explain(code).then((text) => { page.textContent = text.trim(); }, () => {
        page.textContent = "There is no page about this code.";
      });
    }
  } }, h("summary", {}, `About ${code}`), page);
  return box;
}

/** What a fix does, in a line. */
export function inWords(fix: Fix): string {
  const isInsertion = fix.line === fix.end_line && fix.column === fix.end_column;
  const text = fix.text.trim();
  const place = `line ${grouped(fix.line)}${fix.also === undefined ? "" : ` and line ${grouped(fix.also.line)}`}`;
  if (text === "") {
    return `remove a part of ${place}`;
  }
  return isInsertion ? `insert ${text} at ${place}` : `${text} in ${place}`;
}
