// The page: the dropped files, the program that is shown, and the user's questions about it.

import type { Audit, FileKind, Fix, Overview, Settings } from "./answers";
import { audit } from "./audit";
import { bars } from "./bars";
import { DEMO, DEMO_START } from "./demo";
import { counted, fill, grouped, h, part } from "./dom";
import { Editor, LONGEST } from "./editor";
import { Edits, fixed, sought } from "./edits";
import { Refused } from "./engine";
import { type Intake, dropped, picked } from "./intake";
import { left } from "./left";
import { described, parameters } from "./machine";
import { withCode } from "./markdown";
import { messages } from "./messages";
import { besides, download, picture } from "./pictures";
import { recorded, recording, verify } from "./recording";
import { refused } from "./report";
import { Cancelled, Session } from "./session";
import {
  circle, circleQuestion, contour, contourQuestion, FieldError, forgetContour, noted, positions, tune,
} from "./simulations";
import { MEANINGS } from "./states";
import { type Tab, Tabs } from "./tabs";
import { Timeline } from "./timeline";
import { type Given, isMissing, missing, verdict } from "./verdict";

/** Work that takes longer is shown with its progress, in ms. */
const PATIENCE = 250;

/** With more programs the audit is shown first. */
const FEW = 3;

/** Narrower windows fold what is looked at only once, in px. */
const NARROW = 960;

const decoder = new TextDecoder();

const edits = new Edits();
/** The line that was found last in the program that is shown. */
let foundLine = 0;
const settings: Settings = { enable: [], keepGoing: false };
let program: string | null = null;
/** The recording that is shown in place of the program. */
let shownRecording: string | null = null;
let overview: Overview | null = null;
let kinds: [path: string, kind: FileKind][] = [];
/** Number of pieces of work that are pending. */
let underWay = 0;
/** The run that the last answer belongs to: later runs make earlier answers worthless. */
let ticket = 0;

const session = new Session(await code(), () => {
  const address = URL.createObjectURL(new Blob([WORKER], { type: "text/javascript" }));
  return new Worker(address);
}, (blocks, line) => {
  const at = line > 0 ? `, line ${grouped(line)}` : "";
  part("progress").textContent = `${counted(blocks, "block")}${at}`;
}, (text) => { part("progress").textContent = text; });
const editor = new Editor(part("editor"), (text) => { void edit(text); }, (line) => {
  void attempt(timeline.jumpToLine(line));
});
const timeline = new Timeline(session, part("timeline"), {
  edit: (line) => {
    if (!part("editor").hidden) {
      editor.go(line);
    }
  },
});
const tabs = new Tabs((tab) => { void attempt(show(tab)); });

