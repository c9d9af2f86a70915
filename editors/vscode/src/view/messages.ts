/** The messages between the extension and the page of the timeline view. */
import type { Timeline } from "../protocol";

export type ToPage =
  | { kind: "timeline"; name: string; timeline: Timeline }
  | { kind: "cursor"; line: number }
  | { kind: "empty"; reason: string };

export type FromPage = { kind: "ready" } | { kind: "goto"; line: number };
