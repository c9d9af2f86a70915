/** The page of the contour: the picture, the block of the cursor on it, and the figures. */
import { figures, lead } from "../../../../bindings/web/page/report";
import type { Contour, Stretch } from "../protocol";
import type { FromPage, ToPage } from "./messages";
import { find, machineTime, nearest, type Place } from "./places";

declare function acquireVsCodeApi(): { postMessage(message: FromPage): void };

/** Largest distance of a pointer from the path, in pixels of the screen. */
const REACH = 14;
const SVG = "http://www.w3.org/2000/svg";

const host = acquireVsCodeApi();
const page = document.body;
let contour: Contour | undefined;
let picture: SVGSVGElement | undefined;

window.addEventListener("message", (event: MessageEvent<ToPage>) => {
  const message = event.data;
  switch (message.kind) {
    case "driving":
      drive(message.name);
      break;
    case "contour":
      contour = message.contour;
      draw(message.name, message.contour);
      break;
    case "cursor":
      follow(message.file, message.line);
      break;
    case "refused":
      contour = undefined;
      picture = undefined;
      page.replaceChildren(
        element("h1", "name", message.name),
        element("p", "refused", `There is no contour: ${message.reason}.`),
      );
      break;
  }
});

/** The view belongs to an older text until the new contour arrives. */
function drive(name: string): void {
  const text = `The path of ${name} is driven…`;
  const state = document.getElementById("here");
  if (state === null) {
    page.replaceChildren(element("p", "empty", text));
  } else {
    state.textContent = text;
    picture?.classList.add("outdated");
  }
}

function draw(name: string, shown: Contour): void {
  picture = shown.svg === null ? undefined : parsed(shown.svg);
  const here = element("p", "here");
  here.id = "here";
  here.setAttribute("role", "status");
  const remarks = element("ul", "remarks");
  remarks.append(...shown.remarks.map((remark) => element("li", "", remark)));
  page.replaceChildren(
    lead(shown.report),
    ...(picture ? [here, picture] : [element("h1", "name", name), here]),
    ...(shown.remarks.length > 0 ? [remarks] : []),
    ...(shown.worst.length > 0 ? [worst(shown)] : []),
    figures(shown.report),
  );
  if (picture) {
    listen(picture, shown.stretches);
  }
}

/** The picture as an element. Its style is that of the page, which follows the theme. */
function parsed(svg: string): SVGSVGElement {
  const read = new DOMParser().parseFromString(svg, "image/svg+xml").documentElement;
  read.querySelectorAll("style").forEach((style) => {
    style.remove();
  });
  const own = document.importNode(read, true) as unknown as SVGSVGElement;
  own.append(group("pointed"), group("cursor"));
  return own;
}

function group(id: string): SVGElement {
  const made = document.createElementNS(SVG, "g");
  made.id = id;
  return made;
}

/** A pointer near the path leads to its block. */
function listen(svg: SVGSVGElement, stretches: readonly Stretch[]): void {
  const at = (event: MouseEvent): Stretch | undefined => {
    const matrix = svg.getScreenCTM()?.inverse();
    if (matrix === undefined) {
      return undefined;
    }
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix);
    return nearest(stretches, [x, y], REACH * matrix.a);
  };
  svg.addEventListener("pointermove", (event) => {
    const near = at(event);
    svg.classList.toggle("leading", near !== undefined);
    document.getElementById("pointed")?.replaceChildren(...(near ? [line(near)] : []));
  });
  // The focus that comes with a click may scroll the page: what counts is what was there before.
  let pressed: Stretch | undefined;
  svg.addEventListener("pointerdown", (event) => {
    pressed = at(event);
  });
  svg.addEventListener("click", () => {
    if (pressed) {
      host.postMessage({ kind: "goto", file: pressed.file, line: pressed.line });
    }
  });
}

function worst(shown: Contour): HTMLElement {
  const list = element("ol", "worst");
  list.setAttribute("aria-label", "The worst reversals");
  for (const { file, line: at, words } of shown.worst) {
    const button = element("button", "", words);
    button.dataset.file = file.toString();
    button.dataset.line = at.toString();
    button.addEventListener("click", () => {
      host.postMessage({ kind: "goto", file, line: at });
    });
    const item = element("li", "");
    item.append(button);
    list.append(item);
  }
  return list;
}

/** Marks what the cursor line drives. */
function follow(file: number, at: number): void {
  const here = document.getElementById("here");
  if (contour === undefined || here === null) {
    return;
  }
  const { own, above } = find(contour.stretches, file, at);
  const number = (at + 1).toString();
  const ends = own.length > 0 ? own.map(end) : above ? [end(above)] : [];
  document.getElementById("cursor")?.replaceChildren(...own.map(line), ...ends.map(ring));
  if (own.length > 0) {
    const times = own.length > 1 ? `, ${own.length.toString()} times` : "";
    here.textContent = `Line ${number} drives what is marked${times}, ${until(own)}.`;
  } else if (above) {
    const where = (above.line + 1).toString();
    here.textContent = `Line ${number} has no stretch here; the ring marks the end of line ${where}, ${until([above])}.`;
  } else {
    here.textContent = `Nothing up to line ${number} has a stretch here.`;
  }
  for (const button of document.querySelectorAll<HTMLElement>(".worst button")) {
    const isHere = button.dataset.file === file.toString() && button.dataset.line === at.toString();
    button.toggleAttribute("aria-current", isHere);
  }
}

/** The machine time up to the last of some stretches. */
function until(stretches: readonly Stretch[]): string {
  return `${machineTime(Math.max(...stretches.map((stretch) => stretch.end)))} from the start`;
}

function end(stretch: Stretch): Place {
  return stretch.points[stretch.points.length - 1] ?? [0, 0];
}

function line({ points }: Stretch): SVGElement {
  const made = document.createElementNS(SVG, "polyline");
  made.setAttribute("points", points.map(([x, y]) => `${x.toString()},${y.toString()}`).join(" "));
  return made;
}

function ring([x, y]: Place): SVGElement {
  const made = document.createElementNS(SVG, "circle");
  made.setAttribute("cx", x.toString());
  made.setAttribute("cy", y.toString());
  made.setAttribute("r", "7");
  return made;
}

function element(tag: string, className: string, text = ""): HTMLElement {
  const made = document.createElement(tag);
  made.className = className;
  made.textContent = text;
  return made;
}

host.postMessage({ kind: "ready" });
