// What simulated drives do: contours, circles, tuned value lists.

import { fill, h, part } from "./dom";
import { withCode } from "./markdown";
import { download } from "./pictures";
import { type Drawn, showDrawn } from "./report";
import type { Settings } from "./answers";
import type { Session } from "./session";
import { sentence } from "./verdict";

/** The maximum number of feeds that are tuned for at once. */
const MOST_FEEDS = 8;

/** Fault of a field, shown next to it until the field changes. */
export class FieldError extends Error {
  constructor(readonly field: string, message: string) {
    super(message);
  }

  show(): void {
    const field = part(this.field);
    const said = h("span", { class: "field-error", role: "alert" }, this.message);
    field.parentElement?.querySelector(".field-error")?.remove();
    field.after(said);
    field.setAttribute("aria-invalid", "true");
    field.addEventListener("input", () => {
      said.remove();
      field.removeAttribute("aria-invalid");
    }, { once: true });
    field.focus();
  }
}

function value(id: string): string {
  return (part(id) as HTMLInputElement | HTMLSelectElement).value;
}

/** Returns the content of a field; `null` where it is empty. */
export function optional(id: string): string | null {
  return value(id).trim() || null;
}

/** Notes below a picture. */
export function noted(notes: readonly string[]): HTMLElement | null {
  return notes.length === 0 ? null
    : h("ul", { class: "notes" }, ...notes.map((note) => h("li", {}, ...withCode(sentence(note)))));
}

/** The axis positions at the start, in a field: `X0, Y-12.5, Z1=30`. */
export function positions(field: string): [axis: string, position: number][] {
  const found = positionsOf(value(field));
  if (found === null) {
    throw new FieldError(field, "Give positions in mm or degrees, such as X0, Y-12.5, Z1=30.");
  }
  return found;
}

/** The positions of a text; `null` where one of its words is none. */
export function positionsOf(written: string): [axis: string, position: number][] | null {
  const words = written.split(/[\s,;]+/).filter((word) => word !== "");
  const all = words.flatMap((word): [string, number][] => {
    const found = /^([A-Za-z]\w*)=(.+)$|^([A-Za-z])(.+)$/.exec(word);
    const [axis, position] = [found?.[1] ?? found?.[3], Number(found?.[2] ?? found?.[4])];
    return axis !== undefined && Number.isFinite(position) ? [[axis.toUpperCase(), position]] : [];
  });
  return all.length === words.length ? all : null;
}

/** The feeds of a text, `500, 1000`; none where one of its words is not a feed. */
export function feeds(written: string): number[] {
  const all = written.split(/[\s,;]+/).filter((word) => word !== "").map(Number);
  return all.length <= MOST_FEEDS && all.every((feed) => Number.isFinite(feed) && feed > 0) ? all : [];
}

/** The question for the contour of a program. */
export function contourQuestion(program: string | null, settings: Settings): object {
  return { program, settings, start: positions("contour-start"), plant: value("contour-plant") };
}

/** Drives a program and shows how far the axes leave its path. */
export async function contour(session: Session, program: string, settings: Settings): Promise<void> {
  const answer = await session.json<Drawn & { notes: string[] }>(
    { ask: "contour", ...contourQuestion(program, settings) });
  const notes = noted(answer.notes);
  showDrawn(part("contour"), answer, `Contour of ${program}: the path with its magnified deviation`,
    ...notes ? [notes] : []);
}

/** The question for a circular test on the machine of a program. */
export function circleQuestion(program: string | null): object {
  return {
    program,
    radiusMm: Number(value("radius")),
    feedMmPerMin: Number(value("feed")),
    plant: value("plant"),
  };
}

/** Drives a circle. */
export async function circle(session: Session, program: string | null): Promise<void> {
  const answer = await session.json<Drawn & { lists: string }>({ ask: "circle", ...circleQuestion(program) });
  showDrawn(part("circle"), answer, "Simulated circular test, compensation off and on", h("p", {}, answer.lists));
}

/** Searches the value list with the smallest glitch at all feeds. */
export async function tune(session: Session): Promise<void> {
  const wanted = feeds(value("feeds"));
  if (wanted.length === 0) {
    throw new FieldError("feeds", `Give from 1 to ${MOST_FEEDS} feeds in mm/min, such as 500, 2000.`);
  }
  const plant = value("plant");
  const answer = await session.json<Drawn & { list: string }>(
    { ask: "tune", radiusMm: Number(value("radius")), feedsMmPerMin: wanted, plant });
  const save = (): void => {
    download(`${plant}.lis`, new TextEncoder().encode(answer.list), "text/plain");
  };
  showDrawn(part("tuned"), answer, "The glitch before and after tuning",
    h("p", {}, h("button", { onclick: save }, "Download value list")));
}

/** Clears what belongs to a program that is no longer shown. */
export function forgetContour(): void {
  fill(part("contour"));
}
