// One session with the extension in VS Code, in a browser, as a user would have it: the demo program,
// its problems, a hover, a quick fix, the compensation view, a report, the contour. Once alone, and once with an
// extension that declares the languages that ISG's extension declares, or ISG's own, whose built folder
// ISG_EXTENSION names.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { chromium } from "playwright-core";

const { FRICTCOMP, BROWSER, SERVER, BESIDE, ISG_EXTENSION, SCREENSHOTS, VSIX } = process.env;
const HERE = path.resolve(import.meta.dirname, "../..");
const DEMO = path.resolve(HERE, "../../programs/demo");
const THEMES = ["Default Dark Modern", "Default Light Modern", "Default High Contrast"];

/** Longer than anything takes on a busy machine, in ms. */
const PATIENCE = 120_000;

const root = fs.mkdtempSync(path.join(os.tmpdir(), "frictcomp-vscode-"));
const extensions = path.join(root, "extensions");
const data = path.join(root, "data");
const workspace = path.join(root, "parts");
/** The settings of the workspace that were set. */
const chosen = {};

prepare();
const { server, address } = await startServer();
const browser = await chromium.launch({
  executablePath: BROWSER,
  args: ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update"],
});
try {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  page.setDefaultTimeout(PATIENCE);
  await session(page).catch(async (error) => {
    await shot(page, "failed");
    throw error;
  });
  console.log(`VS Code, ${BESIDE === "isg" ? "beside ISG's languages" : "alone"}: passed`);
} finally {
  await browser.close();
  server.kill();
  fs.rmSync(root, { recursive: true, force: true });
}

function prepare() {
  fs.mkdirSync(extensions, { recursive: true });
  execFileSync("unzip", ["-q", VSIX ?? path.join(HERE, "dist/frictcomp.vsix"), "extension/*", "-d", root]);
  fs.renameSync(path.join(root, "extension"), path.join(extensions, "frictcomp.frictcomp-0.1.0"));
  if (BESIDE === "isg") {
    standIn();
  }
  fs.mkdirSync(path.join(data, "data/Machine"), { recursive: true });
  write(path.join(data, "data/Machine/settings.json"), VSIX ? {} : { "frictcomp.path": FRICTCOMP });
  fs.cpSync(DEMO, workspace, { recursive: true });
  fs.writeFileSync(path.join(workspace, "typed.nc"), "");
  theme(THEMES[0]);
}

/** ISG's extension, or one that only declares what ISG's does. */
function standIn() {
  const folder = path.join(extensions, "isg-cnc.vscode-isg-cnc-1.3.0");
  if (ISG_EXTENSION) {
    fs.cpSync(ISG_EXTENSION, folder, { recursive: true });
    return;
  }
  fs.mkdirSync(folder);
  write(path.join(folder, "package.json"), {
    name: "vscode-isg-cnc",
    publisher: "isg-cnc",
    version: "1.3.0",
    engines: { vscode: "^1.86.2" },
    contributes: {
      languages: [
        { id: "isg-cnc", aliases: ["CNC", "ISG CNC"], extensions: [".nc", ".cnc", ".cyc", ".ecy", ".sub", ".plc"] },
        { id: "isg-list", aliases: ["List", "ISG List"], extensions: [".lis"] },
      ],
    },
  });
}

function theme(name) {
  settings({ "workbench.colorTheme": name });
}

function settings(further) {
  const folder = path.join(workspace, ".vscode");
  fs.mkdirSync(folder, { recursive: true });
  Object.assign(chosen, further);
  write(path.join(folder, "settings.json"), {
    ...chosen,
    "workbench.startupEditor": "none",
    "workbench.tips.enabled": false,
    "workbench.welcomePage.walkthroughs.openOnInstall": false,
    "editor.minimap.enabled": false,
  });
}

function write(file, value) {
  fs.writeFileSync(file, JSON.stringify(value, null, 2));
}

async function startServer() {
  const started = spawn(
    process.execPath,
    [
      path.join(SERVER, "out/server-main.js"),
      ...["--host", "127.0.0.1", "--port", "0", "--without-connection-token", "--accept-server-license-terms"],
      ...["--telemetry-level", "off", "--server-data-dir", data, "--extensions-dir", extensions],
    ],
    { stdio: ["ignore", "pipe", "inherit"] },
  );
  const port = await new Promise((resolve, reject) => {
    let told = "";
    started.stdout.on("data", (chunk) => {
      told += chunk;
      const match = /listening on (\d+)/.exec(told);
      if (match) {
        resolve(match[1]);
      }
    });
    started.on("exit", () => reject(new Error(`VS Code ended: ${told}`)));
  });
  return { server: started, address: `http://127.0.0.1:${port}/?folder=${workspace}` };
}

