// The engine: WebAssembly that shares only bytes with the page.

/** The exports of the engine; `src/border.rs` documents them. */
interface Border {
  readonly memory: WebAssembly.Memory;
  reserve(length: number): number;
  put(pathLength: number, named: number): void;
  ask(): number;
  answer(): number;
  answer_length(): number;
}

/** Reason why a question has no answer. */
export interface Refusal {
  message: string;
  help: string | null;
  said: { severity: string; code: string; message: string; file: string; line: number }[];
}

/** A question that the engine refused. */
export class Refused extends Error {
  constructor(readonly refusal: Refusal) {
    super(refusal.message);
  }
}

/** The time between two progress reports, in ms. */
const PAUSE = 100;

const encoder = new TextEncoder();
const decoder = new TextDecoder();

export class Engine {
  private constructor(private readonly border: Border) {}

  /**
   * Starts the engine; `progress` receives the executed blocks and the line of the main program, `hear` the
   * progress of other work, in words.
   */
  static async start(
    code: BufferSource,
    progress: (blocks: number, line: number) => void,
    hear: (text: string) => void,
  ): Promise<Engine> {
    let border: Border | null = null;
    let last = performance.now();
    const due = (): number => {
      const now = performance.now();
      if (now - last < PAUSE) {
        return 0;
      }
      last = now;
      return 1;
    };
    const told = (at: number, length: number): void => {
      if (border) {
        hear(decoder.decode(new Uint8Array(border.memory.buffer, at, length)));
      }
    };
    const { instance } = await WebAssembly.instantiate(code, { env: { progress, due, told } });
    border = instance.exports as unknown as Border;
    return new Engine(border);
  }

  /** Gives the engine a file. */
  put(path: string, content: Uint8Array, named: boolean): void {
    const name = encoder.encode(path);
    this.send(name, content);
    this.border.put(name.length, named ? 1 : 0);
  }

  /** The bytes of an answer. */
  ask(question: object): Uint8Array<ArrayBuffer> {
    this.send(encoder.encode(JSON.stringify(question)));
    const isAnswered = this.border.ask() === 1;
    const at = this.border.answer();
    const bytes = new Uint8Array(this.border.memory.buffer, at, this.border.answer_length());
    // The memory may move with the next question.
    const answer = bytes.slice();
    if (!isAnswered) {
      throw new Refused(JSON.parse(decoder.decode(answer)) as Refusal);
    }
    return answer;
  }

  private send(...pieces: Uint8Array[]): void {
    const length = pieces.reduce((sum, piece) => sum + piece.length, 0);
    let at = this.border.reserve(length);
    for (const piece of pieces) {
      new Uint8Array(this.border.memory.buffer, at, piece.length).set(piece);
      at += piece.length;
    }
  }
}
