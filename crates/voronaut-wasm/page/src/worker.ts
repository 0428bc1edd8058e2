// In the worker: the module is started, asked, and tells what it does meanwhile.

/** What the page sends. */
export type ToWorker = { module: WebAssembly.Module } | { question: unknown; bytes: Uint8Array };
/** What it hears. */
export type FromWorker =
  | { kind: "ready" } | { kind: "stage"; name: string; total: number } | { kind: "done"; units: number }
  | { kind: "sketch"; points: Float64Array; triangles: Uint32Array }
  | { kind: "answer"; told: Record<string, unknown>; bytes: Uint8Array } | { kind: "failed"; what: string };

interface Exports { memory: WebAssembly.Memory; question(bytes: number): number; perform(): number; answer(): number }

const scope = self as unknown as { onmessage: (event: MessageEvent<ToWorker>) => void; postMessage(told: FromWorker, list?: Transferable[]): void };
/** Units of work are told no more often than once in so many milliseconds. */
const PERIOD = 40;

let exports: Exports;
let panic = "", units = 0, last = 0;

const bytesAt = (at: number, count: number) => new Uint8Array(exports.memory.buffer, at, count);
const textAt = (at: number, count: number) => new TextDecoder().decode(bytesAt(at, count));
const tell = (told: FromWorker, list: Transferable[] = []) => scope.postMessage(told, list);

const told = {
  now: () => performance.now() / 1000,
  stage: (name: number, bytes: number, total: number) => { units = 0; tell({ kind: "stage", name: textAt(name, bytes), total }); },
  done: (more: number) => {
    units += more;
    const now = performance.now();
    if (now - last >= PERIOD) { tell({ kind: "done", units }); last = now; }
  },
  sketch: (points: number, count: number, triangles: number, triangleCount: number) => {
    const places = new Float64Array(exports.memory.buffer, points, 3 * count).slice();
    const corners = new Uint32Array(exports.memory.buffer, triangles, 3 * triangleCount).slice();
    tell({ kind: "sketch", points: places, triangles: corners }, [places.buffer, corners.buffer]);
  },
  failed: (text: number, bytes: number) => { panic = textAt(text, bytes); },
};

/** The length of a text, the text, and bytes: of questions as of answers. */
function ask(question: unknown, bytes: Uint8Array) {
  const text = new TextEncoder().encode(JSON.stringify(question));
  const at = exports.question(4 + text.length + bytes.length);
  new DataView(exports.memory.buffer).setUint32(at, text.length, true);
  bytesAt(at + 4, text.length).set(text);
  bytesAt(at + 4 + text.length, bytes.length).set(bytes);
  const count = exports.perform(), start = exports.answer();
  const size = new DataView(exports.memory.buffer).getUint32(start, true);
  const found = bytesAt(start + 4 + size, count - 4 - size).slice();
  tell({ kind: "answer", told: JSON.parse(textAt(start + 4, size)) as Record<string, unknown>, bytes: found }, [found.buffer]);
}

scope.onmessage = async ({ data }) => {
  try {
    if ("module" in data) {
      exports = (await WebAssembly.instantiate(data.module, { worker: told })).exports as unknown as Exports;
      tell({ kind: "ready" });
    } else ask(data.question, data.bytes);
  } catch (fault) {
    tell({ kind: "failed", what: panic || String(fault) });
  }
};
