/** frictcomp in VS Code: the language server, the states in the status bar, the timeline, reports. */
import { constants, accessSync } from "node:fs";
import * as path from "node:path";
import * as vscode from "vscode";
import { findBinary, type Found } from "./binary";
import { ContourPanel } from "./contour/panel";
import { contourOptions, contourSettings } from "./contour/settings";
import { registerDebugger } from "./debug";
import { foreignLanguage, isServed, programLanguages } from "./languages";
import { furtherLanguages, isProgram } from "./programs";
import { Reports } from "./reports";
import { Server } from "./server";
import { StatusBar } from "./statusBar";
import { usable } from "./version";
import { TimelineView } from "./view/provider";

export function activate(context: vscode.ExtensionContext): void {
  const reports = new Reports();
  const server = new Server(context.extensionUri, (title, html) => {
    reports.show(title, html);
  });
  const status = new StatusBar((uri, position) => server.states(uri, position));
  const view = new TimelineView(context.extensionUri, (uri) => server.timeline(uri));
  const contour = new ContourPanel(context.extensionUri, (uri, stop) => server.contour(uri, stop));
  const wanted = context.extension.packageJSON as { version: string };
  const trouble = new Trouble();
  const program = async (): Promise<string | undefined> => {
    const found = await usable(find(context), wanted.version);
    if (found.kind === "usable") {
      return found.file;
    }
    trouble.tell(found.why);
    return undefined;
  };
  let isStarted = false;
  const start = async (): Promise<void> => {
    isStarted = true;
    publishLanguages();
    const file = await program();
    try {
      await (file === undefined ? server.stop() : server.start(file));
    } catch (error) {
      trouble.tell(`The program frictcomp does not start as a language server: ${String(error)}`);
    }
    status.refresh();
    view.refresh();
    contour.refresh();
  };
  // Nothing happens before there is something to check.
  const meet = (document: vscode.TextDocument): void => {
    if (!isStarted && isServed(document, furtherLanguages())) {
      void start();
    } else {
      void askForeign(context, document);
    }
  };
  publishLanguages();
  vscode.workspace.textDocuments.forEach(meet);
  context.subscriptions.push(
    reports,
    server,
    status,
    view,
    contour,
    ...registerDebugger(program),
    ...commands({ server, reports, contour, program, start }),
    vscode.workspace.onDidOpenTextDocument(meet),
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("frictcomp")) {
        trouble.forget();
        publishLanguages();
        if (isStarted) {
          void start();
        } else {
          vscode.workspace.textDocuments.forEach(meet);
        }
      }
    }),
  );
}

interface Parts {
  server: Server;
  reports: Reports;
  contour: ContourPanel;
  program: () => Promise<string | undefined>;
  start: () => Promise<void>;
}

function commands({ server, reports, contour, program, start }: Parts): vscode.Disposable[] {
  return [
    vscode.commands.registerCommand("frictcomp.runProgram", async () => {
      const document = activeProgram();
      if (document) {
        await server.command("frictcomp.showTimeline", document.uri);
      }
    }),
    vscode.commands.registerCommand("frictcomp.auditFolder", async (chosen?: vscode.Uri) => {
      const folder = chosen ?? (await chooseFolder());
      const file = folder && (await program());
      if (folder && file !== undefined) {
        await reports.showRun("Audit", file, ["audit", folder.fsPath], folder.fsPath);
      }
    }),
    vscode.commands.registerCommand("frictcomp.contourOfProgram", () => {
      const document = activeProgram();
      if (document) {
        contour.open(document.uri);
      }
    }),
    vscode.commands.registerCommand("frictcomp.reportContour", async () => {
      const document = activeProgram();
      const file = document && (await program());
      // The command line reads the file: unsaved changes would not be in the report.
      if (document && file !== undefined && (await document.save())) {
        const { fsPath } = document.uri;
        const folder = workspaceFolder()?.fsPath ?? path.dirname(fsPath);
        await reports.showRun("Contour", file, ["contour", fsPath, ...contourOptions(contourSettings())], folder);
      }
    }),
    vscode.commands.registerCommand("frictcomp.simulateCircle", async () => {
      const file = await program();
      const circle = file === undefined ? undefined : await askCircle();
      if (file !== undefined && circle) {
        await reports.showRun("Circular test", file, ["circle", ...circle], workspaceFolder()?.fsPath);
      }
    }),
    vscode.commands.registerCommand("frictcomp.restart", start),
    vscode.commands.registerCommand("frictcomp.choosePath", choosePath),
  ];
}

function activeProgram(): vscode.TextDocument | undefined {
  const document = vscode.window.activeTextEditor?.document;
  if (document && isProgram(document)) {
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

/** Radius and feed of a circular test, as options of the command line; nothing if the user cancels. */
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

/** The one message about a program that cannot be used; it is not repeated until something changes. */
class Trouble {
  private isTold = false;

  tell(why: string): void {
    if (this.isTold) {
      return;
    }
    this.isTold = true;
    void this.show(why);
  }

  forget(): void {
    this.isTold = false;
  }

  private async show(why: string): Promise<void> {
    const help = "Set Up frictcomp";
    if ((await vscode.window.showErrorMessage(why, help)) === help) {
      await vscode.commands.executeCommand("workbench.action.openWalkthrough", "frictcomp.frictcomp#start");
    }
  }
}

async function choosePath(): Promise<void> {
  const [file] = (await vscode.window.showOpenDialog({ title: "The program frictcomp" })) ?? [];
  if (file) {
    // The change of the setting starts the server.
    await vscode.workspace
      .getConfiguration("frictcomp")
      .update("path", file.fsPath, vscode.ConfigurationTarget.Global);
  }
}

/** Tells the menus which languages are those of programs. */
function publishLanguages(): void {
  const languages = programLanguages(furtherLanguages());
  void vscode.commands.executeCommand("setContext", "frictcomp.programLanguages", languages);
}

/** Asks once for each language of another extension whether its programs are to be checked. */
async function askForeign(context: vscode.ExtensionContext, document: vscode.TextDocument): Promise<void> {
  const further = furtherLanguages();
  const language = foreignLanguage(document, further);
  const key = `asked.${language ?? ""}`;
  if (language === undefined || context.globalState.get<boolean>(key)) {
    return;
  }
  await context.globalState.update(key, true);
  const check = "Check Them";
  const answer = await vscode.window.showInformationMessage(
    `Programs such as ${path.basename(document.fileName)} have the language "${language}" here, which frictcomp does not check. Are they programs of an ISG or TwinCAT control?`,
    check,
    "No",
  );
  if (answer === check) {
    await vscode.workspace
      .getConfiguration("frictcomp")
      .update("languages", [...further, language], vscode.ConfigurationTarget.Global);
  }
}
