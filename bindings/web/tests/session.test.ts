import { describe, expect, it } from "vitest";
import { Cancelled, Session, type Thread } from "../page/session";
import { Refused } from "../page/engine";
import type { Order, Report } from "../page/worker";

class Fake implements Thread {
  readonly orders: Order[] = [];
  isEnded = false;
  onmessage: Thread["onmessage"] = null;
  onerror: Thread["onerror"] = null;

  postMessage(order: unknown): void {
    this.orders.push(order as Order);
  }

  terminate(): void {
    this.isEnded = true;
  }

  say(report: Report): void {
    this.onmessage?.call(this as unknown as Worker, new MessageEvent("message", { data: report }));
  }
}

function begin(): { threads: Fake[]; session: Session; heard: number[] } {
  const threads: Fake[] = [];
  const heard: number[] = [];
  const start = (): Fake => {
    const thread = new Fake();
    threads.push(thread);
    return thread;
  };
  const session = new Session(new ArrayBuffer(0), start, (blocks) => heard.push(blocks));
  return { threads, session, heard };
}

describe("a session", () => {
  it("gives each answer to its question", async () => {
    const { threads, session, heard } = begin();
    const [one, two] = [session.json({ ask: "one" }), session.json({ ask: "two" })];
    const bytes = (text: string): Uint8Array<ArrayBuffer> => new TextEncoder().encode(text);
    threads[0]?.say({ kind: "progress", blocks: 5, line: 1 });
    threads[0]?.say({ kind: "answer", id: 2, bytes: bytes("[2]") });
    const refusal = { message: "no", help: null, said: [] };
    threads[0]?.say({ kind: "refusal", id: 1, refusal });
    await expect(two).resolves.toEqual([2]);
    await expect(one).rejects.toBeInstanceOf(Refused);
    expect(heard).toEqual([5]);
  });

  it("keeps its files when work is cancelled", async () => {
    const { threads, session } = begin();
    session.put("a.nc", { content: new Uint8Array([1]), named: true });
    const work = session.ask({ ask: "run" });
    session.cancel();
    await expect(work).rejects.toBeInstanceOf(Cancelled);
    expect(threads[0]?.isEnded).toBe(true);
    expect(threads[1]?.orders.map(({ kind }) => kind)).toEqual(["start", "put"]);
  });
});
