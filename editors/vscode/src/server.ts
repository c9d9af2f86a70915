/** The language server: started from the binary, restarted when its settings change. */
import * as vscode from "vscode";
import { LanguageClient, TransportKind, type LanguageClientOptions } from "vscode-languageclient/node";
import { SELECTOR } from "./languages";
import type { States, Timeline } from "./protocol";

/** The identifier of ISG's extension, beside which navigation is left to it. */
const ISG_EXTENSION = "isg-stuttgart.vscode-isg-cnc";

/** Shows a report that the server made of an open text. */
export type ShowReport = (title: string, html: string) => void;

export class Server implements vscode.Disposable {
  private client: LanguageClient | undefined;

  constructor(private readonly showReport: ShowReport) {}

  async start(binary: string): Promise<void> {
    await this.stop();
    const options: LanguageClientOptions = {
      documentSelector: SELECTOR,
      initializationOptions: serverSettings(),
      synchronize: { fileEvents: vscode.workspace.createFileSystemWatcher("**/{*.lis,frictcomp.toml}") },
      middleware: {
        executeCommand: async (command, args: unknown[], next) => {
          const answer: unknown = await next(command, args);
          if (isReport(answer)) {
            this.showReport(answer.title, answer.html);
          }
          return answer;
        },
      },
    };
    const command = { command: binary, args: ["lsp"], transport: TransportKind.stdio };
    const client = new LanguageClient("frictcomp", "frictcomp", command, options);
    this.client = client;
    await client.start();
  }

  async stop(): Promise<void> {
    const client = this.client;
    this.client = undefined;
    await client?.dispose();
  }

  async states(uri: vscode.Uri, position: vscode.Position): Promise<States | undefined> {
    const { line, character } = position;
    return this.ask("frictcomp/states", { textDocument: { uri: uri.toString() }, position: { line, character } });
  }

  async timeline(uri: vscode.Uri): Promise<Timeline | undefined> {
    return this.ask("frictcomp/timeline", { textDocument: { uri: uri.toString() } });
  }

  /** Runs a command of the server on a document; what it answers is shown by the middleware. */
  async command(command: string, uri: vscode.Uri): Promise<void> {
    await vscode.commands.executeCommand(command, uri.toString());
  }

  dispose(): void {
    void this.stop();
  }

  private async ask<Answer>(method: string, params: object): Promise<Answer | undefined> {
    const client = this.client;
    if (!client?.isRunning()) {
      return undefined;
    }
    try {
      return (await client.sendRequest<Answer | null>(method, params)) ?? undefined;
    } catch {
      // A request that is out of date is refused by the server; the next one is already on its way.
      return undefined;
    }
  }
}

function serverSettings(): object {
  const settings = vscode.workspace.getConfiguration("frictcomp");
  const navigation = settings.get<string>("navigation", "auto");
  const alone = vscode.extensions.getExtension(ISG_EXTENSION) === undefined;
  return {
    inlayHints: { enable: settings.get<boolean>("inlayHints.enable", true) },
    codeLens: { enable: settings.get<boolean>("codeLens.enable", true) },
    navigation: navigation === "auto" ? (alone ? "on" : "off") : navigation,
    maxBlocks: settings.get<number>("maxBlocks", 1_000_000),
  };
}

function isReport(answer: unknown): answer is { title: string; html: string } {
  return (
    typeof answer === "object" &&
    answer !== null &&
    "html" in answer &&
    typeof answer.html === "string" &&
    "title" in answer &&
    typeof answer.title === "string"
  );
}
