// The engine in its own thread.

import { Engine, Refused, type Refusal } from "./engine";

/** Messages from the page. */
export type Order =
  | { kind: "start"; code: ArrayBuffer }
  | { kind: "put"; path: string; content: Uint8Array; named: boolean }
  | { kind: "ask"; id: number; question: object };

/** Messages to the page. */
export type Report =
  | { kind: "progress"; blocks: number; line: number }
  | { kind: "told"; text: string }
  | { kind: "answer"; id: number; bytes: Uint8Array<ArrayBuffer> }
  | { kind: "refusal"; id: number; refusal: Refusal }
  | { kind: "failure"; message: string };

function report(message: Report, transfer: Transferable[] = []): void {
  self.postMessage(message, { transfer });
}

let starting: Promise<Engine> | null = null;

async function obey(order: Order): Promise<void> {
  if (order.kind === "start") {
    const progress = (blocks: number, line: number): void => {
      report({ kind: "progress", blocks, line });
    };
    const told = (text: string): void => {
      report({ kind: "told", text });
    };
    starting = Engine.start(order.code, progress, told);
    await starting;
    return;
  }
  const engine = await starting;
  if (!engine) {
    throw new Error("the engine was not started");
  }
  if (order.kind === "put") {
    engine.put(order.path, order.content, order.named);
    return;
  }
  try {
    const bytes = engine.ask(order.question);
    report({ kind: "answer", id: order.id, bytes }, [bytes.buffer]);
  } catch (error) {
    if (!(error instanceof Refused)) {
      throw error;
    }
    report({ kind: "refusal", id: order.id, refusal: error.refusal });
  }
}

// One order after another, as they arrive.
let last = Promise.resolve();
self.addEventListener("message", (event: MessageEvent<Order>) => {
  last = last.then(() => obey(event.data)).catch((error: unknown) => {
    report({ kind: "failure", message: error instanceof Error ? error.message : String(error) });
  });
});