async function session(page) {
  await page.goto(address);
  await page.locator(".monaco-workbench").waitFor();
  await trust(page);
  await open(page, "friction.nc");

  const language = BESIDE === "isg" ? "CNC" : "NC program (ISG, TwinCAT)";
  await page.locator("#status\\.editor\\.mode").filter({ hasText: language }).waitFor();

  await command(page, "Problems: Focus on Problems View");
  const problems = page.locator(".markers-panel .monaco-list-row");
  const forgotten = problems.filter({ hasText: "FC401" });
  await forgotten.first().waitFor();
  assert.equal(await forgotten.count(), 2, "the two axes that are left inactive");

  await page.locator(".view-line").filter({ hasText: "N35" }).hover({ position: { x: 60, y: 8 } });
  const hover = page.locator(".monaco-hover:visible");
  await hover.filter({ hasText: "inactive" }).first().waitFor();
  await shot(page, "hover");

  await goTo(page, 3);
  const states = page.locator("#frictcomp\\.frictcomp\\.frictcomp\\.states");
  await states.waitFor();
  assert.match(await states.getAttribute("aria-label"), /COMP/);

  await fix(page);
  await page.waitForFunction(
    () => [...document.querySelectorAll(".markers-panel .monaco-list-row")]
      .filter((row) => row.textContent.includes("FC401")).length === 1,
  );
  await shot(page, "fixed");

  await command(page, "frictcomp: Focus on Compensation View");
  const view = await inner(page, 0);
  await view.locator(".track .stretch").first().waitFor();
  for (const name of THEMES) {
    theme(name);
    await page.waitForTimeout(1500);
    await shot(page, `timeline-${name.split(" ")[1].toLowerCase()}`);
  }
  await view.locator(".column").first().locator(".stretch.inactive").click();
  // In the middle of the bar, which covers lines 5 to 7.
  await page.locator("#status\\.editor\\.selection").filter({ hasText: /Ln 6,/ }).waitFor();
  await page.locator(".editor-instance .monaco-editor.focused").waitFor();

  await command(page, "frictcomp: Run Program and Show Its Timeline");
  await page.locator(".tab").filter({ hasText: "Run of friction.nc" }).waitFor();
  const report = await inner(page, 1);
  await report.getByText("N35 X22 Y33 Z44").first().waitFor();
  await shot(page, "report");

  await page.locator(".view-line").filter({ hasText: "N55" }).first().click();
  await debug(page);
  await contour(page);
  await type(page);
}

/** The question comes late on a busy machine, and is always asked, since it is not a workspace setting. */
async function trust(page) {
  await page.getByRole("button", { name: /Yes, I trust/ }).click();
}

async function open(page, name) {
  await page.keyboard.press("Control+P");
  await page.keyboard.type(name);
  await page.locator(".quick-input-list .monaco-list-row").filter({ hasText: name }).first().waitFor();
  await page.keyboard.press("Enter");
  await page.locator(".view-line").first().waitFor();
}

async function command(page, name) {
  await page.keyboard.press("F1");
  await page.keyboard.type(name);
  await page.locator(".quick-input-list .monaco-list-row").filter({ hasText: name }).first().waitFor();
  await page.keyboard.press("Enter");
}

async function goTo(page, line) {
  await page.keyboard.press("Control+G");
  await page.keyboard.type(`:${line}`.slice(1));
  await page.keyboard.press("Enter");
}

/** Restores an axis before M30 with the quick fix of its message. */
async function fix(page) {
  await page.keyboard.press("End");
  await page.keyboard.press("Home");
  await page.keyboard.press("Control+ArrowRight");
  // Into the range of the message: outside it, the answer depends on how soon markers are there.
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Control+Period");
  // The first action is already selected.
  await page.locator(".action-widget .monaco-list-row.focused").filter({ hasText: "COMP ON FRICT" }).waitFor();
  await page.keyboard.press("Enter");
}

/** Steps through the program from its first block to a change of a state. */
async function debug(page) {
  const at = (line) =>
    page.locator("#status\\.editor\\.selection").filter({ hasText: `Ln ${line},` }).waitFor();
  await page.keyboard.press("F5");
  await page.locator(".debug-toolbar").waitFor();
  await at(2);
  await page.keyboard.press("F10");
  await at(3);
  await page.keyboard.press("F5");
  await at(4);
  await page.locator(".debug-variables .monaco-list-row").filter({ hasText: "Axes" }).waitFor();
  await page.locator(".debug-variables .monaco-list-row").filter({ hasText: "inactive" }).first().waitFor();
  await shot(page, "debug");
  await page.keyboard.press("Shift+F5");
  await page.locator(".debug-toolbar").waitFor({ state: "hidden" });
}

