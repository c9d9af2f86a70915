// Tabs with arrow key navigation, as in the WAI-ARIA pattern.

import { part } from "./dom";

export const TABS = ["timeline", "messages", "audit", "current", "contour", "circle", "machine"] as const;

export type Tab = (typeof TABS)[number];

export class Tabs {
  current: Tab = "timeline";

  constructor(private readonly shown: (tab: Tab) => void) {
    for (const [at, tab] of TABS.entries()) {
      const button = part(`tab-${tab}`);
      button.addEventListener("click", () => { this.show(tab); });
      button.addEventListener("keydown", (event) => {
        const move = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
        const next = move === undefined
          ? { Home: TABS[0], End: TABS.at(-1) }[event.key]
          : TABS[(at + move + TABS.length) % TABS.length];
        if (next) {
          event.preventDefault();
          this.show(next);
          part(`tab-${next}`).focus();
        }
      });
    }
  }

  /** Shows a tab. */
  show(shown: Tab): void {
    this.current = shown;
    for (const tab of TABS) {
      const isShown = tab === shown;
      const button = part(`tab-${tab}`);
      button.setAttribute("aria-selected", String(isShown));
      button.tabIndex = isShown ? 0 : -1;
      part(`panel-${tab}`).hidden = !isShown;
    }
    this.shown(shown);
  }
}
