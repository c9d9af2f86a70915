/** The contour of the program, next to the editor: it follows the cursor, and leads to blocks. */
import * as path from "node:path";
import * as vscode from "vscode";
import { pageShell } from "../pageShell";
import { isProgram } from "../programs";
import type { Contour } from "../protocol";
import type { FromPage, ToPage } from "./messages";

/** Delay of the panel after the last change before it asks again, in ms. */
const SETTLE = 400;

/** A contour, or why there is none; nothing if it is no longer wanted. */
export type ContourAnswer = { contour: Contour } | { reason: string } | undefined;
export type AskContour = (uri: vscode.Uri, stop: vscode.CancellationToken) => Promise<ContourAnswer>;

export class ContourPanel implements vscode.Disposable {
  private panel: vscode.WebviewPanel | undefined;
  private program: vscode.Uri | undefined;
  /** The programs whose blocks are in the picture. */
  private files: string[] = [];
  private stop = new vscode.CancellationTokenSource();
  private timer: NodeJS.Timeout | undefined;
  private readonly subscriptions: vscode.Disposable[];

  constructor(
    private readonly extension: vscode.Uri,
    private readonly ask: AskContour,
  ) {
    this.subscriptions = [
      vscode.window.onDidChangeActiveTextEditor((editor) => {
        if (editor && this.panel && isProgram(editor.document)) {
          this.meet(editor);
        }
      }),
      vscode.workspace.onDidChangeTextDocument(({ document }) => {
        if (this.shows(document.uri)) {
          this.refreshSoon();
        }
      }),
      // Lists and the configuration count as they are saved.
      vscode.workspace.onDidSaveTextDocument((document) => {
        if (!isProgram(document)) {
          this.refreshSoon();
        }
      }),
      vscode.window.onDidChangeTextEditorSelection(({ textEditor }) => {
        this.sendCursor(textEditor);
      }),
    ];
  }

  /** Shows the contour of a program next to its text. */
  open(program: vscode.Uri): void {
    this.program = program;
    if (this.panel) {
      this.panel.reveal(undefined, true);
      this.refresh();
    } else {
      this.panel = this.create();
    }
  }

  /** Drives the program again. */
  refresh(): void {
    clearTimeout(this.timer);
    void this.show();
  }

  dispose(): void {
    clearTimeout(this.timer);
    this.stop.cancel();
    this.panel?.dispose();
    for (const subscription of this.subscriptions) {
      subscription.dispose();
    }
  }

  private create(): vscode.WebviewPanel {
    const where = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
    const panel = vscode.window.createWebviewPanel("frictcomp.contour", "Contour", where, {
      enableScripts: true,
      localResourceRoots: [this.extension],
    });
    panel.webview.onDidReceiveMessage((message: FromPage) => {
      if (message.kind === "ready") {
        this.refresh();
      } else {
        void this.goTo(message.file, message.line);
      }
    });
    panel.onDidDispose(() => {
      this.stop.cancel();
      this.panel = undefined;
    });
    panel.webview.html = pageShell(panel.webview, this.extension, {
      title: "Contour",
      styles: ["dist/picture.css", "media/contour.css"],
      script: "dist/contour.js",
    });
    return panel;
  }

  /** Another program became active: if the picture contains it, its cursor is followed. */
  private meet(editor: vscode.TextEditor): void {
    if (this.shows(editor.document.uri)) {
      this.sendCursor(editor);
    } else {
      this.program = editor.document.uri;
      this.refresh();
    }
  }

  private shows(uri: vscode.Uri): boolean {
    const name = uri.toString();
    return name === this.program?.toString() || this.files.includes(name);
  }

  private refreshSoon(): void {
    if (this.panel) {
      clearTimeout(this.timer);
      this.timer = setTimeout(() => {
        this.refresh();
      }, SETTLE);
    }
  }

  private async show(): Promise<void> {
    const program = this.program;
    if (!this.panel?.visible || !program) {
      return;
    }
    this.stop.cancel();
    const stop = (this.stop = new vscode.CancellationTokenSource());
    const name = path.basename(program.path);
    this.panel.title = `Contour of ${name}`;
    this.send({ kind: "driving", name });
    const answer = await this.ask(program, stop.token);
    if (stop.token.isCancellationRequested || !answer) {
      return;
    }
    if ("reason" in answer) {
      this.files = [];
      this.send({ kind: "refused", name, reason: answer.reason });
      return;
    }
    const { contour } = answer;
    this.files = contour.files.map((file) => vscode.Uri.parse(file).toString());
    this.send({ kind: "contour", name, contour });
    const editor = vscode.window.activeTextEditor;
    if (editor) {
      this.sendCursor(editor);
    }
  }

  private async goTo(file: number, line: number): Promise<void> {
    const name = this.files[file];
    if (name === undefined) {
      return;
    }
    const open = vscode.window.visibleTextEditors.find((editor) => editor.document.uri.toString() === name);
    const document = open?.document ?? (await vscode.workspace.openTextDocument(vscode.Uri.parse(name)));
    const start = new vscode.Position(Math.min(line, document.lineCount - 1), 0);
    await vscode.window.showTextDocument(document, {
      selection: new vscode.Range(start, start),
      viewColumn: open?.viewColumn ?? vscode.ViewColumn.One,
    });
  }

  private sendCursor(editor: vscode.TextEditor): void {
    const file = this.files.indexOf(editor.document.uri.toString());
    if (file >= 0) {
      this.send({ kind: "cursor", file, line: editor.selection.active.line });
    }
  }

  private send(message: ToPage): void {
    void this.panel?.webview.postMessage(message);
  }
}