/** The engine, which the page carries compressed. */
async function code(): Promise<ArrayBuffer> {
  if (typeof DecompressionStream === "undefined") {
    part("too-old").hidden = false;
    throw new Error("no DecompressionStream");
  }
  const carried = atob(part("engine").textContent.trim());
  const bytes = Uint8Array.from(carried, (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

/** Waits for work; shows progress if it takes long, and the reason if it fails. */
async function attempt<T>(work: Promise<T>): Promise<T | null> {
  underWay += 1;
  const timer = window.setTimeout(() => {
    part("working").hidden = false;
  }, PATIENCE);
  try {
    const result = await work;
    return result;
  } catch (error) {
    complain(error);
    return null;
  } finally {
    window.clearTimeout(timer);
    underWay -= 1;
    if (underWay === 0) {
      part("working").hidden = true;
      part("progress").textContent = "";
    }
  }
}

function complain(error: unknown): void {
  const box = part("complaint");
  if (error instanceof FieldError) {
    error.show();
    return;
  }
  if (error instanceof Refused) {
    fill(box, refused(error.refusal));
  } else {
    const message = error instanceof Cancelled ? "Cancelled." : error instanceof Error ? error.message : String(error);
    fill(box, refused({ message, help: null, said: [] }));
  }
  box.hidden = false;
}

/** Accepts files and shows the first program, or the audit of many. */
async function take(work: Promise<Intake> | Intake): Promise<void> {
  part("complaint").hidden = true;
  const intake = await work;
  if (intake.incoming.length === 0) {
    throw new Error(intake.leftOut === 0 ? "There is no file here: the folder is empty."
      : `There is nothing to read here: ${counted(intake.leftOut, "file")} left out, hidden or too large.`);
  }
  for (const { path, file, named } of intake.incoming) {
    session.put(path, { content: new Uint8Array(await file.arrayBuffer()), named });
    edits.arrived(path);
  }
  await arrived(intake.incoming.map(({ path }) => path));
  part("left-out").textContent = intake.leftOut === 0
    ? "" : `${counted(intake.leftOut, "file")} left out: hidden, too large, or too many.`;
}

async function arrived(paths: readonly string[]): Promise<void> {
  kinds = await session.json<typeof kinds>({ ask: "files" });
  part("welcome").hidden = kinds.length > 0;
  part("work").hidden = kinds.length === 0;
  const programs = pathsOf("program");
  // Files that the program on display asked for are for that program.
  const shown = overview;
  const isNew = (path: string): boolean =>
    paths.includes(path) && !(shown !== null && isMissing(shown, path));
  // A dropped program is the one that the user means; lists are for the one that is shown.
  const first = programs.find((path) => isNew(path) && !/\.(spf|sub|cyc)$/i.test(path))
    ?? programs.find(isNew);
  const meant = first ?? program ?? programs[0] ?? null;
  const recordings = pathsOf("recording");
  const chosen = recordings.find(isNew) ?? shownRecording ?? (meant === null ? recordings[0] : undefined);
  files();
  if (first === undefined && chosen !== undefined && recordings.includes(chosen)) {
    await attempt(openRecording(chosen));
    return;
  }
  if (meant === null) {
    program = null;
    part("program").hidden = true;
    part("recording").hidden = true;
    part("no-program").hidden = kinds.length === 0;
    return;
  }
  await open(meant);
  if (first !== undefined && programs.length > FEW) {
    tabs.show("audit");
  } else {
    tabs.show(tabs.current);
  }
}

function pathsOf(wanted: FileKind): string[] {
  return kinds.flatMap(([path, kind]) => (kind === wanted ? [path] : []));
}

/** Names for files that the page has no use for. */
const OTHERS = {
  picture: "picture",
  foreign: "foreign program",
  other: "other file",
};

/** The list of files. */
function files(): void {
  const [programs, recordings] = [pathsOf("program"), pathsOf("recording")];
  const lists = kinds.filter(([, kind]) => ["list", "values", "startup", "configuration"].includes(kind));
  const others = (["picture", "foreign", "other"] as const).map((kind) => [kind, pathsOf(kind)] as const);
  const choices = (paths: readonly string[], open: (path: string) => void): HTMLElement =>
    h("ul", {}, ...paths.map((path) => h("li", {}, h("button", {
      "aria-current": path === (shownRecording ?? program) ? "true" : null,
      title: path,
      onclick: () => { open(path); },
    }, ...pathParts(path)))));
  fill(
    part("files"),
    h("h2", {}, counted(programs.length, "program")),
    choices(programs, (path) => { void openTimeline(path); }),
    recordings.length > 0 && h("h2", {}, counted(recordings.length, "recording")),
    recordings.length > 0 && choices(recordings, (path) => { void attempt(openRecording(path)); }),
    lists.length === 0 ? h("h2", {}, "No list") : h("details", { open: window.innerWidth > NARROW },
      h("summary", {}, h("h2", {}, counted(lists.length, "list"))),
      h("ul", {}, ...lists.map(([path]) => h("li", { title: path }, ...pathParts(path))))),
    ...others.map(([kind, all]) => all.length > 0 && h("details", {},
      h("summary", { class: "quiet" }, counted(all.length, OTHERS[kind])),
      h("ul", {}, ...all.map((path) => h("li", { title: path }, ...pathParts(path)))))),
  );
  const needed = overview ? missing(overview) : [];
  fill(part("missing"), needed.length > 0 && h("div", { class: "notice warning" },
    h("h2", {}, "Not dropped"), h("ul", {}, ...needed.map((name) => h("li", {}, name)))));
}

/** Shows a recording in place of a program. */
async function openRecording(path: string): Promise<void> {
  part("complaint").hidden = true;
  shownRecording = path;
  files();
  part("program").hidden = true;
  part("no-program").hidden = true;
  part("recording").hidden = false;
  await recording(session, path, pathsOf("values"));
}

/** A path that may be broken after each folder. */
function pathParts(path: string): (HTMLElement | string)[] {
  const parts = path.split("/");
  const name = parts.pop() ?? "";
  return [...parts.flatMap((folder) => [h("span", { class: "quiet" }, `${folder}/`), h("wbr")]), name];
}

async function openTimeline(path: string, line?: number): Promise<void> {
  await open(path);
  tabs.show("timeline");
  if (line !== undefined) {
    await attempt(timeline.jumpToLine(line));
  }
}

/** Runs a program and shows it. */
async function open(path: string): Promise<void> {
  const isOther = path !== program;
  program = path;
  shownRecording = null;
  part("no-program").hidden = true;
  part("program").hidden = false;
  part("recording").hidden = true;
  mark();
  if (isOther) {
    foundLine = 0;
  }
  if (isOther && !part("editor").hidden) {
    await fillEditor();
  }
  await rerun();
}

async function rerun(): Promise<void> {
  part("complaint").hidden = true;
  await run();
}

async function run(): Promise<void> {
  const path = program;
  if (path === null) {
    return;
  }
  const mine = ++ticket;
  const found = await attempt(session.json<Overview>({ ask: "run", program: path, settings }));
  if (mine !== ticket) {
    return;
  }
  if (!found) {
    // What is shown below would belong to something else.
    overview = null;
    timeline.forget();
    part("result").hidden = true;
    part("title").textContent = path;
    return;
  }
  overview = found;
  part("result").hidden = false;
  await result(found);
}

/** Returns the basis of a run in addition to the files. */
function given(): Given {
  return {
    startups: pathsOf("startup").length,
  };
}

async function result(found: Overview): Promise<void> {
  part("title").textContent = found.program;
  part("facts").textContent = [
    found.name === null ? null : `%${found.name}`,
    counted(found.blocks, "executed block"),
    counted(found.errors, "error"),
    counted(found.warnings, "warning"),
  ].filter((fact) => fact !== null).join(" · ");
  fill(part("verdict"), ...verdict(found, given()).map(({ weight, text }) =>
    h("p", { class: `notice ${weight}` }, ...withCode(text))));
  fill(part("left"), left(found, (line) => { void openTimeline(found.program, line); }));
  fill(part("bars"), bars(found, (block) => {
    tabs.show("timeline");
    void attempt(timeline.jump(block));
  }));
  part("tab-messages").textContent = `Messages (${grouped(found.messages.length)})`;
  part("tab-audit").textContent = `Audit (${grouped(pathsOf("program").length)})`;
  fill(part("panel-messages"), messages(found, {
    jump: (message) => {
      tabs.show("timeline");
      void attempt(timeline.jump(message.after));
    },
    fix: (fix) => { void attempt(apply(fix)); },
    explain,
  }), passedOver(found));
  files();
  described(found, explain);
  await timeline.show(found);
}

/** The page about a code. */
async function explain(code: string): Promise<string> {
  return decoder.decode(await session.ask({ ask: "explain", code }));
}

function passedOver(found: Overview): HTMLElement | null {
  if (found.passedOver.length === 0) {
    return null;
  }
  const words = found.passedOver.map(([word, times]) => `${word} ×${grouped(times)}`).join(", ");
  return h("p", { class: "quiet" }, `Passed over: ${words}`);
}

/** The content of a tab that is computed only on request. */
async function show(tab: Tab): Promise<void> {
  const root = part(`panel-${tab}`);
  if (program === null) {
    return;
  }
  switch (tab) {
    case "audit": {
      const found = await session.json<Audit>({ ask: "audit", enable: settings.enable });
      audit(part("audit"), found, (file, line) => { void openTimeline(file, line); });
      break;
    }
    case "current": {
      const answer = await session.json<{ svg: string | null; notes: string[] }>(
        { ask: "current", program, settings, start: positions("start") });
      const notes = noted(answer.notes);
      picture(part("current"), answer.svg, `Additive current of ${program} over time`, [], [notes]);
      break;
    }
    case "contour":
      forgetContour();
      await contour(session, program, settings);
      break;
    case "circle":
      await circle(session, program);
      break;
    case "timeline":
      if (overview) {
        await timeline.show(overview);
      }
      break;
    case "machine":
      await parameters(session, program, settings.enable);
      break;
    case "messages":
      root.scrollTop = 0;
      break;
  }
}

async function fillEditor(): Promise<void> {
  const path = program;
  const file = path === null ? undefined : session.files.get(path);
  if (path === null || !file) {
    return;
  }
  const isLong = file.content.length > LONGEST;
  part("too-long").hidden = !isLong;
  part("editor").classList.toggle("long", isLong);
  if (!isLong) {
    editor.show(await textOf(path));
  }
}

async function edit(text: string): Promise<void> {
  if (program !== null) {
    change(program, text);
    await rerun();
  }
}

function change(path: string, text: string): void {
  const file = session.files.get(path);
  if (file) {
    session.put(path, { content: edits.change(path, file.content, text), named: file.named });
    mark();
  }
}

/** Marks whether the program that is shown differs from its file. */
function mark(): void {
  const isEdited = edits.isEdited(program);
  part("edited").hidden = !isEdited;
  part("save-program").hidden = !isEdited;
}

/** The text of a file as the engine reads it. */
async function textOf(path: string): Promise<string> {
  const text = decoder.decode(await session.ask({ ask: "text", path }));
  return text.replace(/\r\n/g, "\n");
}

/** Applies a fix to its file, and runs the program again. */
async function apply(fix: Fix): Promise<void> {
  const paths = [...session.files.keys()];
  const path = paths.find((one) => one === fix.file) ?? paths.find((one) => one.endsWith(`/${fix.file}`));
  if (path === undefined) {
    throw new Error(`${fix.file} was not dropped.`);
  }
  change(path, fixed(await textOf(path), fix));
  if (path === program && !part("editor").hidden) {
    await fillEditor();
  }
  await rerun();
}

/** Goes to the line with this number, or to the next one with these words. */
async function search(): Promise<void> {
  if (program === null) {
    return;
  }
  const words = (part("search") as HTMLInputElement).value;
  const line = sought(await textOf(program), words, foundLine);
  const place = line === null ? null : await session.json<number | null>({ ask: "blockOfLine", line });
  part("found").textContent = line === null ? "not in this program"
    : `line ${grouped(line)}${place === null ? ", which is not executed" : ""}`;
  if (line !== null) {
    foundLine = line;
    if (place !== null) {
      await timeline.jump(place);
    }
    if (!part("editor").hidden) {
      editor.go(line);
    }
  }
}

async function save(question: object, ending: string, type: string): Promise<void> {
  const bytes = await attempt(session.ask(question));
  if (bytes) {
    download(besides(program ?? "frictcomp", ending), bytes, type);
  }
}

/** Ends all work. What was shown before is shown again, unless its own run was ended. */
function cancel(): void {
  session.cancel();
  window.setTimeout(() => {
    if (overview) {
      void run();
    }
  });
}

function on(id: string, event: string, act: (event: Event) => void): void {
  part(id).addEventListener(event, act);
}

function listen(): void {
  for (const id of ["pick-files", "pick-more"]) {
    on(id, "click", () => { part("file-input").click(); });
  }
  for (const id of ["pick-folder", "pick-more-folder"]) {
    on(id, "click", () => { part("folder-input").click(); });
  }
  for (const id of ["file-input", "folder-input"]) {
    on(id, "change", (event) => {
      const input = event.target as HTMLInputElement;
      const files = [...(input.files ?? [])];
      input.value = "";
      void attempt(take(picked(files)));
    });
  }
  on("demo", "click", () => {
    const incoming = DEMO.map(([path, text]) => ({ path, file: new Blob([text]), named: false }));
    (part("contour-start") as HTMLInputElement).value = DEMO_START;
    void attempt(take({ incoming, leftOut: 0 }).then(() => { tabs.show("contour"); }));
  });
  on("clear", "click", () => {
    if (edits.isUnsaved && !window.confirm("Programs that were changed here are not saved. Remove them?")) {
      return;
    }
    void attempt(session.clear().then(() => {
      edits.forgetAll();
      program = null;
      shownRecording = null;
      overview = null;
      timeline.forget();
      part("editor").hidden = true;
      part("edit").setAttribute("aria-pressed", "false");
      part("split").classList.remove("editing");
      mark();
      tabs.show("timeline");
      return arrived([]);
    }));
  });
  on("cancel", "click", cancel);
  on("notable", "change", (event) => {
    const isOn = (event.target as HTMLInputElement).checked;
    void attempt(timeline.look(isOn ? "notable" : "all"));
  });
  on("previous", "click", () => { void attempt(timeline.step(false)); });
  on("next", "click", () => { void attempt(timeline.step(true)); });
  on("edit", "click", () => {
    const isOpen = part("editor").hidden !== false;
    part("editor").hidden = !isOpen;
    part("edit").setAttribute("aria-pressed", String(isOpen));
    part("split").classList.toggle("editing", isOpen);
    if (isOpen) {
      void attempt(fillEditor().then(() => { editor.focus(); }));
    } else {
      part("too-long").hidden = true;
    }
  });
  on("keep-going", "change", (event) => {
    settings.keepGoing = (event.target as HTMLInputElement).checked;
    void rerun();
  });
  on("assume", "change", (event) => {
    const value = (event.target as HTMLInputElement).value;
    settings.enable = value.split(/[\s,;]+/).filter((name) => name !== "");
    void rerun();
  });
  on("current-form", "submit", (event) => {
    event.preventDefault();
    void attempt(show("current"));
  });
  const simulations = {
    "circle-form": (): Promise<void> => circle(session, program),
    "contour-form": (): Promise<void> => show("contour"),
    "tune-form": (): Promise<void> => tune(session),
    "circle-form-recorded": async (): Promise<void> => { await recorded(session, shownRecording ?? ""); },
    "verify-form": (): Promise<void> => verify(session, shownRecording ?? ""),
  };
  for (const [form, simulate] of Object.entries(simulations)) {
    on(form, "submit", (event) => {
      event.preventDefault();
      part("complaint").hidden = true;
      void attempt(simulate());
    });
  }
  on("save-report", "click", () => {
    void save({ ask: "report", program, settings }, ".report.html", "text/html");
  });
  on("save-program", "click", () => {
    const file = program === null ? undefined : session.files.get(program);
    if (program !== null && file) {
      download(besides(program, ""), Uint8Array.from(file.content), "application/octet-stream");
      edits.saved(program);
    }
  });
  on("search-form", "submit", (event) => {
    event.preventDefault();
    void attempt(search());
  });
  window.addEventListener("beforeunload", (event) => {
    if (edits.isUnsaved) {
      event.preventDefault();
    }
  });
  on("save-records", "click", () => {
    void save({ ask: "records", program, settings }, ".ndjson", "application/x-ndjson");
  });
  on("save-audit", "click", () => {
    void save({ ask: "auditReport", enable: settings.enable }, ".audit.html", "text/html");
  });
  on("save-circle", "click", () => {
    void save({ ask: "circleReport", ...circleQuestion(program) }, ".circle.html", "text/html");
  });
  on("save-contour", "click", () => {
    void save({ ask: "contourReport", ...contourQuestion(program, settings) }, ".contour.html", "text/html");
  });
  listenForDrops();
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape" && session.isBusy) {
      cancel();
    }
  });
}

function listenForDrops(): void {
  // A file dropped outside its place would be opened instead of the page.
  document.addEventListener("dragover", (event) => {
    event.preventDefault();
    document.body.classList.add("dragging");
  });
  document.addEventListener("dragleave", (event) => {
    if (event.relatedTarget === null) {
      document.body.classList.remove("dragging");
    }
  });
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("dragging");
    if (event.dataTransfer) {
      void attempt(take(dropped(event.dataTransfer)));
    }
  });
}

for (const legend of document.querySelectorAll("dl.states")) {
  fill(legend, ...MEANINGS.flatMap(([state, meaning]) => [
    h("dt", { class: `state ${state}` }, h("span", { class: "word" }, state === "away" ? "away from its start-up state" : state)),
    h("dd", {}, meaning)]));
}
part("version").textContent = VERSION;
listen();
document.body.classList.add("ready");
