/** frictcomp in VS Code: the language server, the states in the status bar, the timeline, reports. */
import { constants, accessSync } from "node:fs";
import * as path from "node:path";
import * as vscode from "vscode";
import { findBinary, type Found } from "./binary";
import { registerDebugger } from "./debug";
import { ownLanguage, PROGRAM_LANGUAGES } from "./languages";
import { Reports } from "./reports";
import { Server } from "./server";
import { StatusBar } from "./statusBar";
import { TimelineView } from "./view/provider";

export async function activate(context: vscode.ExtensionContext): Promise<void> {
  const reports = new Reports();
  const server = new Server(context.extensionUri, (title, html) => {
    reports.show(title, html);
  });
  const status = new StatusBar((uri, position) => server.states(uri, position));
  const view = new TimelineView(context.extensionUri, (uri) => server.timeline(uri));
  const start = async (): Promise<void> => {
    const found = find(context);
    if (found.kind === "missing") {
      await server.stop();
      await explainMissing(context);
      return;
    }
    await server.start(found.file);
    status.refresh();
    view.refresh();
  };
  const binary = (): string | undefined => {
    const found = find(context);
    if (found.kind === "found") {
      return found.file;
    }
    void explainMissing(context);
    return undefined;
  };
  context.subscriptions.push(
    reports,
    server,
    status,
    view,
    ...ownLanguages(),
    ...registerDebugger(binary),
    ...commands({ server, reports, binary, start }),
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("frictcomp")) {
        void start();
      }
    }),
  );
  await start();
}

interface Parts {
  server: Server;
  reports: Reports;
  binary: () => string | undefined;
  start: () => Promise<void>;
}

function commands({ server, reports, binary, start }: Parts): vscode.Disposable[] {
  return [
    vscode.commands.registerCommand("frictcomp.runProgram", async () => {
      const document = activeProgram();
      if (document) {
        await server.command("frictcomp.showTimeline", document.uri);
      }
    }),
    vscode.commands.registerCommand("frictcomp.auditFolder", async (chosen?: vscode.Uri) => {
      const folder = chosen ?? (await chooseFolder());
      const file = binary();
      if (folder && file !== undefined) {
        await reports.showRun("Audit", file, ["audit", folder.fsPath], folder.fsPath);
      }
    }),
    vscode.commands.registerCommand("frictcomp.contourOfProgram", async () => {
      const document = activeProgram();
      const file = binary();
      // The command line reads the file: what is not saved would not be in the picture.
      if (document && file !== undefined && (await document.save())) {
        const { fsPath } = document.uri;
        await reports.showRun("Contour", file, ["contour", fsPath], path.dirname(fsPath));
      }
    }),
    vscode.commands.registerCommand("frictcomp.simulateCircle", async () => {
      const file = binary();
      const circle = file === undefined ? undefined : await askCircle();
      if (file !== undefined && circle) {
        await reports.showRun("Circular test", file, ["circle", ...circle], workspaceFolder()?.fsPath);
      }
    }),
    vscode.commands.registerCommand("frictcomp.restart", start),
  ];
}

function activeProgram(): vscode.TextDocument | undefined {
  const document = vscode.window.activeTextEditor?.document;
  if (document && PROGRAM_LANGUAGES.includes(document.languageId)) {
    return document;
  }
  void vscode.window.showInformationMessage("Open an NC program first.");
  return undefined;
}

function workspaceFolder(): vscode.Uri | undefined {
  return vscode.workspace.workspaceFolders?.[0]?.uri;
}

async function chooseFolder(): Promise<vscode.Uri | undefined> {
  const folders = vscode.workspace.workspaceFolders ?? [];
  if (folders.length > 1) {
    return (await vscode.window.showWorkspaceFolderPick())?.uri;
  }
  if (folders[0]) {
    return folders[0].uri;
  }
  void vscode.window.showInformationMessage("Open the folder with your programs first.");
  return undefined;
}

/** Radius and feed of a circular test, as options of the command line; nothing where the user stops. */
async function askCircle(): Promise<string[] | undefined> {
  const radius = await askNumber("Radius in mm", "100");
  if (radius === undefined) {
    return undefined;
  }
  const feed = await askNumber("Feed in mm/min", "1000");
  return feed === undefined ? undefined : ["--radius", radius, "--feed", feed];
}

async function askNumber(prompt: string, value: string): Promise<string | undefined> {
  return vscode.window.showInputBox({
    prompt,
    value,
    validateInput: (text) => (Number(text) > 0 ? undefined : "Enter a number above 0."),
  });
}

function find(context: vscode.ExtensionContext): Found {
  return findBinary({
    setting: vscode.workspace.getConfiguration("frictcomp").get<string>("path", ""),
    workspace: workspaceFolder()?.fsPath,
    extension: context.extensionPath,
    platform: process.platform,
    path: process.env.PATH ?? "",
    exists: canRun,
  });
}

function canRun(file: string): boolean {
  try {
    accessSync(file, constants.X_OK);
    return true;
  } catch {
    return false;
  }
}

async function explainMissing(context: vscode.ExtensionContext): Promise<void> {
  const choose = "Choose the Program…";
  const install = "How to Install It";
  const answer = await vscode.window.showErrorMessage(
    "The program frictcomp was not found in the setting `frictcomp.path`, beside this extension or on PATH.",
    choose,
    install,
  );
  if (answer === install) {
    const readme = vscode.Uri.joinPath(context.extensionUri, "README.md");
    await vscode.commands.executeCommand("markdown.showPreview", readme);
  } else if (answer === choose) {
    const [file] = (await vscode.window.showOpenDialog({ title: "The program frictcomp" })) ?? [];
    if (file) {
      // The change of the setting starts the server.
      await vscode.workspace
        .getConfiguration("frictcomp")
        .update("path", file.fsPath, vscode.ConfigurationTarget.Global);
    }
  }
}

/** Gives programs and lists that have no language one of ours, where ISG's extension is absent. */
function ownLanguages(): vscode.Disposable[] {
  const give = async (document: vscode.TextDocument): Promise<void> => {
    const language = ownLanguage(document, await vscode.languages.getLanguages());
    if (language !== undefined) {
      await vscode.languages.setTextDocumentLanguage(document, language);
    }
  };
  for (const document of vscode.workspace.textDocuments) {
    void give(document);
  }
  return [
    vscode.workspace.onDidOpenTextDocument((document) => {
      void give(document);
    }),
  ];
}
