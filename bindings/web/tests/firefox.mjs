// The page in a real Firefox, opened as a file.
//
//     node tests/firefox.mjs PAGE.html COMMAND ROOT FIREFOX

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import puppeteer from "puppeteer-core";

const [html, command, root, executablePath] = process.argv.slice(2);
const address = pathToFileURL(resolve(html)).href;
const browser = await puppeteer.launch({ browser: "firefox", executablePath, headless: true });

/** Opens the page; any network request or console output is a mistake. */
async function open() {
  const page = await browser.newPage();
  page.setDefaultTimeout(60_000);
  page.wrong = [];
  page.on("pageerror", (error) => page.wrong.push(error.message));
  page.on("console", (message) => {
    if (["error", "warn"].includes(message.type())) {
      page.wrong.push(message.text());
    }
  });
  page.on("request", (request) => {
    if (!/^(file|blob|data):/.test(request.url())) {
      page.wrong.push(`request ${request.url()}`);
    }
  });
  await page.goto(address);
  await page.waitForSelector("body.ready");
  return page;
}

async function close(page) {
  assert.deepEqual(page.wrong, []);
  await page.close();
}

const rows = ".timeline tbody tr:not(.message):not(.edge)";
const text = (page, selector) => page.$eval(selector, (element) => element.textContent);

const tests = {
  async "chosen files have the states of the command line"() {
    const page = await open();
    const input = await page.$("#file-input");
    const demo = join(root, "programs/demo");
    await input.uploadFile(join(demo, "order/probe.nc"), join(demo, "order/frictcomp.toml"));
    await page.waitForSelector(rows);
    const told = spawnSync(command, ["run", "--format", "ndjson", "probe.nc"], { cwd: join(demo, "order") });
    const records = told.stdout.toString().trim().split("\n").map((line) => JSON.parse(line));
    const wanted = records.filter(({ record }) => record === "block")
      .map(({ friction }) => Object.values(friction));
    assert.ok(wanted.length > 3);
    assert.deepEqual(await page.$$eval(rows, (all) => all.map((row) =>
      [...row.querySelectorAll("td.states .word")].map((word) => word.textContent))), wanted);
    await close(page);
  },

  async "every view shows what it asks for"() {
    const page = await open();
    await page.click("#demo");
    await page.waitForSelector("#contour img", { timeout: 60_000 });
    await page.click("#files button[title='example/friction.nc']");
    await page.waitForFunction(() => document.getElementById("title").textContent === "example/friction.nc");
    await page.waitForSelector(rows);
    const wanted = {
      messages: "#panel-messages .messages li",
      audit: "#audit table.programs",
      current: "#current .notes, #current img",
      contour: "#contour .figures",
      circle: "#circle img",
      machine: "#curves img",
    };
    for (const [tab, selector] of Object.entries(wanted)) {
      await page.click(`#tab-${tab}`);
      await page.waitForSelector(selector);
    }
    assert.equal(await page.$eval("#complaint", (box) => box.hidden), true);
    assert.match(await text(page, "#circle .figures"), /F_max|glitch/);
    // A picture that cannot be shown has no width.
    await page.waitForFunction(() => document.querySelector("#curves img").naturalWidth > 0);
    await close(page);
  },

  async "an edit changes the result"() {
    const page = await open();
    await page.click("#demo");
    await page.waitForSelector("#contour img", { timeout: 60_000 });
    await page.click("#files button[title='example/friction.nc']");
    await page.waitForFunction(() => document.getElementById("title").textContent === "example/friction.nc");
    await page.waitForSelector(rows);
    assert.match(await text(page, "#verdict"), /X and Y are left off/);
    await page.click("#edit");
    await page.waitForFunction(() => document.querySelector("textarea").value !== "");
    await page.$eval("textarea", (area) => {
      area.value = area.value.replace("N55 M30", "N50 X[COMP ON FRICT]\nN51 Y[COMP ON FRICT]\nN55 M30");
      area.dispatchEvent(new window.Event("input", { bubbles: true }));
    });
    await page.waitForFunction(() =>
      document.getElementById("verdict").textContent.includes("every axis is as at the start"));
    assert.equal(await page.$eval("#edited", (mark) => mark.hidden), false);
    await close(page);
  },
};

let failed = 0;
for (const [name, test] of Object.entries(tests)) {
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
process.exit(failed === 0 ? 0 : 1);
