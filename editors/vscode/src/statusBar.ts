/** The states at the cursor, in the status bar. */
import * as vscode from "vscode";
import { isProgram } from "./programs";
import type { States } from "./protocol";
import { statusText, statusTooltip } from "./statusText";

/** Rest of the cursor before the server is asked, in ms. */
const REST = 80;

export type AskStates = (uri: vscode.Uri, position: vscode.Position) => Promise<States | undefined>;

export class StatusBar implements vscode.Disposable {
  private readonly item = vscode.window.createStatusBarItem("frictcomp.states", vscode.StatusBarAlignment.Left);
  private timer: NodeJS.Timeout | undefined;
  private asked = 0;
  private readonly subscriptions: vscode.Disposable[];

  constructor(private readonly ask: AskStates) {
    this.item.name = "Friction compensation";
    this.item.command = "frictcomp.timeline.focus";
    this.subscriptions = [
      vscode.window.onDidChangeActiveTextEditor(() => {
        this.refresh();
      }),
      vscode.window.onDidChangeTextEditorSelection(() => {
        this.refresh();
      }),
      vscode.workspace.onDidChangeTextDocument(() => {
        this.refresh();
      }),
    ];
  }

  refresh(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      void this.show();
    }, REST);
  }

  dispose(): void {
    clearTimeout(this.timer);
    this.item.dispose();
    for (const subscription of this.subscriptions) {
      subscription.dispose();
    }
  }

  private async show(): Promise<void> {
    const asked = ++this.asked;
    const editor = vscode.window.activeTextEditor;
    if (!editor || !isProgram(editor.document)) {
      this.item.hide();
      return;
    }
    const states = await this.ask(editor.document.uri, editor.selection.active);
    if (asked !== this.asked) {
      return;
    }
    if (states) {
      this.item.text = `COMP ${statusText(states.axes)}`;
      this.item.tooltip = statusTooltip(states.axes);
      this.item.show();
    } else {
      this.item.hide();
    }
  }
}
