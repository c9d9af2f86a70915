/** The side view with the compensation of each axis over the lines of the program in the editor. */
import * as vscode from "vscode";
import type { Timeline } from "../protocol";
import { pageShell } from "../pageShell";
import { isProgram } from "../programs";
import type { FromPage, ToPage } from "./messages";

/** Delay of the view after the last change before it asks again, in ms. */
const SETTLE = 250;

export type AskTimeline = (uri: vscode.Uri) => Promise<Timeline | undefined>;

export class TimelineView implements vscode.WebviewViewProvider, vscode.Disposable {
  private view: vscode.WebviewView | undefined;
  private program: vscode.TextEditor | undefined;
  private asked = 0;
  private timer: NodeJS.Timeout | undefined;
  private readonly subscriptions: vscode.Disposable[];

  constructor(
    private readonly extension: vscode.Uri,
    private readonly ask: AskTimeline,
  ) {
    this.subscriptions = [
      vscode.window.registerWebviewViewProvider("frictcomp.timeline", this),
      vscode.window.onDidChangeActiveTextEditor(() => {
        this.refresh();
      }),
      vscode.workspace.onDidChangeTextDocument(({ document }) => {
        if (document === this.program?.document) {
          this.refreshSoon();
        }
      }),
      vscode.window.onDidChangeTextEditorSelection(({ textEditor }) => {
        if (textEditor === this.program) {
          this.sendCursor();
        }
      }),
    ];
  }

  resolveWebviewView(view: vscode.WebviewView): void {
    this.view = view;
    view.webview.options = { enableScripts: true, localResourceRoots: [this.extension] };
    view.webview.onDidReceiveMessage((message: FromPage) => {
      this.receive(message);
    });
    view.onDidChangeVisibility(() => {
      if (view.visible) {
        this.refresh();
      }
    });
    view.onDidDispose(() => {
      this.view = undefined;
    });
    view.webview.html = pageShell(view.webview, this.extension, {
      title: "Compensation",
      styles: ["dist/picture.css", "media/timeline.css"],
      script: "dist/timeline.js",
    });
  }

  /** Asks for the timeline of the program in the active editor, and shows it. */
  refresh(): void {
    const editor = vscode.window.activeTextEditor;
    if (editor && isProgram(editor.document)) {
      this.program = editor;
    } else if (this.program && !vscode.window.visibleTextEditors.includes(this.program)) {
      this.program = undefined;
    }
    void this.show();
  }

  dispose(): void {
    clearTimeout(this.timer);
    for (const subscription of this.subscriptions) {
      subscription.dispose();
    }
  }

  private refreshSoon(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      this.refresh();
    }, SETTLE);
  }

  private async show(): Promise<void> {
    if (!this.view?.visible) {
      return;
    }
    const program = this.program;
    if (!program) {
      this.send({ kind: "empty", reason: "Open an NC program to see the states of its axes." });
      return;
    }
    const asked = ++this.asked;
    const timeline = await this.ask(program.document.uri);
    if (asked !== this.asked) {
      return;
    }
    if (timeline) {
      const name = vscode.workspace.asRelativePath(program.document.uri);
      this.send({ kind: "timeline", name, timeline });
      this.sendCursor();
    } else {
      this.send({ kind: "empty", reason: "The states of this program are not known yet." });
    }
  }

  private receive(message: FromPage): void {
    switch (message.kind) {
      case "ready":
        this.refresh();
        break;
      case "goto":
        void this.goTo(message.line);
        break;
    }
  }

  private async goTo(line: number): Promise<void> {
    if (!this.program) {
      return;
    }
    const { document, viewColumn } = this.program;
    const start = new vscode.Position(Math.min(line, document.lineCount - 1), 0);
    await vscode.window.showTextDocument(document, {
      selection: new vscode.Range(start, start),
      ...(viewColumn === undefined ? {} : { viewColumn }),
    });
  }

  private sendCursor(): void {
    if (this.program) {
      this.send({ kind: "cursor", line: this.program.selection.active.line });
    }
  }

  private send(message: ToPage): void {
    void this.view?.webview.postMessage(message);
  }
}
