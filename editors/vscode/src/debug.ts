/** Stepping through a program: the debug adapter of frictcomp. */
import * as vscode from "vscode";

const TYPE = "frictcomp";

/** Registers the debugger; `program` returns the program frictcomp, or says what to do if it is missing. */
export function registerDebugger(program: () => Promise<string | undefined>): vscode.Disposable[] {
  return [
    vscode.debug.registerDebugConfigurationProvider(TYPE, {
      // F5 without a launch configuration: the program in the editor, from its first block.
      resolveDebugConfiguration: (_, configuration) =>
        configuration.type
          ? configuration
          : {
              type: TYPE,
              request: "launch",
              name: "Step through the NC program",
              program: "${file}",
              stopOnEntry: true,
            },
    }),
    vscode.debug.registerDebugAdapterDescriptorFactory(TYPE, {
      createDebugAdapterDescriptor: async () => {
        const file = await program();
        return file === undefined ? undefined : new vscode.DebugAdapterExecutable(file, ["dap"]);
      },
    }),
  ];
}
