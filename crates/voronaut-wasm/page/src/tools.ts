// What hands do over the mesh besides looking at it: draw a domain, move seeds, click the ends of a geodesic.

import type { Ink } from "./ink";
import type { Stage } from "./stage";

export type Tool = "look" | "draw" | "seeds" | "geodesic";
type Point = [number, number, number];

export interface Told {
  /** Rings of a domain that is drawn to its end. */
  drawn(rings: Point[][]): void;
  /** Seeds have moved. */
  moved(): void;
  /** Two points are clicked. */
  ends(from: Point, to: Point): void;
}

const NEAR = 12;

export class Tools {
  tool: Tool = "look";

  constructor(private readonly canvas: HTMLCanvasElement, private readonly stage: Stage, private readonly ink: Ink, private readonly told: Told) {
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => { canvas.releasePointerCapture(event.pointerId); this.up(); });
    canvas.addEventListener("dblclick", (event) => { if (this.tool === "draw") this.close(event.shiftKey); });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    // What is seen moves as without a tool.
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      stage.viewer.canvas.dispatchEvent(new WheelEvent("wheel", event));
    }, { passive: false });
    stage.viewer.canvas.addEventListener("pointermove", (event) => this.hover([event.clientX, event.clientY]));
    stage.viewer.canvas.addEventListener("pointerleave", () => this.hover(null));
    window.addEventListener("keydown", (event) => this.press(event), { capture: true });
    this.listen();
  }

  private listen() {
    for (const button of document.querySelectorAll<HTMLButtonElement>("[data-tool]")) {
      button.addEventListener("click", () => this.take(this.tool === button.dataset["tool"] ? "look" : (button.dataset["tool"] as Tool)));
    }
  }

  take(tool: Tool) {
    this.tool = tool;
    this.canvas.classList.toggle("is-on", tool !== "look");
    for (const button of document.querySelectorAll<HTMLButtonElement>("[data-tool]")) {
      button.setAttribute("aria-pressed", `${button.dataset["tool"] === tool}`);
    }
    const { ink } = this;
    [ink.ends, ink.path, ink.fault, ink.held] = [[], [], null, -1];
    if (tool !== "draw") { ink.rings = []; ink.isOpen = false; }
    document.dispatchEvent(new CustomEvent<Tool>("tool", { detail: tool }));
    this.stage.viewer.redraw();
  }

  private at(event: PointerEvent) { return this.stage.pointAt(event.clientX, event.clientY); }

  private down(event: PointerEvent) {
    if (event.button !== 0) return;
    const { ink } = this, p = this.at(event);
    this.canvas.setPointerCapture(event.pointerId);
    if (this.tool === "draw" && p) this.corner(p, event);
    else if (this.tool === "seeds") ink.held = this.near(ink.seeds, event);
    else if (this.tool === "geodesic" && p) {
      if (ink.ends.length !== 1) [ink.ends, ink.path] = [[p], []];
      else { ink.ends.push(p); this.told.ends(ink.ends[0], p); }
    }
    this.stage.viewer.redraw();
  }

  /** One more corner of a ring; the first one again closes it. */
  private corner(p: Point, event: PointerEvent) {
    const { ink } = this, last = ink.rings[ink.rings.length - 1];
    if (!ink.isOpen) { ink.rings.push([p]); ink.isOpen = true; return; }
    if (last.length >= 3 && this.near([last[0]], event) === 0) this.close(event.shiftKey);
    // The second half of a double click.
    else if (this.near(last.slice(-1), event) !== 0) last.push(p);
  }

  /** Ends a ring, and the domain unless a hole is to follow. */
  private close(isFollowed: boolean) {
    const { ink } = this, last = ink.rings[ink.rings.length - 1];
    if (!ink.isOpen || last.length < 3) return;
    ink.isOpen = false;
    if (!isFollowed) this.told.drawn(ink.rings);
    this.stage.viewer.redraw();
  }

  private move(event: PointerEvent) {
    const { ink } = this;
    this.hover([event.clientX, event.clientY]);
    if (this.tool !== "seeds" || ink.held < 0) return;
    const p = this.at(event);
    if (!p) return;
    ink.seeds[ink.held] = p;
    this.told.moved();
  }

  private up() {
    if (this.ink.held < 0) return;
    this.ink.held = -1;
    this.told.moved();
  }

  private hover(pointer: [number, number] | null) {
    this.ink.pointer = pointer;
    this.stage.viewer.redraw();
  }

  private near(points: Point[], event: PointerEvent) {
    const away = points.map((p) => { const [x, y] = this.stage.pixel(p); return Math.hypot(x - event.clientX, y - event.clientY); });
    const nearest = away.indexOf(Math.min(...away));
    return nearest >= 0 && away[nearest] < NEAR ? nearest : -1;
  }

  private press(event: KeyboardEvent) {
    const { ink } = this;
    if (this.tool === "look" || /INPUT|TEXTAREA|SELECT/.test((event.target as HTMLElement).tagName)) return;
    if (event.key === "Escape") this.take("look");
    else if (event.key === "Enter" && this.tool === "draw") this.close(event.shiftKey);
    else if (event.key === "Backspace" && ink.isOpen) {
      ink.rings[ink.rings.length - 1].pop();
      if (ink.rings[ink.rings.length - 1].length === 0) { ink.rings.pop(); ink.isOpen = false; }
      this.stage.viewer.redraw();
    } else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
