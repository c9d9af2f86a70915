// Which lines of a long list are on the screen. Browsers bound the height of an element, so the height
// of a list beyond that stands for more than its own pixels.

/** Height in px up to which all browsers support elements. */
export const TALLEST = 8_000_000;

export interface Window {
  /** The height of a line in px. */
  line: number;
  /** Number of lines. */
  total: number;
  /** The height of the visible part of the list in px. */
  seen: number;
}

/** Returns the height of the list in px. */
export function height({ line, total }: Window): number {
  return Math.min(line * total, TALLEST);
}

/** Returns whether a line has fewer pixels than it needs. */
export function isSquashed(window: Window): boolean {
  return window.line * window.total > TALLEST;
}

/** The first visible line when the list is scrolled by so many px. */
export function firstLine(window: Window, scrolled: number): number {
  const fits = window.seen / window.line;
  if (!isSquashed(window)) {
    return Math.max(0, Math.floor(scrolled / window.line));
  }
  const share = scrolled / Math.max(1, height(window) - window.seen);
  return Math.max(0, Math.round(Math.min(1, share) * (window.total - fits)));
}

/** By how many px the list is scrolled when a line is the first visible one. */
export function scrollOf(window: Window, line: number): number {
  const fits = window.seen / window.line;
  if (!isSquashed(window)) {
    return line * window.line;
  }
  const share = line / Math.max(1, window.total - fits);
  return Math.min(1, share) * (height(window) - window.seen);
}
