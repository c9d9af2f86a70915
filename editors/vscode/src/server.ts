/** The language server: started from the binary, restarted when its settings change. */
import * as vscode from "vscode";
import {
  CloseAction,
  ErrorAction,
  LanguageClient,
  TransportKind,
  type LanguageClientOptions,
} from "vscode-languageclient/node";
import type { ContourAnswer } from "./contour/panel";
import { contourSettings } from "./contour/settings";
import { selector } from "./languages";
import { furtherLanguages } from "./programs";
import type { Contour, Report, States, Timeline } from "./protocol";

/** The identifier of ISG's extension, to which definitions and references are left. */
const ISG_EXTENSION = "isg-cnc.vscode-isg-cnc";

/** Shows a report that the server made of an open text. */
export type ShowReport = (title: string, html: string) => void;

/** The pages of the codes, in the folder of the extension. */
const PAGES = ["dist", "codes"];

export class Server implements vscode.Disposable {
  private client: LanguageClient | undefined;

  constructor(
    private readonly extension: vscode.Uri,
    private readonly showReport: ShowReport,
  ) {}

  async start(binary: string): Promise<void> {
    await this.stop();
    const options: LanguageClientOptions = {
      documentSelector: selector(furtherLanguages()),
      // The end of the server is reported once, with its reason, and it is not restarted over and over.
      errorHandler: {
        error: () => ({ action: ErrorAction.Shutdown, handled: true }),
        closed: () => ({ action: CloseAction.DoNotRestart, message: "frictcomp has ended; `frictcomp: Restart the Language Server` starts it again." }),
      },
      // Messages are also requested on each change, which the client does only when told.
      diagnosticPullOptions: { onChange: true },
      initializationFailedHandler: () => false,
      initializationOptions: { frictcomp: this.settings() },
      synchronize: { fileEvents: vscode.workspace.createFileSystemWatcher("**/{*.lis,*.tsproj,*.xti,frictcomp.toml}") },
      middleware: {
        executeCommand: async (command, args: unknown[], next) => {
          const answer: unknown = await next(command, args);
          if (isReport(answer)) {
            this.showReport(titleOf(command, args), answer.html);
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

  /** Drives a program; it is stopped if no caller waits any more. */
  async contour(uri: vscode.Uri, stop: vscode.CancellationToken): Promise<ContourAnswer> {
    const client = this.client;
    if (!client?.isRunning()) {
      return { reason: "the language server of frictcomp is not running" };
    }
    try {
      const params = { textDocument: { uri: uri.toString() } };
      return { contour: await client.sendRequest<Contour>("frictcomp/contour", params, stop) };
    } catch (error) {
      return { reason: error instanceof Error ? error.message : String(error) };
    }
  }

  /** Runs a command of the server on a document; the middleware shows its answer. */
  async command(command: string, uri: vscode.Uri): Promise<void> {
    await vscode.commands.executeCommand(command, { uri: uri.toString() });
  }

  dispose(): void {
    void this.stop();
  }

  private settings(): object {
    const settings = vscode.workspace.getConfiguration("frictcomp");
    return {
      inlayHints: { enable: settings.get<boolean>("inlayHints.enable") },
      codeLens: { enable: settings.get<boolean>("codeLens.enable") },
      navigation: settings.get<string>("navigation"),
      maxBlocks: settings.get<number>("maxBlocks"),
      languages: furtherLanguages(),
      contour: contourSettings(),
      isgExtension: vscode.extensions.getExtension(ISG_EXTENSION) !== undefined,
      pages: vscode.Uri.joinPath(this.extension, ...PAGES).toString(),
    };
  }

  private async ask<Answer>(method: string, params: object): Promise<Answer | undefined> {
    const client = this.client;
    if (!client?.isRunning()) {
      return undefined;
    }
    try {
      return (await client.sendRequest<Answer | null>(method, params)) ?? undefined;
    } catch {
      // The server refuses an outdated request; the next one is already on its way.
      return undefined;
    }
  }
}

function isReport(answer: unknown): answer is Report {
  return typeof answer === "object" && answer !== null && "html" in answer && typeof answer.html === "string";
}

/** A report is named after the subject of its command. */
function titleOf(command: string, [subject]: unknown[]): string {
  const report = command === "frictcomp.audit" ? "Audit" : "Run";
  if (typeof subject === "object" && subject !== null && "uri" in subject && typeof subject.uri === "string") {
    return `${report} of ${vscode.workspace.asRelativePath(vscode.Uri.parse(subject.uri))}`;
  }
  return report;
}
