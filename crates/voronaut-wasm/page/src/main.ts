// The page begins here: the module is unpacked and compiled, and hands are listened to.

import { listen } from "../../../voronaut-draw/viewer/src/input";
import { Bench } from "./bench";
import { Engine } from "./engine";
import { EXAMPLES } from "./examples";
import { Form } from "./form";
import { Ink } from "./ink";
import { Progress } from "./progress";
import { ENDINGS, copy, fileName, save, showWords } from "./results";
import { Stage } from "./stage";
import { type Tool, Tools } from "./tools";

/** The worker's script, which the build puts here. */
declare const WORKER: string;

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;

/** The bytes that an element has, deflated, as digits. */
async function unpacked(id: string): Promise<Uint8Array<ArrayBuffer>> {
  const digits = atob(element(id).textContent!.trim()), bytes = new Uint8Array(digits.length);
  for (let i = 0; i < digits.length; i++) bytes[i] = digits.charCodeAt(i);
  const inflated = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Uint8Array(await new Response(inflated).arrayBuffer());
}

async function begin() {
  if (!("DecompressionStream" in window)) throw new Error("This browser is too old for the page: it has no DecompressionStream.");
  const module = await WebAssembly.compile(await unpacked("module"));
  element("module").remove();
  const isWide = window.innerWidth > 900;
  const stage = new Stage(element("view"), document.querySelector<HTMLMetaElement>("meta[name=generator]")!.content);
  for (const id of ["head", "bench"]) element(id).hidden = false;
  element("panel").hidden = !isWide;
  stage.viewer.margin = isWide ? { left: 336, right: 316, top: 60, bottom: 0 } : { left: 0, right: 0, top: 60, bottom: 0.44 * window.innerHeight };
  const ink = new Ink(element("ink"), stage), progress = new Progress();
  let bench: Bench;
  const engine = new Engine(WORKER, module, {
    stage: (name, total) => progress.stage(name, total),
    done: (units) => progress.done(units),
    sketch: (points, triangles) => bench.sketch(points, triangles),
  });
  let timer = 0;
  const form = new Form((isMoving) => {
    window.clearTimeout(timer);
    showWords(form.job);
    timer = window.setTimeout(() => { tools.take("look"); void bench.run(); }, isMoving ? 250 : 0);
  }, (example) => { form.set({ cells: false, ...example }); tools.take("look"); void bench.run(); });
  bench = new Bench(engine, stage, ink, form, progress, (name) => unpacked(name));
  const tools = new Tools(element("ink"), stage, ink, {
    drawn: (rings) => { const kept = rings; tools.take("look"); void bench.drawn(kept); },
    moved: () => void bench.follow(),
    ends: (from, to) => void bench.between(from, to),
  });
  buttons(bench, stage, ink);
  drops(bench);
  listen(stage.viewer, stage.panel);
  stage.viewer.resize();
  form.set(EXAMPLES[0]);
  element("wait").remove();
  document.documentElement.dataset["ready"] = "true";
  // For tests, and for those who open the console.
  Object.assign(window, { voronaut: stage.viewer, playground: { bench, engine, ink, stage, progress } });
  await bench.run();
}

function buttons(bench: Bench, stage: Stage, ink: Ink) {
  const on = (id: string, act: (button: HTMLButtonElement) => void) =>
    element(id).addEventListener("click", (event) => act(event.currentTarget as HTMLButtonElement));
  on("go", () => void bench.run());
  on("cancel", () => bench.cancel());
  element("ending").innerHTML = ENDINGS.map((ending) => `<option value="${ending}">.${ending}</option>`).join("");
  on("save", async () => {
    const name = fileName(bench.made!.job, element<HTMLSelectElement>("ending").value);
    save(name, await bench.file(name) as Uint8Array<ArrayBuffer>);
  });
  on("save-page", () => save(fileName(bench.made!.job, "html"), bench.made!.page, "text/html"));
  on("save-report", () => save(fileName(bench.made!.job, "json"), `${JSON.stringify(bench.made!.report, null, 2)}\n`, "application/json"));
  on("copy-shell", (button) => void copy("shell", button));
  on("copy-python", (button) => void copy("python", button));
  element("ellipse").addEventListener("change", (event) => { ink.hasEllipse = (event.target as HTMLInputElement).checked; stage.viewer.redraw(); });
  const seeds = () => Math.min(Math.max(Math.round(Number(element<HTMLInputElement>("seed-count").value)) || 24, 3), 300);
  element("seed-count").addEventListener("change", () => { if (ink.seeds.length > 0) void bench.scatter(seeds()); });
  document.addEventListener("tool", ({ detail }: CustomEventInit<Tool>) => {
    for (const tool of ["draw", "seeds", "geodesic"]) element(`${tool}-hint`).hidden = tool !== detail;
    if (detail === "draw") { bench.cancel(); stage.clear(); element("figures").innerHTML = ""; }
    if (detail === "seeds") void (ink.seeds.length > 0 ? bench.follow() : bench.scatter(seeds()));
    else ink.seeds = [];
  });
}

/** Files that are dropped, or opened. */
function drops(bench: Bench) {
  const open = async (file?: File) => { if (file) await bench.open(file.name, new Uint8Array(await file.arrayBuffer())); };
  const opener = element<HTMLInputElement>("opener");
  element("open-file").addEventListener("click", () => opener.click());
  opener.addEventListener("change", () => { void open(opener.files?.[0]); opener.value = ""; });
  window.addEventListener("dragover", (event) => { event.preventDefault(); document.body.classList.add("is-over"); });
  window.addEventListener("dragleave", (event) => { if (!event.relatedTarget) document.body.classList.remove("is-over"); });
  window.addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("is-over");
    void open(event.dataTransfer?.files[0]);
  });
}

begin().catch((fault: unknown) => {
  const wait = document.getElementById("wait");
  if (wait) wait.textContent = fault instanceof Error ? fault.message : String(fault);
  document.documentElement.dataset["ready"] = "false";
  throw fault;
});
