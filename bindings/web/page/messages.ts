// Every message with what to do about it.

import type { Diagnostic, Fix, Message, Overview } from "./answers";
import { counted, fill, grouped, h } from "./dom";
import { page, withCode } from "./markdown";

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
  const items = gathered(overview.messages).map(([message, ...others]) =>
    h("li", { class: message.severity },
      told(message, wanted.explain, () => { wanted.jump(message); }),
      ...repeated(others, wanted),
      ...(message.fixes ?? []).map((fix) => h("p", { class: "fix" },
        h("button", { class: "apply", onclick: () => { wanted.fix(fix); } }, `Apply: ${inWords(fix)}`)))));
  return h("ul", { class: "messages" }, ...items);
}

/** Messages of the same words, together, where the first of them stands; those with a fix stay apart. */
export function gathered(all: readonly Message[]): [Message, ...Message[]][] {
  const found = new Map<string, [Message, ...Message[]]>();
  for (const [at, message] of all.entries()) {
    const own = (message.fixes ?? []).length > 0 ? String(at) : "";
    const key = [message.code, message.file, message.message, own].join("\n");
    const known = found.get(key);
    if (known) {
      known.push(message);
    } else {
      found.set(key, [message]);
    }
  }
  return [...found.values()];
}

/** The number of the others, and the line of the last one. */
function repeated(others: readonly Message[], wanted: Wanted): (HTMLElement | string)[] {
  const last = others.at(-1);
  if (!last) {
    return [];
  }
  const place = `${last.file}:${last.line}:${last.column}`;
  return [h("p", { class: "quiet" }, `and ${counted(others.length, "more time")}, last at `,
    h("button", { class: "place", onclick: () => { wanted.jump(last); } }, place))];
}

/** A message as words, with its place. */
export function told(said: Diagnostic, explain: Explain, jump?: () => void): HTMLElement {
  // As tools take it: digits without blanks.
  const place = `${said.file}:${said.line}:${said.column}`;
  const helps = said.help.map((help) => h("li", {}, ...withCode(help)));
  return h(
    "div", {},
    h("span", { class: "sev" }, `${said.severity} ${said.code}`), " ",
    h("span", {}, ...withCode(said.message)), " ",
    jump ? h("button", { class: "place", onclick: jump }, place) : h("span", { class: "place" }, place),
    helps.length > 0 && h("ul", { class: "help" }, ...helps),
    about(said.code, explain),
  );
}

/** The page about a code, which is requested when it is first opened. */
function about(code: string, explain: Explain): HTMLElement {
  const shown = h("div", { class: "page" });
  const box = h("details", { class: "about", ontoggle: () => {
    if (box.open && shown.textContent === "") {
      explain(code).then((text) => { fill(shown, ...page(text)); }, () => {
        fill(shown, "There is no page about this code.");
      });
    }
  } }, h("summary", {}, `About ${code}`), shown);
  return box;
}

/** Describes a fix in a line. */
export function inWords(fix: Fix): string {
  const isInsertion = fix.line === fix.end_line && fix.column === fix.end_column;
  const text = fix.text.trim();
  const place = `line ${grouped(fix.line)}${fix.also === undefined ? "" : ` and line ${grouped(fix.also.line)}`}`;
  if (text === "") {
    return `remove a part of ${place}`;
  }
  return isInsertion ? `insert ${text} at ${place}` : `${text} in ${place}`;
}
