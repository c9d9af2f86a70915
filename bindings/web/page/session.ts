// The engine as the page sees it: questions and answers, progress, and an end to work that is not wanted.

import { Refused } from "./engine";
import type { Order, Report } from "./worker";

/** A file that was dropped. */
export interface DroppedFile {
  content: Uint8Array;
  /** Whether the user picked the file individually. */
  named: boolean;
}

/** Work that the user ended. */
export class Cancelled extends Error {
  constructor() {
    super("cancelled");
  }
}

interface Waiting {
  resolve(bytes: Uint8Array<ArrayBuffer>): void;
  reject(error: Error): void;
}

/** The part of a worker that is needed; tests have their own. */
export type Thread = Pick<Worker, "postMessage" | "terminate" | "onmessage" | "onerror">;

const decoder = new TextDecoder();

export class Session {
  readonly files = new Map<string, DroppedFile>();
  private thread: Thread;
  private waiting = new Map<number, Waiting>();
  private next = 1;

  constructor(
    private readonly code: ArrayBuffer,
    private readonly start: () => Thread,
    private readonly progress: (blocks: number, line: number) => void,
    private readonly told: (text: string) => void = () => undefined,
  ) {
    this.thread = this.begin();
  }

  /** Accepts a file, replacing one with the same path. */
  put(path: string, file: DroppedFile): void {
    this.files.set(path, file);
    this.send({ kind: "put", path, ...file });
  }

  /** Forgets every file. */
  async clear(): Promise<void> {
    this.files.clear();
    await this.ask({ ask: "clear" });
  }

  /** The bytes of an answer. */
  ask(question: object): Promise<Uint8Array<ArrayBuffer>> {
    const id = this.next++;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject });
      this.send({ kind: "ask", id, question });
    });
  }

  /** An answer in JSON. */
  async json<T>(question: object): Promise<T> {
    return JSON.parse(decoder.decode(await this.ask(question))) as T;
  }

  /** Whether an answer is pending. */
  get isBusy(): boolean {
    return this.waiting.size > 0;
  }

  /** Ends all work. The files are kept. */
  cancel(error: Error = new Cancelled()): void {
    this.thread.terminate();
    const waiting = [...this.waiting.values()];
    this.waiting.clear();
    this.thread = this.begin();
    for (const [path, file] of this.files) {
      this.send({ kind: "put", path, ...file });
    }
    for (const one of waiting) {
      one.reject(error);
    }
  }

  private begin(): Thread {
    const thread = this.start();
    thread.onmessage = (event: MessageEvent<Report>): void => {
      this.hear(event.data);
    };
    thread.onerror = (event): void => {
      this.cancel(new Error(event.message));
    };
    thread.postMessage({ kind: "start", code: this.code } satisfies Order);
    return thread;
  }

  private send(order: Order): void {
    this.thread.postMessage(order);
  }

  private hear(report: Report): void {
    switch (report.kind) {
      case "progress":
        this.progress(report.blocks, report.line);
        break;
      case "told":
        this.told(report.text);
        break;
      case "failure":
        this.cancel(new Error(report.message));
        break;
      case "answer":
        this.settle(report.id)?.resolve(report.bytes);
        break;
      case "refusal":
        this.settle(report.id)?.reject(new Refused(report.refusal));
        break;
    }
  }

  private settle(id: number): Waiting | undefined {
    const waiting = this.waiting.get(id);
    this.waiting.delete(id);
    return waiting;
  }
}
