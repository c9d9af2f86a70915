import * as vscode from "vscode";

/** Files of a page, as paths within the extension. */
export interface PageFiles {
  title: string;
  styles: string[];
  script: string;
}

/** The page of a webview: styles and one script of the extension, and nothing from elsewhere. */
export function pageShell(webview: vscode.Webview, extension: vscode.Uri, files: PageFiles): string {
  const address = (path: string): string =>
    webview.asWebviewUri(vscode.Uri.joinPath(extension, ...path.split("/"))).toString();
  const styles = files.styles.map((path) => `<link rel="stylesheet" href="${address(path)}">`);
  return `<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src ${webview.cspSource}; script-src ${webview.cspSource};">
${styles.join("\n")}
<title>${files.title}</title>
</head>
<body>
<script src="${address(files.script)}"></script>
</body>
</html>`;
}
