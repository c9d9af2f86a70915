// The states of each axis over the executed blocks.

import type { Axis, Overview, Stretch } from "./answers";
import { grouped, h } from "./dom";
import { isAway, listed } from "./states";

/** A stretch in words, at most the first few. */
export function told(axis: Axis): string {
  const TOLD = 6;
  const words = axis.bar.map(([from, , state], at) =>
    at === 0 ? state : `${state} from block ${grouped(from)}`);
  const more = words.length - TOLD;
  const first = words.slice(0, TOLD).join(", ");
  return `${axis.name}: ${first || axis.start}${more > 0 ? ` and ${more} more` : ""}`;
}

/** The bars of the listed axes; `jump` receives the clicked block. */
export function bars(overview: Overview, jump: (block: number) => void): HTMLElement {
  const rows = listed(overview.axes).map((at) => {
    const axis = overview.axes[at];
    return axis ? row(axis, overview.kept, jump) : null;
  });
  const scale = h(
    "div", { class: "scale", "aria-hidden": true },
    h("span", {}, "block 1"), h("span", {}, grouped(overview.kept)),
  );
  return h("div", { class: "bars" }, ...rows, overview.kept > 1 && scale);
}

function row(axis: Axis, total: number, jump: (block: number) => void): HTMLElement {
  const track = h("div", { class: "track", role: "img", "aria-label": told(axis) },
    ...axis.bar.map((stretch) => bar(stretch, axis, total)));
  track.addEventListener("click", (event) => {
    const box = track.getBoundingClientRect();
    const share = (event.clientX - box.left) / Math.max(box.width, 1);
    jump(Math.min(total, Math.max(1, Math.ceil(share * total))));
  });
  return h("div", { class: "bar" }, h("span", { class: "axis", "aria-hidden": true }, axis.name), track);
}

function bar([from, to, state]: Stretch, axis: Axis, total: number): HTMLElement {
  const away = isAway(state, axis) ? " away" : "";
  const title = `${axis.name} ${state}, blocks ${grouped(from)} to ${grouped(to)} of ${grouped(total)}`;
  const made = h("span", { class: `stretch ${state}${away}`, title });
  made.style.left = `${(from - 1) / total * 100}%`;
  made.style.width = `${(to - from + 1) / total * 100}%`;
  return made;
}
