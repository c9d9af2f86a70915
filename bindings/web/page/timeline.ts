// The timeline: blocks with the states after them and the messages at their lines. Only what is on the
// screen is requested.

import type { Axis, BlockItem, Item, Overview, States, View } from "./answers";
import { fill, grouped, h } from "./dom";
import { withCode } from "./markdown";
import type { Session } from "./session";
import { listed, word } from "./states";
import { type Window, firstLine, height, isSquashed, scrollOf } from "./window";

/** The height of a line in em; the style sheet has the same. */
const LINE_EM = 1.7;

/** Shorter lists are shown as a whole, so that they can be printed and searched. */
const WHOLE = 400;

/** Lines above and below the screen that are loaded in advance. */
const SPARE = 20;

export interface Asked {
  /** Called to show a line of a file in the editor. */
  edit(line: number): void;
}

export class Timeline {
  private readonly spacer = h("div", { class: "spacer" });
  private readonly table = h("table", { class: "timeline" });
  private readonly box: HTMLElement;
  private overview: Overview | null = null;
  private view: View = "all";
  private selected = 0;
  private ticket = 0;
  private frame = 0;

  constructor(
    private readonly session: Session,
    readonly root: HTMLElement,
    private readonly asked: Asked,
  ) {
    this.box = h(
      "div",
      { class: "scroll", tabindex: 0, role: "region", "aria-label": "Timeline" },
      h("div", { class: "holder" }, this.spacer, this.table),
    );
    this.box.addEventListener("scroll", () => { this.later(); });
    this.box.addEventListener("wheel", (event) => { this.wheel(event); }, { passive: false });
    this.box.addEventListener("keydown", (event) => { this.key(event); });
    new ResizeObserver(() => { this.later(); }).observe(this.box);
    root.append(this.box);
  }

  /** Shows a run. */
  async show(overview: Overview): Promise<void> {
    const isSame = this.overview?.program === overview.program;
    this.overview = overview;
    if (!isSame) {
      this.selected = 0;
      this.box.scrollTop = 0;
    }
    this.lay();
    await this.draw();
  }

  /** Shows nothing. */
  forget(): void {
    this.overview = null;
    this.ticket += 1;
    fill(this.table);
  }

  /** Shows all blocks, or those with a change or a message. */
  async look(view: View): Promise<void> {
    this.view = view;
    this.lay();
    await this.jump(this.selected);
  }

  /** Brings a block to the middle and marks it. */
  async jump(block: number): Promise<void> {
    this.selected = block;
    const at = await this.session.json<number>({ ask: "place", view: this.view, block });
    const middle = Math.max(0, at - Math.floor(this.box.clientHeight / this.line() / 2));
    this.box.scrollTop = scrollOf(this.window(), middle);
    await this.draw();
  }

  /** The next block with a change or a message, or the one before. */
  async step(forward: boolean): Promise<void> {
    const question = { ask: "notable", block: this.selected, forward };
    const block = await this.session.json<number | null>(question);
    if (block !== null) {
      await this.jump(block);
    }
  }

  /** Brings the block of a line of the program to the middle. */
  async jumpToLine(line: number): Promise<void> {
    const block = await this.session.json<number | null>({ ask: "blockOfLine", line });
    if (block !== null) {
      await this.jump(block);
    }
  }

  private total(): number {
    const overview = this.overview;
    return (this.view === "all" ? overview?.items : overview?.notableItems) ?? 0;
  }

  private line(): number {
    return LINE_EM * Number.parseFloat(getComputedStyle(this.box).fontSize);
  }

  private window(): Window {
    return { line: this.line(), total: this.total(), seen: this.box.clientHeight };
  }

  private isWhole(): boolean {
    return this.total() <= WHOLE;
  }

  private lay(): void {
    const isWhole = this.isWhole();
    this.box.classList.toggle("whole", isWhole);
    const header = this.line();
    this.spacer.style.height = isWhole ? "0" : `${height(this.window()) + header}px`;
  }

  private later(): void {
    if (this.overview && !this.isWhole()) {
      cancelAnimationFrame(this.frame);
      this.frame = requestAnimationFrame(() => {
        // A cancelled request is drawn when its program is shown again.
        this.draw().catch(() => undefined);
      });
    }
  }

  /** A squashed list still moves line by line. */
  private wheel(event: WheelEvent): void {
    const window = this.window();
    if (isSquashed(window)) {
      event.preventDefault();
      const pixels = event.deltaMode === 1 ? event.deltaY * window.line : event.deltaY;
      this.by(Math.sign(pixels) * Math.max(1, Math.round(Math.abs(pixels) / window.line)));
    }
  }

