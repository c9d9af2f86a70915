// The editable program: a text with its line numbers.

import { h } from "./dom";

/** Longer programs are not edited here. */
export const LONGEST = 400_000;

/** Keystrokes that follow each other within this many ms are one change. */
const PAUSE = 200;

export class Editor {
  private readonly numbers = h("pre", { class: "numbers", "aria-hidden": true });
  private readonly text = h("textarea", {
    class: "code", spellcheck: "false", autocapitalize: "off", autocomplete: "off", wrap: "off",
    "aria-label": "Program text",
  });
  private timer = 0;
  private lines = 0;

  constructor(
    readonly root: HTMLElement,
    private readonly changed: (text: string) => void,
    private readonly moved: (line: number) => void,
  ) {
    this.text.addEventListener("input", () => {
      this.count();
      window.clearTimeout(this.timer);
      this.timer = window.setTimeout(() => { this.changed(this.text.value); }, PAUSE);
    });
    this.text.addEventListener("scroll", () => {
      this.numbers.scrollTop = this.text.scrollTop;
    });
    this.text.addEventListener("click", () => { this.moved(this.line()); });
    this.text.addEventListener("keyup", (event) => {
      if (/^(Arrow|Page|Home|End)/.test(event.key)) {
        this.moved(this.line());
      }
    });
    root.append(this.numbers, this.text);
  }

  /** Shows a text. */
  show(text: string): void {
    window.clearTimeout(this.timer);
    this.text.value = text;
    this.count();
  }

  /** Puts the caret at the start of a line. */
  go(line: number): void {
    const lines = this.text.value.split("\n");
    const at = lines.slice(0, line - 1).reduce((sum, before) => sum + before.length + 1, 0);
    this.text.focus();
    this.text.setSelectionRange(at, at + (lines[line - 1]?.length ?? 0));
    const height = this.text.scrollHeight / Math.max(1, lines.length);
    this.text.scrollTop = Math.max(0, (line - 1) * height - this.text.clientHeight / 2);
  }

  /** Gives the text the focus. */
  focus(): void {
    this.text.focus();
    this.text.setSelectionRange(0, 0);
  }

  private line(): number {
    return this.text.value.slice(0, this.text.selectionStart).split("\n").length;
  }

  private count(): void {
    const lines = this.text.value.split("\n").length;
    if (lines !== this.lines) {
      this.lines = lines;
      this.numbers.textContent = Array.from({ length: lines }, (_, at) => at + 1).join("\n");
    }
  }
}
