/** A report of frictcomp as the page of a webview. */

const POLICY = `<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; img-src data:;">`;
const DARK_ONLY = /@media\s*\(prefers-color-scheme:\s*dark\)/g;

/**
 * The report in the colours of the editor's theme, which a webview does not indicate through
 * `prefers-color-scheme`; without scripts and without the network.
 */
export function reportPage(html: string, dark: boolean): string {
  return html
    .replace(DARK_ONLY, dark ? "@media all" : "@media not all")
    .replace(/<head>/i, (head) => `${head}\n${POLICY}`)
    .replace(/<meta name="color-scheme"[^>]*>/i, `<meta name="color-scheme" content="${dark ? "dark" : "light"}"/>`);
}