/** The contour follows the cursor, and a click in it leads to the block of the place. */
async function contour(page) {
  await open(page, "plate.nc");
  await command(page, "frictcomp: Show the Contour of the Program");
  await page.locator(".tab").filter({ hasText: "Contour of plate.nc" }).waitFor();
  const shown = await contourPage(page);
  const here = shown.locator("#here");
  await shown.locator("svg.fc-picture").waitFor();
  await shown.getByText("the preset `stiff`").waitFor();
  const leftOut = shown.getByText("unknown start positions of X, Y, Z");
  await leftOut.waitFor();

  settings({ "frictcomp.contour.start": { X: 0, Y: 0, Z: 10 } });
  await leftOut.waitFor({ state: "detached" });

  await page.locator(".tab").filter({ hasText: "plate.nc" }).first().click();
  await goTo(page, 165);
  await here.filter({ hasText: "Line 165 drives what is marked" }).waitFor();
  assert.equal(await shown.locator("#cursor polyline").count(), 1);
  assert.equal(await shown.locator(".worst button[aria-current]").count(), 1);
  await goTo(page, 1);
  await here.filter({ hasText: "Nothing up to line 1" }).waitFor();
  await shot(page, "contour");

  await shown.locator(".worst button").filter({ hasText: "line 169:" }).click();
  await page.locator("#status\\.editor\\.selection").filter({ hasText: /Ln 169,/ }).waitFor();
  // The middle of what the line drives, of which the picture shows the place.
  const marked = shown.locator("#cursor polyline");
  await marked.waitFor();
  const place = await marked.evaluate((line) => {
    line.scrollIntoView({ block: "center" });
    const at = line.getPointAtLength(line.getTotalLength() / 2).matrixTransform(line.getScreenCTM());
    const picture = line.ownerSVGElement.getBoundingClientRect();
    return { x: at.x - picture.x, y: at.y - picture.y };
  });
  await goTo(page, 1);
  await here.filter({ hasText: "Nothing up to line 1" }).waitFor();
  const box = await shown.locator("svg:has(#cursor)").boundingBox();
  await page.mouse.move(box.x + place.x, box.y + place.y);
  await shown.locator("#pointed polyline").waitFor();
  await page.mouse.click(box.x + place.x, box.y + place.y);
  await here.filter({ hasText: /Line (16[5-9]|17[0-9]) drives/ }).waitFor();

  for (const name of THEMES) {
    theme(name);
    await page.waitForTimeout(1500);
    await shot(page, `contour-${name.split(" ")[1].toLowerCase()}`);
  }
  settings({ "frictcomp.contour.plant": "no-such.toml" });
  await shown.locator(".refused").filter({ hasText: "no-such.toml" }).waitFor();
  await shot(page, "contour-refused");
}

/** Enter after a word that begins like another one in the text is a line break (R12.11). */
async function type(page) {
  await open(page, "typed.nc");
  await page.locator(".editor-instance .monaco-editor.focused").waitFor();
  const lines = ["N10 G01 X10 Y20 F1000 M30", "N20 X1", "N30 F100", "N40 M3", "X", "N50 M4", ""];
  for (const line of lines.slice(0, -1)) {
    await page.keyboard.type(line);
    // The suggestions of an editor appear some time after the word.
    await page.waitForTimeout(1000);
    await page.keyboard.press("Enter");
  }
  await page.keyboard.press("Control+S");
  const saved = () => fs.readFileSync(path.join(workspace, "typed.nc"), "utf8");
  for (const end = Date.now() + PATIENCE; saved() !== lines.join("\n") && Date.now() < end; ) {
    await page.waitForTimeout(200);
  }
  assert.equal(saved(), lines.join("\n"));
}

/** The page of the contour, whichever webview it is in. */
async function contourPage(page) {
  for (;;) {
    for (const frame of page.frames()) {
      const isIt = await frame.title().then((title) => title === "Contour").catch(() => false);
      if (isIt) {
        return frame;
      }
    }
    await page.waitForTimeout(200);
  }
}

/** The page inside a webview, by the order in which they were opened; it is two frames deep. */
async function inner(page, order) {
  const outer = page.locator("iframe.webview.ready").nth(order).contentFrame();
  await outer.locator("iframe#active-frame").waitFor({ state: "attached" });
  return outer.locator("iframe#active-frame").contentFrame();
}

async function shot(page, name) {
  if (SCREENSHOTS) {
    await page.screenshot({ path: path.join(SCREENSHOTS, `${BESIDE}-${name}.png`) });
  }
}
