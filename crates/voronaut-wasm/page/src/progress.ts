// How far the work is, and the way to end it.

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;

export class Progress {
  private total = 1;
  private stages: string[] = [];

  begin() {
    this.stages = [];
    element("progress").hidden = false;
    element("go").hidden = true;
    this.stage("starting", 1);
  }

  end() {
    element("progress").hidden = true;
    element("go").hidden = false;
  }

  stage(name: string, total: number) {
    this.total = Math.max(total, 1);
    if (!this.stages.includes(name)) this.stages.push(name);
    element("stage").textContent = name;
    this.done(0);
  }

  done(units: number) { element<HTMLProgressElement>("bar").value = Math.min(units / this.total, 1); }

  /** The stages that there were, for tests. */
  get seen(): readonly string[] { return this.stages; }
}
