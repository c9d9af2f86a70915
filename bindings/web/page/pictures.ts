// Pictures of the engine. They are shown as images, in which nothing can become active.

import { type Child, fill, h } from "./dom";

/** The object URLs of the pictures on display, to be released. */
const shown = new WeakMap<Element, string>();

/** Shows a picture in place of the current one, with its verdict above and its notes below. */
export function picture(
  root: HTMLElement, svg: string | null, told: string, above: Child[] = [], below: Child[] = [],
): void {
  const before = shown.get(root);
  if (before !== undefined) {
    URL.revokeObjectURL(before);
    shown.delete(root);
  }
  if (svg === null) {
    fill(root, ...above, ...below);
    return;
  }
  const address = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
  shown.set(root, address);
  fill(root, ...above, h("img", { class: "picture", src: address, alt: told }), ...below);
}

/** Offers a file to the user. */
export function download(name: string, bytes: Uint8Array<ArrayBuffer>, type: string): void {
  const address = URL.createObjectURL(new Blob([bytes], { type }));
  const link = h("a", { href: address, download: name });
  link.click();
  window.setTimeout(() => { URL.revokeObjectURL(address); }, 10_000);
}

/** The name of a separate file that belongs to a program. */
export function besides(program: string, ending: string): string {
  const name = program.split("/").pop() ?? "program";
  return `${name.replace(/[^\p{L}\p{N}._-]+/gu, "_")}${ending}`;
}
