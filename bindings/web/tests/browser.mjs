// The page in a real Chromium, opened as a file and without network.
//
//     node tests/browser.mjs PAGE.html COMMAND ROOT CHROMIUM [SCREENSHOTS]

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const [html, command, root, executablePath, pictures] = process.argv.slice(2);
const address = pathToFileURL(resolve(html)).href;
const folder = mkdtempSync(join(tmpdir(), "frictcomp-page-"));
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox"] });

/** Opens the page; any network request or console output is a mistake. */
async function open(options = {}) {
  const context = await browser.newContext({ acceptDownloads: true, ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(20_000);
  page.wrong = [];
  page.on("request", (request) => {
    if (!/^(file|blob|data):/.test(request.url())) {
      page.wrong.push(`request ${request.url()}`);
    }
  });
  page.on("pageerror", (error) => page.wrong.push(error.message));
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) {
      page.wrong.push(message.text());
    }
  });
  page.on("dialog", (dialog) => {
    page.wrong.push(`dialog ${dialog.message()}`);
    void dialog.dismiss();
  });
  await page.goto(address);
  await page.waitForSelector("body.ready");
  return page;
}

async function close(page) {
  assert.deepEqual(page.wrong, []);
  await page.context().close();
}

/** Drops files or folders of the disk onto the page. */
async function drop(page, ...paths) {
  const client = await page.context().newCDPSession(page);
  const data = { items: [], files: paths, dragOperationsMask: 1 };
  for (const type of ["dragEnter", "dragOver", "drop"]) {
    await client.send("Input.dispatchDragEvent", { type, x: 300, y: 300, data });
  }
}

async function dropTexts(page, files) {
  const paths = Object.entries(files).map(([name, text]) => {
    const path = join(folder, name);
    mkdirSync(join(path, ".."), { recursive: true });
    writeFileSync(path, text);
    return path;
  });
  await drop(page, ...paths);
}

const run = (program, cwd) =>
  spawnSync(command, ["run", "--format", "ndjson", program], { cwd }).stdout.toString();

const rows = (page) => page.locator(".timeline tbody tr:not(.message):not(.edge)");

/** The states of the blocks that are shown, as words. */
const shownStates = (page) => rows(page).evaluateAll((all) => all.map((row) =>
  [...row.querySelectorAll("td.states .word")].map((word) => word.textContent)));

const look = async (page, name) => {
  if (pictures) {
    await page.screenshot({ path: join(pictures, `${name}.png`), fullPage: true });
  }
};

/** Words as the command prints them, whatever their layout. */
const bare = (text) => text.replace(/[\s`]/g, "").toLowerCase();

/** The verdict and the figures in a part of the page. */
async function told(page, id) {
  const [lead, figures] = await Promise.all(["lead", "figures"].map((part) =>
    page.locator(`#${id} .${part}`).textContent()));
  return bare(lead.replace(/\.$/, "") + figures);
}

/** Every part of the page that is shown at once. */
const TABS = ["timeline", "messages", "audit", "current", "contour", "circle", "machine"];

/** Shows a part and waits for its questions to the engine. */
async function showTab(page, tab) {
  await page.locator(`#tab-${tab}`).click();
  await page.waitForFunction(() => document.getElementById("working").hidden);
  if (["contour", "circle"].includes(tab)) {
    await page.locator(`#${tab} .figures`).waitFor({ timeout: 60_000 });
  }
  if (tab === "audit") {
    await page.locator("#audit table.programs").first().waitFor();
  }
}

/** The accessibility rules that the current view breaks, by axe-core. */
async function broken(page) {
  const { violations } = await page.evaluate(() => window.axe.run(document));
  return violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html).join(" ")}`);
}

/** Shows a file from the list at the side. */
async function openFile(page, path) {
  await page.locator(`#files button[title="${path}"]`).click();
  await page.getByRole("heading", { name: path, exact: true }).waitFor();
  await rows(page).first().waitFor();
}

