// Texts with marks as elements: what stands in backquotes as code, and the pages about codes.

import { h } from "./dom";

/** A sentence whose words in backquotes are code. */
export function withCode(text: string): (HTMLElement | string)[] {
  return text.split("`").map((piece, at) => (at % 2 === 0 ? piece : h("code", {}, piece)));
}

/** A page of headings, paragraphs, lists, tables and examples. */
export function page(text: string): HTMLElement[] {
  const blocks: HTMLElement[] = [];
  const lines = text.trim().split("\n");
  const taken = (is: (line: string) => boolean): string[] => {
    const end = lines.findIndex((line) => !is(line));
    return lines.splice(0, end < 0 ? lines.length : end);
  };
  while (lines.length > 0) {
    const first = lines[0] ?? "";
    if (first.trim() === "") {
      lines.shift();
    } else if (first.startsWith("```")) {
      lines.shift();
      blocks.push(h("pre", {}, taken((line) => !line.startsWith("```")).join("\n")));
      lines.shift();
    } else if (first.startsWith("#")) {
      lines.shift();
      blocks.push(h("h3", {}, ...withCode(first.replace(/^#+ /, ""))));
    } else if (first.startsWith("    ")) {
      blocks.push(h("pre", {}, taken((line) => line.startsWith("    ")).map((line) => line.slice(4)).join("\n")));
    } else if (first.startsWith("|")) {
      const rows = taken((line) => line.startsWith("|")).filter((line) => !/^[|\s:-]+$/.test(line));
      blocks.push(h("table", {}, ...rows.map((row) =>
        h("tr", {}, ...row.split("|").slice(1, -1).map((cell) => h("td", {}, ...withCode(cell.trim())))))));
    } else if (first.startsWith("- ")) {
      const all = taken((line) => line.startsWith("- ") || line.startsWith("  ")).join("\n");
      blocks.push(h("ul", {}, ...all.split(/^- /m).slice(1).map((item) =>
        h("li", {}, ...withCode(item.trim().replace(/\s+/g, " "))))));
    } else {
      const all = taken((line) => line.trim() !== "" && !/^(```|#|\||- )/.test(line));
      blocks.push(h("p", {}, ...withCode(all.join(" "))));
    }
  }
  return blocks;
}
