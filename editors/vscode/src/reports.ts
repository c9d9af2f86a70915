/** Reports of frictcomp shown inside the editor. */
import { execFile } from "node:child_process";
import * as fs from "node:fs/promises";
import * as os from "node:os";
import * as path from "node:path";
import { promisify } from "node:util";
import * as vscode from "vscode";
import { reportPage } from "./reportPage";

const run = promisify(execFile);
/** More than the longest report on a terminal; the view comes from the file. */
const MOST_OUTPUT = 64 * 1024 * 1024;

/** The exit statuses of frictcomp that come with a report: nothing found, something found. */
const WITH_REPORT = [0, 1];

/** One panel for each title; a repeated report replaces it. */
export class Reports implements vscode.Disposable {
  private readonly panels = new Map<string, { panel: vscode.WebviewPanel; html: string }>();
  private readonly themes = vscode.window.onDidChangeActiveColorTheme(() => {
    for (const { panel, html } of this.panels.values()) {
      panel.webview.html = reportPage(html, isDark());
    }
  });

  show(title: string, html: string): void {
    const known = this.panels.get(title);
    const panel = known?.panel ?? this.open(title);
    this.panels.set(title, { panel, html });
    panel.webview.html = reportPage(html, isDark());
    panel.reveal(undefined, true);
  }

  /** Runs frictcomp with `--html` into a temporary folder, and shows the report. */
  async showRun(title: string, binary: string, args: readonly string[], cwd: string | undefined): Promise<void> {
    const folder = await fs.mkdtemp(path.join(os.tmpdir(), "frictcomp-"));
    try {
      const report = path.join(folder, "report.html");
      const failure = await vscode.window.withProgress(
        { location: vscode.ProgressLocation.Notification, title: `frictcomp: ${title}`, cancellable: true },
        async (_, token) => {
          const stop = new AbortController();
          token.onCancellationRequested(() => {
            stop.abort();
          });
          return finished(run(binary, [...args, "--html", report], {
            maxBuffer: MOST_OUTPUT,
            signal: stop.signal,
            ...(cwd === undefined ? {} : { cwd }),
          }));
        },
      );
      if (failure === undefined) {
        this.show(title, await fs.readFile(report, "utf8"));
      } else if (failure !== "") {
        void vscode.window.showErrorMessage(`frictcomp: ${failure}`);
      }
    } finally {
      await fs.rm(folder, { recursive: true, force: true });
    }
  }

  dispose(): void {
    this.themes.dispose();
    for (const { panel } of this.panels.values()) {
      panel.dispose();
    }
  }

  private open(title: string): vscode.WebviewPanel {
    const panel = vscode.window.createWebviewPanel("frictcomp.report", title, vscode.ViewColumn.Beside, {
      enableFindWidget: true,
    });
    panel.onDidDispose(() => this.panels.delete(title));
    return panel;
  }
}

/** Returns what prevented a run from writing its report, `""` if the user stopped it, otherwise `undefined`. */
async function finished(running: Promise<unknown>): Promise<string | undefined> {
  try {
    await running;
    return undefined;
  } catch (error) {
    const failed = error as { name?: string; code?: unknown; stderr?: string; message?: string };
    if (failed.name === "AbortError") {
      return "";
    }
    if (typeof failed.code === "number" && WITH_REPORT.includes(failed.code)) {
      return undefined;
    }
    return failed.stderr?.trim() ?? failed.message ?? String(error);
  }
}

function isDark(): boolean {
  const { kind } = vscode.window.activeColorTheme;
  return kind === vscode.ColorThemeKind.Dark || kind === vscode.ColorThemeKind.HighContrast;
}
