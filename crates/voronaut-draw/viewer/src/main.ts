// The page begins here: meshes are unpacked, drawn, and given to the hands.

import { Store } from "./decode";
import { listen } from "./input";
import { type Description, Mesh, unpack } from "./model";
import { Panel } from "./panel";
import { CELLS, Viewer } from "./viewer";

async function begin() {
  const text = (id: string) => document.getElementById(id)!.textContent!;
  if (!("DecompressionStream" in window)) throw new Error("This browser is too old for the page: it has no DecompressionStream.");
  const description = JSON.parse(text("description")) as Description;
  const store = new Store(text("numbers"));
  document.getElementById("numbers")!.remove();
  const meshes: Mesh[] = [];
  for (const told of description.meshes) meshes.push(await unpack(store, told));
  const viewer = new Viewer(document.getElementById("view") as HTMLCanvasElement, meshes);
  if (meshes[0].cells) {
    viewer.colourBy = CELLS;
    viewer.layers.edges = false;
    viewer.layers.geodesics = meshes[0].curves.length > 0;
  }
  for (const id of ["head", "panel"]) document.getElementById(id)!.hidden = window.innerWidth <= 720 && id === "panel";
  if (window.innerWidth > 720) viewer.margin = { left: 0, right: 316, top: 0, bottom: 0 };
  else viewer.margin = { left: 0, right: 0, top: 70, bottom: 0 };
  const panel = new Panel(viewer, description.title, description.by);
  listen(viewer, panel);
  viewer.resize();
  viewer.draw();
  document.getElementById("wait")!.remove();
  viewer.course.loadMs = performance.now();
  document.documentElement.dataset["ready"] = "true";
  // For tests, and for those who open the console.
  Object.assign(window, { voronaut: viewer });
}

begin().catch((fault: unknown) => {
  document.getElementById("wait")!.textContent = fault instanceof Error ? fault.message : String(fault);
  document.documentElement.dataset["ready"] = "false";
});
