/** The messages between the extension and the page of the contour. */
import type { Contour } from "../protocol";

export type ToPage =
  | { kind: "driving"; name: string }
  | { kind: "contour"; name: string; contour: Contour }
  | { kind: "cursor"; file: number; line: number }
  | { kind: "refused"; name: string; reason: string };

export type FromPage = { kind: "ready" } | { kind: "goto"; file: number; line: number };
