// The module in its worker: asked one question at a time, and begun anew where an answer is no longer wanted.

import type { FromWorker, ToWorker } from "./worker";

/** What the program says of what it refuses; `kind` is what it is about. */
export interface Fault { kind: "usage" | "file" | "text" | "domain" | "metric" | "mesh" | "work"; what: string; help: string; place: string }
export interface Part { at: number; bytes: number }

export class Refused extends Error {
  constructor(readonly fault: Fault) { super(fault.what); }
}
/** Not wanted any more. */
export class Cancelled extends Error {}

/** What is told while there is work. */
export interface Watch {
  stage(name: string, total: number): void;
  done(units: number): void;
  sketch(points: Float64Array, triangles: Uint32Array): void;
}

/** An answer: what it tells, and the numbers it brings. */
export class Answer {
  constructor(readonly told: Record<string, unknown>, private readonly all: Uint8Array) {}
  bytes(name: string) {
    const part = this.told[name] as Part | undefined;
    return part ? this.all.slice(part.at, part.at + part.bytes) : null;
  }
  text(name: string) { const bytes = this.bytes(name); return bytes && new TextDecoder().decode(bytes); }
  reals(name: string) { return new Float64Array(this.bytes(name)?.buffer ?? new ArrayBuffer(0)); }
  numbers(name: string) { return new Uint32Array(this.bytes(name)?.buffer ?? new ArrayBuffer(0)); }
}

interface Waiting { question: unknown; bytes: Uint8Array; resolve(answer: Answer): void; reject(fault: Error): void }

export class Engine {
  private worker!: Worker;
  private queue: Waiting[] = [];
  private isReady = false;
  private readonly files = new Map<string, Uint8Array>();
  private readonly address: string;

  constructor(script: string, private readonly module: WebAssembly.Module, private readonly watch: Watch) {
    this.address = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    this.start();
  }

  get isBusy() { return this.queue.length > 0; }
  holds(name: string) { return this.files.has(name); }
  file(name: string) { return this.files.get(name); }

  /** Keeps a file, which questions may then name. */
  async hold(name: string, bytes: Uint8Array) {
    await this.ask({ do: "hold", name }, bytes);
    this.files.set(name, bytes);
  }

  ask(question: Record<string, unknown>, bytes: Uint8Array = new Uint8Array(0)): Promise<Answer> {
    return new Promise((resolve, reject) => {
      this.queue.push({ question, bytes, resolve, reject });
      if (this.queue.length === 1) this.send();
    });
  }

  /** Ends all work at once: the worker goes, and another one begins from the module that is compiled. */
  cancel() {
    if (!this.isBusy) return;
    this.worker.terminate();
    const left = this.queue;
    this.queue = [];
    this.start();
    for (const { reject } of left) reject(new Cancelled());
  }

  private start() {
    this.isReady = false;
    const worker = (this.worker = new Worker(this.address));
    worker.onmessage = ({ data }: MessageEvent<FromWorker>) => { if (worker === this.worker) this.hear(data); };
    worker.onerror = (event) => this.hear({ kind: "failed", what: event.message });
    const told: ToWorker = { module: this.module };
    worker.postMessage(told);
    // What it held before; nothing waits for these.
    const ignore = () => {};
    for (const [name, bytes] of this.files) this.queue.push({ question: { do: "hold", name }, bytes, resolve: ignore, reject: ignore });
  }

  private send() {
    const next = this.queue[0];
    if (!next || !this.isReady) return;
    const told: ToWorker = { question: next.question, bytes: next.bytes };
    this.worker.postMessage(told);
  }

  private hear(told: FromWorker) {
    switch (told.kind) {
      case "ready": this.isReady = true; this.send(); return;
      case "stage": this.watch.stage(told.name, told.total); return;
      case "done": this.watch.done(told.units); return;
      case "sketch": this.watch.sketch(told.points, told.triangles); return;
      case "answer": {
        const { resolve, reject } = this.queue.shift()!;
        if (told.told["fault"]) reject(new Refused(told.told["fault"] as Fault));
        else resolve(new Answer(told.told, told.bytes));
        this.send();
        return;
      }
      case "failed": {
        // A module that has failed is of no use any more.
        const waiting = this.queue.shift();
        const left = this.queue;
        this.queue = [];
        this.worker.terminate();
        this.start();
        const help = "this is a fault of voronaut: please report it with the input";
        waiting?.reject(new Refused({ kind: "work", what: told.what, help, place: "" }));
        for (const { reject } of left) reject(new Cancelled());
      }
    }
  }
}
