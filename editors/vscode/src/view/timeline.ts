/** The page of the timeline view: one column of bars for each axis, and a marker at the line of the cursor. */
import { columns, lineAt, type Column } from "./bars";
import type { Timeline } from "../protocol";
import type { FromPage, ToPage } from "./messages";

declare function acquireVsCodeApi(): { postMessage(message: FromPage): void };

const host = acquireVsCodeApi();
const page = document.body;
let lines = 0;

window.addEventListener("message", (event: MessageEvent<ToPage>) => {
  const message = event.data;
  switch (message.kind) {
    case "timeline":
      lines = message.timeline.lines;
      draw(message.name, message.timeline);
      break;
    case "cursor":
      mark(message.line);
      break;
    case "empty":
      page.replaceChildren(element("p", "empty", message.reason));
      break;
  }
});

function draw(name: string, timeline: Timeline): void {
  const shown = columns(timeline);
  if (shown.length === 0) {
    page.replaceChildren(element("p", "empty", `No axis of the machine of ${name} has friction compensation.`));
    return;
  }
  const chart = element("div", "chart");
  for (const { axis, bars } of shown) {
    const column = element("div", "column");
    column.append(element("div", "axis", axis));
    const track = element("div", "track");
    for (const bar of bars) {
      const part = document.createElement("button");
      part.className = `stretch ${bar.look}`;
      part.style.top = `${(bar.top * 100).toFixed(4)}%`;
      part.style.height = `max(${(bar.height * 100).toFixed(4)}%, 2px)`;
      const where = bar.first === bar.last ? `line ${bar.first.toString()}` : `lines ${bar.first.toString()} to ${bar.last.toString()}`;
      part.title = `${axis} ${bar.words}, ${where}`;
      part.setAttribute("aria-label", part.title);
      part.addEventListener("click", (event) => {
        // The keyboard has no position within the bar: it leads to its first line.
        const line = event.detail === 0 ? bar.first - 1 : lineBelow(event, track);
        host.postMessage({ kind: "goto", line });
      });
      track.append(part);
    }
    column.append(track);
    chart.append(column);
  }
  const marker = element("div", "marker");
  marker.id = "marker";
  marker.hidden = true;
  chart.append(marker);
  const remark = timeline.remark === null ? [] : [element("p", "remark", timeline.remark)];
  page.replaceChildren(element("h1", "name", name), ...remark, chart, legend(shown));
}

function lineBelow(event: MouseEvent, track: HTMLElement): number {
  const box = track.getBoundingClientRect();
  return lineAt((event.clientY - box.top) / box.height, lines);
}

function mark(line: number): void {
  const marker = document.getElementById("marker");
  if (marker === null || lines === 0) {
    return;
  }
  marker.hidden = false;
  marker.style.setProperty("--at", ((line + 0.5) / lines).toFixed(6));
}

function legend(shown: readonly Column[]): HTMLElement {
  const list = element("ul", "legend");
  const looks = new Set(shown.flatMap(({ bars }) => bars.map(({ look }) => look)));
  for (const look of looks) {
    const item = element("li", "", look === "changing" ? "differs between runs" : look);
    item.prepend(element("span", `sample stretch ${look}`));
    list.append(item);
  }
  return list;
}

function element(tag: string, className: string, text = ""): HTMLElement {
  const made = document.createElement(tag);
  made.className = className;
  made.textContent = text;
  return made;
}

host.postMessage({ kind: "ready" });