/** Opens the example and shows the program of the README in it. */
async function example(page) {
  await page.getByRole("button", { name: "Show an example" }).click();
  await page.locator("#contour img").waitFor({ timeout: 60_000 });
  await openFile(page, "example/friction.nc");
}

const tests = {
  async "the example explains itself"() {
    const page = await open();
    await page.getByRole("heading", { name: "Drop an NC program here" }).waitFor();
    await page.getByText("Nothing leaves this computer").waitFor();
    await look(page, "welcome");
    await page.getByRole("button", { name: "Show an example" }).click();
    // R13.18: its first picture is a path.
    await page.locator("#contour img").waitFor({ timeout: 60_000 });
    await look(page, "example");
    await openFile(page, "example/friction.nc");
    const result = page.getByRole("status", { name: "Result" });
    assert.match(await result.textContent(), /X and Y are left off/);
    await close(page);
  },

  async "a dropped folder has the states of the command line"() {
    const page = await open();
    await drop(page, join(root, "programs/demo/order"), join(root, "programs/demo/five_axis"));
    await page.getByRole("button", { name: "order/probe.nc" }).first().click();
    await page.waitForFunction(() => document.getElementById("title").textContent === "order/probe.nc");
    await rows(page).first().waitFor();
    const lines = run("order/probe.nc", join(root, "programs/demo")).trim().split("\n");
    const records = lines.map((line) => JSON.parse(line));
    const wanted = records.filter(({ record }) => record === "block")
      .map(({ friction }) => Object.values(friction));
    assert.ok(wanted.length > 3);
    assert.deepEqual(await shownStates(page), wanted);
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("button", { name: "Download records" }).click(),
    ]);
    const downloaded = readFileSync(await download.path(), "utf8");
    assert.equal(downloaded, run("order/probe.nc", join(root, "programs/demo")));
    await close(page);
  },

  async "the report is that of the command line"() {
    const page = await open();
    await drop(page, join(root, "programs/demo/order"));
    await page.getByRole("tab", { name: /Audit/ }).waitFor();
    await page.getByRole("button", { name: "order/pocket.nc" }).first().click();
    await rows(page).first().waitFor();
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("button", { name: "Download report" }).click(),
    ]);
    assert.equal(download.suggestedFilename(), "pocket.nc.report.html");
    const report = join(folder, "r.html");
    spawnSync(command, ["run", "--html", report, "-q", "order/pocket.nc"],
      { cwd: join(root, "programs/demo") });
    assert.equal(readFileSync(await download.path(), "utf8"), readFileSync(report, "utf8"));
    await close(page);
  },

  async "an edit changes the timeline"() {
    const page = await open();
    await example(page);
    await rows(page).first().waitFor();
    await page.getByRole("button", { name: "Edit the program" }).click();
    const text = page.getByRole("textbox", { name: "Program text" });
    await page.waitForFunction(() => document.querySelector("textarea").value !== "");
    await text.fill((await text.inputValue()).replace(
      "N55 M30", "N50 X[COMP ON FRICT]\nN51 Y[COMP ON FRICT]\nN55 M30"));
    const result = page.getByRole("status", { name: "Result" });
    await result.getByText("Nothing to do: every axis is as at the start").waitFor();
    assert.equal(await rows(page).count(), 7);
    await page.getByText("edited here, the file is as it was").waitFor();
    await look(page, "edit");
    await text.fill("N10 Z[COMP ON FRICT]\nN20 X1\nM30\n");
    await result.getByText("Stopped by an error").waitFor();
    await page.getByRole("tab", { name: "Messages (1)" }).click();
    await page.locator("#panel-messages").getByText("error P-ERR-70495").waitFor();
    await page.getByRole("button", { name: /friction\.nc:1:5/ }).click();
    await page.locator(".timeline tr.selected").waitFor();
    await close(page);
  },

  async "what is changed is marked, found, saved and not lost unasked"() {
    // R13.12
    const page = await open();
    await example(page);
    await rows(page).first().waitFor();
    const leaves = () => page.evaluate(() =>
      window.dispatchEvent(new window.Event("beforeunload", { cancelable: true })));
    assert.equal(await leaves(), true, "nothing is lost yet");
    await page.getByRole("tab", { name: /Messages/ }).click();
    await page.getByRole("button", { name: /Apply: insert \w\[COMP ON FRICT\]/ }).first().click();
    await page.getByText("edited here, the file is as it was").waitFor();
    assert.equal(await leaves(), false, "the browser asks");
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("button", { name: "Download changed program" }).click(),
    ]);
    assert.equal(download.suggestedFilename(), "friction.nc");
    const saved = readFileSync(await download.path(), "utf8");
    const original = readFileSync(join(root, "programs/demo/friction.nc"), "utf8");
    assert.equal(saved.replace(/[XY]\[COMP ON FRICT\]\r?\n(?=N55)/, ""), original);
    assert.equal(await leaves(), true, "it is saved");
    await page.getByRole("tab", { name: "Timeline" }).click();
    await page.getByRole("searchbox", { name: "find" }).fill("x22");
    await page.getByRole("searchbox", { name: "find" }).press("Enter");
    await page.locator("#found").getByText(/^line \d+$/).waitFor();
    await page.locator(".timeline tr.selected").getByText("N35").waitFor();
    await dropTexts(page, { "other.nc": "N10 X1\nM30\n" });
    await page.getByRole("heading", { name: "other.nc" }).waitFor();
    assert.equal(await page.getByText("edited here, the file is as it was").isVisible(), false, "the mark is of one file");
    await close(page);
  },

  async "what was not dropped is named"() {
    const page = await open();
    await dropTexts(page, { "main.nc": "N10 L SUB.nc\nN20 X[COMP OFF FRICT]\nM30\n" });
    const result = page.getByRole("status", { name: "Result" });
    await result.getByText(/SUB\.nc.*Drop that file, too/).waitFor();
    assert.match(await result.textContent(), /No machine is described/);
    assert.doesNotMatch(await result.textContent(), /every axis is/);
    const missing = page.locator("#missing");
    assert.match(await missing.textContent(), /SUB\.nc/);
    // The file arrives, and then the start-up list without its axis lists.
    await dropTexts(page, { "SUB.nc": "X1\nM17\n" });
    await page.waitForFunction(() => !document.getElementById("missing").textContent.includes("SUB.nc"));
    assert.equal(await page.locator("#title").textContent(), "main.nc");
    await drop(page, join(root, "programs/demo/lists/hochlauf.lis"));
    await result.getByText(/not found: parameters that they would give/).waitFor();
    assert.match(await missing.textContent(), /axis_x\.lis/);
    await look(page, "missing");
    // Loose lists are found next to the start-up list.
    await drop(page, ...["axis_x", "axis_y", "axis_z", "channel_1", "comp_x", "comp_y"].map((name) =>
      join(root, `programs/demo/lists/${name}.lis`)));
    await page.waitForFunction(() => document.getElementById("missing").textContent === "");
    await page.getByRole("button", { name: /main\.nc/ }).click();
    await result.getByText("X is left off").waitFor();
    await close(page);
  },

  async "many programs are audited"() {
    const page = await open();
    const lists = ["frictcomp.toml", "lists"].map((name) => join(root, "programs/demo", name));
    const programs = {};
    for (let at = 0; at < 50; at += 1) {
      programs[`many/p${at}.nc`] = at % 10 === 3 ? "X[COMP OFF FRICT]\nM30\n" : "G1 X1 F100\nM30\n";
    }
    await dropTexts(page, {});
    for (const [name, text] of Object.entries(programs)) {
      mkdirSync(join(folder, "many"), { recursive: true });
      writeFileSync(join(folder, name), text);
    }
    await drop(page, ...lists, join(folder, "many"));
    await page.getByRole("tab", { name: "Audit (50)", selected: true }).waitFor();
    await page.getByText(/5 programs leave X off, 45 run with it off/).waitFor();
    assert.equal(await page.locator("#audit table.programs tbody tr").count(), 50);
    await look(page, "audit");
    await page.locator("#audit").getByRole("button", { name: "line 1" }).first().click();
    await page.locator(".timeline tr.selected").waitFor();
    await close(page);
  },

  async "nothing in a file runs"() {
    const page = await open();
    const evil = "<img src=x onerror=alert(1)><script>alert(2)<_script>";
    await dropTexts(page, {
      [`${evil}.nc`]: `%${evil}\nN10 X[COMP OFF FRICT] ; ${evil} </script><svg onload=alert(3)>\n`
        + `N20 L "${evil}"\nM30\n`,
      "frictcomp.toml": "[[axis]]\nname = \"X<b>\"\n",
    });
    await page.waitForSelector("#complaint:not([hidden])");
    await dropTexts(page, { "frictcomp.toml": `[[axis]]\nname = "X"\nfrict_comp = true\n# ${evil}\n` });
    await rows(page).first().waitFor();
    for (const tab of ["Messages", "Audit", "Current", "Contour", "Circle", "Machine", "Timeline"]) {
      await page.getByRole("tab", { name: new RegExp(tab) }).click();
      await page.waitForTimeout(300);
    }
    await page.waitForFunction(() => document.getElementById("working").hidden);
    const active = await page.evaluate(() =>
      document.querySelectorAll("img:not(.picture), #work script, [onerror], [onload], iframe").length);
    assert.equal(active, 0);
    // Even a page that was tricked into a request could not make it.
    const refused = await page.evaluate(() => fetch("https://example.org/").then(() => false, () => true));
    assert.ok(refused);
    page.wrong = page.wrong.filter((said) => !said.includes("example.org"));
    await close(page);
  },

  async "a contour is that of the command line"() {
    // R13.12
    const page = await open();
    const demo = join(root, "programs/demo");
    await drop(page, join(demo, "contour"));
    await rows(page).first().waitFor();
    await showTab(page, "contour");
    await page.locator("#panel-contour").getByLabel("axes start at").fill("X0, Y0, Z10");
    await page.getByRole("button", { name: "Drive", exact: true }).click();
    await page.locator("#contour img").waitFor();
    const wanted = spawnSync(command, ["contour", "contour/plate.nc", "--start", "X0,Y0,Z10"], { cwd: demo });
    assert.match(wanted.stdout.toString(), /largest deviation +38/);
    assert.equal(await told(page, "contour"), bare(wanted.stdout.toString()));
    await look(page, "contour");
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("button", { name: "Download contour report" }).click(),
    ]);
    assert.equal(download.suggestedFilename(), "plate.nc.contour.html");
    const report = join(folder, "contour.html");
    spawnSync(command, ["contour", "--html", report, "contour/plate.nc", "--start", "X0,Y0,Z10"], { cwd: demo });
    // The last bit of a sine is that of the system, and may move a curve by a tenth of a pixel.
    const written = (path) => readFileSync(path, "utf8").replaceAll(/ d="[^"]*"/g, "");
    assert.equal(written(await download.path()), written(report));
    await page.locator("#panel-contour").getByLabel("axes start at").fill("Q0");
    await page.getByRole("button", { name: "Drive", exact: true }).click();
    await page.getByRole("alert").getByText("no axis Q").waitFor();
    await close(page);
  },

  async "a value list is tuned with progress"() {
    // R13.12
    const page = await open();
    await example(page);
    await rows(page).first().waitFor();
    await showTab(page, "circle");
    await page.locator("#feeds").fill("fast");
    await page.getByRole("button", { name: "Tune", exact: true }).click();
    await page.getByRole("alert").getByText(/Give from 1 to 8 feeds/).waitFor();
    await page.locator("#feeds").fill("2000");
    await page.locator("#radius").fill("20");
    const before = Date.now();
    await page.getByRole("button", { name: "Tune", exact: true }).click();
    await page.locator("#progress").getByText(/tune: \[[#.]+\] \d+ %/).waitFor({ timeout: 60_000 });
    // The page responds in the meantime.
    await page.getByRole("searchbox", { name: "find" }).count();
    await page.locator("#tuned img").waitFor({ timeout: 300_000 });
    console.log(`      one feed tuned: ${((Date.now() - before) / 1000).toFixed(1)} s`);
    await look(page, "tuned");
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("button", { name: "Download value list" }).click(),
    ]);
    const list = join(folder, "tuned.lis");
    const wanted = spawnSync(command, ["tune", "--feeds", "2000", "--radii", "20", "--write-list", list]);
    assert.equal(await told(page, "tuned"), bare(wanted.stdout.toString()));
    assert.equal(readFileSync(await download.path(), "utf8"), readFileSync(list, "utf8"));
    await close(page);
  },

  async "codes are explained, parameters and curves are shown"() {
    // R13.12
    const page = await open();
    await example(page);
    await rows(page).first().waitFor();
    await showTab(page, "messages");
    await page.getByText("About FC401").first().click();
    const explained = spawnSync(command, ["explain", "FC401"]).stdout.toString().trim();
    await page.locator(".about .page").first().filter({ hasText: explained.split("\n")[0].replace(/^# /, "") }).waitFor();
    const shown = await page.locator(".about .page").first().textContent();
    assert.ok(!/[`#]/.test(shown), "its marks are rendered");
    await look(page, "explained");
    await showTab(page, "machine");
    await page.getByText(/^Axis X: \d+ parameters$/).click();
    const row = page.getByRole("row", { name: /P-AXIS-00522/ }).first();
    assert.match(await row.textContent(), /frict_comp/);
    await page.locator("#curves img").waitFor();
    await look(page, "parameters");
    await close(page);
  },

  async "what is no program is told apart"() {
    // R13.18
    const page = await open();
    mkdirSync(join(folder, "empty"), { recursive: true });
    await drop(page, join(folder, "empty"));
    await page.getByRole("alert").getByText("the folder is empty").waitFor();
    await drop(page, join(root, "programs/demo/recordings/friction_x.csv"));
    await page.locator("#channels img").waitFor();
    assert.match(await page.locator("#channels .figures").textContent(), /ActTorque/);
    await look(page, "recording");
    await dropTexts(page, { "foreign.h": "0 BEGIN PGM A MM\n", "big.nc": `${"X1\n".repeat(12344)}X[COMP OFF FRIKT]\nM30\n` });
    await page.getByText("1 foreign program").waitFor();
    await page.getByRole("tab", { name: /Messages/ }).click();
    await page.getByRole("button", { name: /big\.nc:12345:\d+/ }).waitFor();
    await page.locator("#tab-contour").click();
    await page.locator("#contour-start").fill("X0, there");
    await page.getByRole("button", { name: "Drive", exact: true }).click();
    await page.locator("#contour-form .field-error").getByText("Give positions").waitFor();
    await close(page);
  },

  async "a recording is read as on the command line"() {
    // R13.18
    const page = await open();
    const demo = join(root, "programs/demo");
    const printed = (folder, ...args) =>
      bare(spawnSync(command, args, { cwd: join(demo, folder) }).stdout.toString());
    await drop(page, join(demo, "recorded/learning/round-1/F2000-1.csv"));
    await page.locator("#recorded-circle img").waitFor();
    const wanted = (...args) => printed("recorded/learning/round-1", ...args);
    assert.equal(await told(page, "channels"), wanted("trace", "F2000-1.csv"));
    assert.equal(await told(page, "recorded-circle"), wanted("circle", "F2000-1.csv"));
    await page.getByLabel("commanded radius").fill("20");
    await page.getByRole("button", { name: "Evaluate the circle" }).click();
    await page.locator("#recorded-circle").getByText("mean radial deviation").waitFor();
    assert.equal(await told(page, "recorded-circle"), wanted("circle", "F2000-1.csv", "--radius", "20"));
    await look(page, "recorded-circle");
    await page.locator("#no-value-list").waitFor();
    await drop(page, join(demo, "recordings/friction_x.csv"), join(demo, "lists/comp_x.lis"));
    await page.locator("#verified .lead").waitFor();
    assert.equal(await page.locator("#recorded-circle").textContent(), "");
    const verified = printed("lists", "verify", "../recordings/friction_x.csv", "--value-list", "comp_x.lis");
    assert.equal(await told(page, "verified"), verified);
    await page.locator("#velocity").selectOption("SetVelo");
    await page.locator("#torque").selectOption("ActTorque");
    await page.getByRole("button", { name: "Verify" }).click();
    await page.locator("#verified .lead").waitFor();
    assert.equal(await told(page, "verified"), verified);
    await look(page, "verified");
    await dropTexts(page, { "a.svdx": "PK" });
    await page.getByRole("alert").getByText("TC3ScopeExportTool").waitFor();
    await close(page);
  },

  async "every view is accessible by the rules of axe"() {
    // R13.12
    const axe = readFileSync(new URL("../node_modules/axe-core/axe.min.js", import.meta.url), "utf8");
    const ways = {
      light: { viewport: { width: 1280, height: 860 } },
      dark: { viewport: { width: 1280, height: 860 }, colorScheme: "dark" },
      phone: { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true },
    };
    for (const [name, options] of Object.entries(ways)) {
      const page = await open({ ...options, bypassCSP: true });
      await page.evaluate(axe);
      assert.deepEqual(await broken(page), [], `${name}, before anything is dropped`);
      await example(page);
      await rows(page).first().waitFor();
      for (const tab of TABS) {
        await showTab(page, tab);
        for (const summary of await page.locator(`#panel-${tab} summary`).all()) {
          await summary.click();
        }
        assert.deepEqual(await broken(page), [], `${name}, ${tab}`);
      }
      await showTab(page, "timeline");
      await page.getByRole("button", { name: "Edit the program" }).click();
      await page.waitForFunction(() => document.querySelector("textarea").value !== "");
      await page.getByRole("textbox", { name: "Program text" }).fill("N10 Z[COMP ON FRICT]\nN20 X1\nM30\n");
      await page.getByText("edited here, the file is as it was").waitFor();
      assert.deepEqual(await broken(page), [], `${name}, an edited program with an error`);
      await close(page);
    }
  },

  async "a million blocks run with progress and can be cancelled"() {
    const page = await open();
    const lines = Array.from({ length: 1_000_000 }, (_, at) => `N${at} G1 X${at % 997} Y${at % 13}.5`);
    lines[600_000] = "N5 X[COMP OFF FRICT]";
    writeFileSync(join(folder, "million.nc"), lines.join("\n"));
    await drop(page, join(folder, "million.nc"), join(root, "programs/demo/frictcomp.toml"),
      join(root, "programs/demo/lists"));
    await page.locator("#progress").getByText(/blocks/).waitFor({ timeout: 60_000 });
    await page.waitForFunction(() => document.getElementById("working").hidden, null, { timeout: 60_000 });
    await page.getByText(/1.000.000 executed blocks/).waitFor();
    const seconds = await page.evaluate(() => new Promise((resolve) => {
      const before = performance.now();
      const bars = document.getElementById("bars");
      new window.MutationObserver(() => { resolve((performance.now() - before) / 1000); })
        .observe(bars, { childList: true });
      document.getElementById("keep-going").click();
    }));
    console.log(`      1 million blocks: ${seconds.toFixed(2)} s`);
    await page.getByRole("button", { name: "Next change" }).click();
    await page.locator(".timeline tr.selected").getByText("X[COMP OFF FRICT]").waitFor();
    await look(page, "million");
    // The last line is reached by scrolling, though the list is higher than an element can be.
    await page.locator(".scroll").evaluate((box) => { box.scrollTop = box.scrollHeight; });
    await page.locator(".timeline").getByText("N999999 ").waitFor();
    // A loop that takes long.
    await dropTexts(page, { "long.nc": "$FOR P1 = 1, 90000000, 1\nX1\n$ENDFOR\nM30\n" });
    await page.getByRole("button", { name: "Cancel" }).click();
    await page.getByText("Cancelled").waitFor();
    await page.getByRole("button", { name: "million.nc" }).click();
    await page.getByText(/1.000.000 executed blocks/).waitFor({ timeout: 60_000 });
    await close(page);
  },

  async "everything is reached by keyboard and has a name"() {
    const page = await open();
    const reached = [];
    for (let at = 0; at < 5; at += 1) {
      await page.keyboard.press("Tab");
      reached.push(await page.evaluate(() => document.activeElement.textContent.trim()));
    }
    assert.deepEqual(reached.slice(0, 4),
      ["Skip to the content", "Choose files…", "Choose a folder…", "Show an example"]);
    await page.getByRole("button", { name: "Show an example" }).focus();
    await page.keyboard.press("Enter");
    await page.locator("#contour img").waitFor({ timeout: 60_000 });
    await openFile(page, "example/friction.nc");
    await page.getByRole("tab", { name: "Timeline" }).focus();
    await page.keyboard.press("ArrowRight");
    await page.getByRole("tabpanel", { name: /Messages/ }).waitFor();
    await page.keyboard.press("Home");
    await page.getByRole("button", { name: "Next change" }).focus();
    await page.keyboard.press("Space");
    await page.locator(".timeline tr.selected").getByText("N25").waitFor();
    assert.equal(await page.getByRole("img", { name: "X: active, inactive from block 4" }).count(), 1);
    const nameless = await page.evaluate(() => {
      const all = document.querySelectorAll("button, input:not([hidden]), select, textarea, [role=region]");
      return [...all].filter((one) => !(one.textContent.trim() || one.ariaLabel || one.labels?.length))
        .map((one) => one.outerHTML);
    });
    assert.deepEqual(nameless, []);
    assert.equal(await page.locator("html").getAttribute("lang"), "en");
    await close(page);
  },

  async "it fits dark, phone, magnified and paper"() {
    const ways = {
      light: { viewport: { width: 1280, height: 860 } },
      dark: { viewport: { width: 1280, height: 860 }, colorScheme: "dark" },
      phone: { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true },
      magnified: { viewport: { width: 640, height: 400 }, deviceScaleFactor: 2 },
    };
    for (const [name, options] of Object.entries(ways)) {
      const page = await open(options);
      await example(page);
      await rows(page).first().waitFor();
      for (const tab of TABS) {
        await showTab(page, tab);
        await look(page, `${name}-${tab}`);
        const wider = await page.evaluate(() =>
          document.documentElement.scrollWidth - document.documentElement.clientWidth);
        assert.ok(wider <= 0, `${name} ${tab}: ${wider} px too wide`);
        const cut = await page.locator(`#panel-${tab} .wide`).evaluateAll((all) =>
          all.filter((one) => one.scrollWidth > one.clientWidth).map((one) => one.ariaLabel));
        assert.deepEqual(cut, [], `${name} ${tab}: tables that are cut`);
      }
      await page.locator("#tab-timeline").click();
      if (name === "dark") {
        const paper = await page.evaluate(() => getComputedStyle(document.documentElement).backgroundColor);
        assert.equal(paper, "rgb(20, 24, 29)");
      }
      await page.emulateMedia({ media: "print" });
      assert.ok(!await page.locator("#side").isVisible() && await rows(page).last().isVisible());
      await look(page, `${name}-print`);
      await close(page);
    }
  },
};

if (pictures) {
  mkdirSync(pictures, { recursive: true });
}
let failed = 0;
const only = process.env.ONLY;
for (const [name, test] of Object.entries(tests)) {
  if (only && !name.includes(only)) {
    continue;
  }
  const before = Date.now();
  try {
    await test();
    console.log(`ok    ${name} (${((Date.now() - before) / 1000).toFixed(1)} s)`);
  } catch (error) {
    failed += 1;
    console.error(`FAIL  ${name}`, error);
  }
}
await browser.close();
rmSync(folder, { recursive: true });
process.exit(failed === 0 ? 0 : 1);