  private key(event: KeyboardEvent): void {
    const window = this.window();
    const page = Math.floor(window.seen / window.line) - 1;
    const moves: Record<string, number> = {
      ArrowDown: 1, ArrowUp: -1, PageDown: page, PageUp: -page,
    };
    const move = moves[event.key];
    if (move !== undefined && isSquashed(window)) {
      event.preventDefault();
      this.by(move);
    }
  }

  private by(lines: number): void {
    const window = this.window();
    const first = firstLine(window, this.box.scrollTop);
    this.box.scrollTop = scrollOf(window, first + lines);
  }

  private async draw(): Promise<void> {
    const overview = this.overview;
    if (!overview) {
      return;
    }
    const ticket = ++this.ticket;
    const window = this.window();
    const first = this.isWhole() ? 0 : firstLine(window, this.box.scrollTop);
    const from = this.isWhole() ? 0 : Math.max(0, first - SPARE);
    const count = this.isWhole() ? WHOLE : Math.ceil(window.seen / window.line) + 2 * SPARE;
    const items = await this.session.json<Item[]>({ ask: "items", view: this.view, from, count });
    if (ticket !== this.ticket) {
      return;
    }
    const above = (first - from) * window.line;
    // Where the list is not squashed, lines move with the scroll bar by parts of a line.
    const top = isSquashed(window) ? this.box.scrollTop - above : from * window.line;
    this.table.style.top = this.isWhole() ? "" : `${Math.max(0, top)}px`;
    this.table.setAttribute("aria-rowcount", String(this.total() + 1));
    const axes = listed(overview.axes);
    const rows = items.map((item, at) => this.row(item, from + at, overview, axes));
    fill(this.table, caption(overview), head(overview, axes), h("tbody", {}, ...rows));
  }

  private row(item: Item, at: number, overview: Overview, axes: number[]): HTMLElement {
    const index = at + 2;
    switch (item.kind) {
      case "block":
        return this.block(item, index, overview, axes);
      case "message": {
        const message = overview.messages[item.at];
        const { severity, code, message: text } = message ?? { severity: "info", code: "", message: "" };
        return h(
          "tr", { class: `message ${severity}`, "aria-rowindex": index },
          h("td", {}),
          h("td", { colspan: axes.length + 1, title: text },
            h("span", { class: "sev" }, `${severity} ${code}`), " ", ...withCode(text)),
        );
      }
      case "start":
      case "end": {
        const ended = overview.endedBy === null ? "" : ` by ${overview.endedBy}`;
        const told = item.kind === "start" ? "at start" : `end${ended}`;
        return h(
          "tr", { class: "edge", "aria-rowindex": index },
          h("td", {}), h("td", {}, told), ...cells(item, [], overview.axes, axes),
        );
      }
    }
  }

  private block(item: BlockItem, index: number, overview: Overview, axes: number[]): HTMLElement {
    const place = item.file === null ? "" : `${item.file}:`;
    const isOwn = item.file === null;
    const text = item.level > 0 ? `${"\u00b7 ".repeat(Math.min(item.level, 8))}${item.text}` : item.text;
    return h(
      "tr",
      {
        class: item.block === this.selected ? "selected" : item.changes.length > 0 ? "change" : "",
        "aria-rowindex": index,
        onclick: () => {
          this.selected = item.block;
          if (isOwn) {
            this.asked.edit(item.line);
          }
          void this.draw();
        },
      },
      h("td", { class: "line", title: `${place}${item.line}` }, grouped(item.line)),
      h("td", { class: "text", title: isOwn ? null : `in ${item.file ?? ""}` }, text),
      ...cells(item, item.changes, overview.axes, axes),
    );
  }
}

function caption(overview: Overview): HTMLElement {
  return h("caption", { class: "unseen" }, `Blocks of ${overview.program} and the states after each`);
}

function head(overview: Overview, axes: number[]): HTMLElement {
  const names = axes.map((at) => h("th", { scope: "col" }, overview.axes[at]?.name ?? ""));
  return h(
    "thead", {},
    h("tr", { "aria-rowindex": 1 },
      h("th", { scope: "col", class: "line" }, "line"),
      h("th", { scope: "col", class: "text" }, "block"), ...names),
  );
}

function cells(
  { states, possible = [] }: States, changes: number[], all: Axis[], axes: number[],
): (HTMLElement | null)[] {
  return axes.map((at) => {
    const [axis, state] = [all[at], states[at]];
    if (!axis || !state) {
      return null;
    }
    const ways = possible.find(([unknown]) => unknown === at);
    const isChanged = changes.includes(at);
    return h(
      "td", { class: isChanged ? "states changed" : "states", title: ways?.[1] ?? null }, word(state, axis),
      isChanged && h("span", { class: "mark", title: "changed by this block" }, " \u25c4"),
    );
  });
}
