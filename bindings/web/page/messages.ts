// Every message with what to do about it.

import type { Diagnostic, Message, Overview } from "./answers";
import { grouped, h } from "./dom";

/** The messages of a run; `jump` hears the block of the one that is asked for. */
export function messages(overview: Overview, jump: (message: Message) => void): HTMLElement {
  if (overview.messages.length === 0) {
    return h("p", { class: "quiet" }, "There is no message about this program.");
  }
  const items = overview.messages.map((message) =>
    h("li", { class: message.severity }, told(message, () => { jump(message); })));
  return h("ul", { class: "messages" }, ...items);
}

/** A message as words, with its place. */
export function told(said: Diagnostic, jump?: () => void): HTMLElement {
  const place = `${said.file}:${grouped(said.line)}:${said.column}`;
  const helps = said.help.map((help) => h("li", {}, help));
  return h(
    "div", {},
    h("span", { class: "sev" }, `${said.severity} ${said.code}`), " ",
    h("span", {}, said.message), " ",
    jump ? h("button", { class: "place", onclick: jump }, place) : h("span", { class: "place" }, place),
    helps.length > 0 && h("ul", { class: "help" }, ...helps),
  );
}
