import { expect, test } from "vitest";
import { reportPage } from "../../src/reportPage";

const REPORT = `<html><head><meta name="color-scheme" content="light dark"/>
<style>@media (prefers-color-scheme: dark) {a{}} @media (prefers-color-scheme:dark){b{}}</style></head></html>`;

test("a report takes the theme of the editor", () => {
  const dark = reportPage(REPORT, true);
  expect(dark).toContain("@media all {a{}} @media all{b{}}");
  expect(dark).toContain('<meta name="color-scheme" content="dark"/>');
  const light = reportPage(REPORT, false);
  expect(light).toContain("@media not all {a{}} @media not all{b{}}");
});

test("a report loads nothing and runs nothing", () => {
  expect(reportPage(REPORT, false)).toContain("default-src 'none'; style-src 'unsafe-inline'; img-src data:;");
});
