// Hands on the mesh: mouse, fingers, keys.

import { Panel, told } from "./panel";
import type { Viewer } from "./viewer";

export function listen(viewer: Viewer, panel: Panel) {
  const { canvas } = viewer, fingers = new Map<number, { x: number; y: number }>();
  let moved = 0, hover = 0;
  const drag = (dx: number, dy: number, isPan: boolean) => {
    if (viewer.camera.isPlanar || isPan) viewer.camera.pan(dx, dy);
    else viewer.camera.turn(dx * 0.008, dy * 0.008);
    viewer.redraw();
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (fingers.size === 1) moved = 0;
    hide();
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = fingers.get(event.pointerId);
    if (!last) {
      // The figures come when the hand rests: finding them takes a look at every triangle.
      window.clearTimeout(hover);
      hide();
      if (event.pointerType !== "touch") hover = window.setTimeout(() => point(event.clientX, event.clientY), 60);
      return;
    }
    const before = spanOf(fingers), [dx, dy] = [event.clientX - last.x, event.clientY - last.y];
    moved += Math.abs(dx) + Math.abs(dy);
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (fingers.size === 1) { drag(dx, dy, event.shiftKey || event.buttons > 1); return; }
    const after = spanOf(fingers);
    viewer.camera.pan(after.x - before.x, after.y - before.y);
    if (before.size > 0) viewer.camera.zoom(after.size / before.size, after.x, after.y);
    viewer.redraw();
  });
  const lift = (event: PointerEvent) => {
    const isAlone = fingers.size === 1;
    fingers.delete(event.pointerId);
    if (event.type === "pointerup" && isAlone && moved < 5) panel.pick(found(viewer, event.clientX, event.clientY));
  };
  canvas.addEventListener("pointerup", lift);
  canvas.addEventListener("pointercancel", lift);
  canvas.addEventListener("pointerleave", () => { window.clearTimeout(hover); hide(); });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("dblclick", (event) => { viewer.camera.zoom(2, event.clientX, event.clientY); viewer.redraw(); });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    viewer.camera.zoom(Math.exp(-event.deltaY * (event.ctrlKey ? 0.01 : 0.0015)), event.clientX, event.clientY);
    hide();
    viewer.redraw();
  }, { passive: false });
  const point = (x: number, y: number) => tip(viewer, x, y);
  window.addEventListener("keydown", (event) => { if (press(viewer, panel, drag, event)) event.preventDefault(); });
  window.addEventListener("resize", () => viewer.resize());
}

function spanOf(fingers: Map<number, { x: number; y: number }>) {
  const all = [...fingers.values()], [p, q] = [all[0], all[all.length - 1]];
  return { x: (p.x + q.x) / 2, y: (p.y + q.y) / 2, size: Math.hypot(p.x - q.x, p.y - q.y) };
}

/** What is at a pixel of the mesh that cards are about. */
function found(viewer: Viewer, x: number, y: number) {
  const at = viewer.at(x, y);
  return at && at.mesh === viewer.current ? at.hit : null;
}

const hide = () => { document.getElementById("tip")!.hidden = true; };

function tip(viewer: Viewer, x: number, y: number) {
  const at = viewer.at(x, y), card = document.getElementById("tip")!;
  card.hidden = !at;
  if (!at) return;
  card.innerHTML = told(viewer.meshes[at.mesh], at.hit);
  const { width, height } = card.getBoundingClientRect();
  card.style.left = `${Math.min(x + 16, window.innerWidth - width - 8)}px`;
  card.style.top = `${y + 18 + height > window.innerHeight ? y - height - 12 : y + 18}px`;
}

/** Whether a key meant something. */
function press(viewer: Viewer, panel: Panel, drag: (dx: number, dy: number, isPan: boolean) => void, event: KeyboardEvent): boolean {
  const target = event.target as HTMLElement;
  if (event.ctrlKey || event.metaKey || event.altKey) return false;
  if (event.key === "Escape") {
    (target as HTMLInputElement).blur?.();
    panel.pick(null);
    return true;
  }
  // Lists and fields have keys of their own.
  if (["INPUT", "SELECT", "TEXTAREA"].includes(target.tagName) && (target as HTMLInputElement).type !== "checkbox") return false;
  const step = 40, arrows: Record<string, [number, number]> = {
    ArrowLeft: [step, 0], ArrowRight: [-step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] };
  const arrow = arrows[event.key];
  if (arrow) { drag(arrow[0], arrow[1], event.shiftKey); return true; }
  const zoom = (factor: number) => { viewer.camera.zoom(factor); viewer.redraw(); return true; };
  switch (event.key) {
    case "+": case "=": return zoom(1.25);
    case "-": return zoom(0.8);
    case "0": panel.fit(); return true;
    case "/": document.getElementById("find")!.focus(); return true;
    case "h": panel.toggle(); return true;
    case " ":
      if (target.tagName === "BUTTON" || viewer.meshes.length < 2) return false;
      panel.play();
      return true;
    case "[": case "]": {
      const count = viewer.meshes.length;
      panel.setMesh((viewer.current + (event.key === "]" ? 1 : count - 1)) % count);
      return true;
    }
    default: return panel.key(event.key);
  }
}
