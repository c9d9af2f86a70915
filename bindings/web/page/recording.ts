// A dropped recording: its channels, its circle, and a value list against it.

import { fill, h, part } from "./dom";
import { Refused } from "./engine";
import { withCode } from "./markdown";
import { type Drawn, figures, lead, refused, type Report, showDrawn } from "./report";
import type { Session } from "./session";
import { optional } from "./simulations";
import { sentence } from "./verdict";

interface Recorded {
  channels: Drawn;
  names: string[];
  circle: Drawn | null;
  noCircle: string | null;
}

/** Shows a recording; a value list that was dropped alone is compared with it. */
export async function recording(session: Session, path: string, lists: readonly string[]): Promise<void> {
  part("recording-title").textContent = path;
  const answer = await recorded(session, path);
  showDrawn(part("channels"), answer.channels, `The channels of ${path} over time`);
  for (const id of ["velocity", "torque"]) {
    choose(id, [["", "as recognised"], ...answer.names.map((name): [string, string] => [name, name])]);
  }
  choose("value-list", lists.map((list) => [list, list]));
  part("verify-form").hidden = lists.length === 0;
  part("no-value-list").hidden = lists.length > 0;
  fill(part("verified"));
  if (lists.length === 1) {
    await verify(session, path);
  }
}

/** Offers values with their names, and keeps the chosen one. */
function choose(id: string, all: readonly [value: string, name: string][]): void {
  const field = part(id) as HTMLSelectElement;
  const { value } = field;
  fill(field, ...all.map(([one, name]) => h("option", { value: one }, name)));
  field.value = all.some(([one]) => one === value) ? value : all[0]?.[0] ?? "";
}

/** Evaluates a recording, and shows its circle if it has one. */
export async function recorded(session: Session, path: string): Promise<Recorded> {
  const radius = optional("commanded-radius");
  const answer = await session.json<Recorded>(
    { ask: "recording", path, radiusMm: radius === null ? null : Number(radius) });
  const { circle, noCircle } = answer;
  part("circle-form-recorded").hidden = circle === null;
  if (circle) {
    showDrawn(part("recorded-circle"), circle, `The circle in ${path}, its deviation magnified`);
  } else {
    fill(part("recorded-circle"), noCircle !== null
      && h("p", { class: "notice warning" }, ...withCode(`No circle: ${sentence(noCircle)}`)));
  }
  return answer;
}

/** Compares a value list with a recording. */
export async function verify(session: Session, path: string): Promise<void> {
  const [axis, velocity, torque, list] = ["recorded-axis", "velocity", "torque", "value-list"].map(optional);
  try {
    const report = await session.json<Report>({ ask: "verify", path, list, axis, velocity, torque });
    fill(part("verified"), lead(report), figures(report));
  } catch (error) {
    if (!(error instanceof Refused)) {
      throw error;
    }
    fill(part("verified"), refused(error.refusal));
  }
}
