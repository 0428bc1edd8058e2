// The playground in a browser, used as a person would, and held against the program.
//
//     node test/browser.mjs PAGE PROGRAM DATA [NAME...]       # only tests whose names have one of these words
//     node test/browser.mjs PAGE PROGRAM DATA --pictures DIR  # what it looks like
//     node test/browser.mjs PAGE PROGRAM DATA --measure       # how long it takes beside the program with one thread
//
// CHROMIUM names the browser; without it, Debian's.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { copyFileSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import puppeteer from "puppeteer-core";
import { measure, pictures } from "./looks.mjs";

const [file, program, data, ...words] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "voronaut-playground-"));
for (const name of ["aegean.geojson", "spot.obj"]) copyFileSync(join(data, name), join(folder, name));
const address = pathToFileURL(resolve(file)).href;
const browser = await puppeteer.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"],
  protocolTimeout: 900_000,
});
const sleep = (ms) => new Promise((done) => setTimeout(done, ms));
/** What the program says of words: what it writes to its standard error, and its files. */
const run = (...args) => spawnSync(resolve(program), args, { cwd: folder, encoding: "utf8" });
const read = (name) => readFileSync(join(folder, name));

/** The page, with what it asked for and what it complained of. */
async function open(size = { width: 1440, height: 900 }) {
  const page = await browser.newPage(), requests = [], complaints = [];
  await page.setViewport(size);
  page.on("request", (request) => requests.push(request.url()));
  page.on("console", (message) => { if (["error", "warn", "assert"].includes(message.type())) complaints.push(message.text()); });
  page.on("pageerror", (fault) => complaints.push(String(fault)));
  const session = await page.createCDPSession();
  await session.send("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: folder });
  await page.goto(address);
  await page.waitForFunction(() => document.documentElement.dataset.ready, { timeout: 120_000 });
  await idle(page);
  page.quiet = () => {
    assert.deepEqual(requests.filter((url) => url !== address && !/^(data|blob):/.test(url)), [], "no network request");
    assert.deepEqual(complaints.filter((text) => !/GPU stall|GL Driver Message/.test(text)), [], "no complaint");
  };
  return page;
}

/** Waits for the end of the work. */
async function idle(page, timeout = 600_000) {
  await sleep(60);
  await page.waitForFunction(() => document.documentElement.dataset.state === "idle" && !playground.engine.isBusy, { timeout, polling: 20 });
}
const text = (page, selector) => page.$eval(selector, (it) => (it.hidden ? "" : it.textContent));
const report = (page) => page.evaluate(() => playground.bench.made?.report);

/** Types into a field, in place of what is there. */
async function type(page, selector, words) {
  await page.$eval(selector, (it) => { it.focus(); it.select(); });
  await page.keyboard.type(words);
  await page.$eval(selector, (it) => it.blur());
}

async function choose(page, name) {
  const value = await page.$eval("#examples", (it, name) => [...it.options].find((option) => option.textContent.includes(name)).value, name);
  await page.select("#examples", "");
  await page.select("#examples", value);
  await idle(page);
}

/** Waits for a file that the page saves. */
async function saved(page, name, act) {
  rmSync(join(folder, name), { force: true });
  await act();
  for (let tries = 0; tries < 200 && !existsSync(join(folder, name)); tries++) await sleep(50);
  await sleep(50);
  return read(name);
}

/** What makes the mesh that is seen, by the program. */
async function theirs(page) {
  const shell = await text(page, "#shell");
  const args = execFileSync("bash", ["-c", `printf '%s\\0' ${shell}`]).toString().split("\0").slice(1, -1);
  const out = args[args.indexOf("-o") + 1];
  const { status, stderr } = run(...args, "--threads", "1", "--report", "theirs.json", "-q");
  assert.equal(status, 0, stderr);
  return { mesh: read(out), report: JSON.parse(read("theirs.json")), out };
}

/** That figures agree to three digits. */
function same(ours, other, path = "report") {
  for (const name of ["vertices", "triangles", "valid", "inverted", "euler"]) assert.equal(ours[name], other[name], `${path}.${name}`);
  for (const name of ["metric_edge_length", "quality", "angle"]) {
    for (const [key, value] of Object.entries(other[name])) {
      assert.equal(Number(ours[name][key]).toPrecision(3), Number(value).toPrecision(3), `${path}.${name}.${key}`);
    }
  }
}

const where = (page, p) => page.evaluate((p) => playground.stage.pixel(p).slice(0, 2), p);
async function clickAt(page, p) { await page.mouse.click(...(await where(page, p))); }
const cells = (page) => page.evaluate(() => [...voronaut.mesh.cells.cells].reduce((sum, cell, i) => (sum + (cell + 2) * (i % 977)) % 1_000_003, 0));

const tests = {
  async "it begins with a mesh"(page) {
    const found = await report(page);
    assert.equal(found.vertices, 2000);
    assert.ok(found.valid);
    assert.match(await text(page, "#figures"), /vertices2.000.*validyes/);
    assert.match(await text(page, "#facts"), /2.000 vertices/);
  },

  async "the Aegean is the program's"(page) {
    await choose(page, "Aegean");
    const other = await theirs(page), ours = await report(page);
    assert.equal(ours.vertices, 8000);
    same(ours, other.report);
    assert.ok((await saved(page, other.out, () => page.click("#save"))).equals(other.mesh), "the same bytes");
  },

  async "spot is the program's"(page) {
    await choose(page, "SPOT");
    const other = await theirs(page), ours = await report(page);
    assert.equal(ours.vertices, 1000);
    same(ours, other.report);
    assert.ok((await saved(page, other.out, () => page.click("#save"))).equals(other.mesh), "the same bytes");
  },

  async "every format is the program's"(page) {
    for (const ending of await page.$$eval("#ending option", (all) => all.map((it) => it.value))) {
      await page.select("#ending", ending);
      const name = await page.$eval("#shell", (it) => it.textContent.split(" -o ")[1].replace(/\.mesh$/, ""));
      const ours = await saved(page, `${name}.${ending}`, () => page.click("#save"));
      const shell = (await text(page, "#shell")).split(" ");
      const { status, stderr } = run(...shell.slice(1, -1), `theirs.${ending}`, "--threads", "1", "-q");
      assert.equal(status, 0, stderr);
      assert.ok(ours.equals(read(`theirs.${ending}`)), ending);
    }
    await saved(page, "rect-2000.html", () => page.click("#save-page"));
    assert.match(read("rect-2000.html").toString(), /data-sources/);
  },

  async "a mesh comes about stage by stage"(page) {
    await page.evaluate(() => {
      const seen = (window.seen = new Set()), { stage } = playground, sketch = stage.sketch.bind(stage);
      stage.sketch = (points, triangles, title) => { seen.add(`${document.getElementById("stage").textContent} ${triangles.length}`); sketch(points, triangles, title); };
    });
    await choose(page, "Aegean");
    const seen = await page.evaluate(() => [...window.seen]);
    assert.ok(seen.some((it) => it.startsWith("seeding")) && seen.some((it) => it.startsWith("relaxing")), seen.join());
    assert.ok(await page.evaluate(() => ["planning", "seeding", "relaxing", "settling edges", "checking"].every((it) => playground.progress.seen.includes(it))));
  },

  async "a wrong formula is refused at its field, at its column"(page) {
    await type(page, "#metric", "formula:1/(0.01+x; 0; 1");
    await idle(page);
    const { stderr } = run("mesh", "rect:-1,-1,1,1", "--metric", "formula:1/(0.01+x; 0; 1", "-n", "2000", "-o", "a.mesh");
    assert.equal((await text(page, "#metric-fault")).replace("\nhelp", "\n  help").trim(), stderr.trim());
    assert.equal(await page.$eval("#metric", (it) => it.value.slice(it.selectionStart - 1, it.selectionStart)), "x");
    await type(page, "#metric", "uniform");
    await idle(page);
    assert.equal(await text(page, "#metric-fault"), "");
    assert.ok((await report(page)).valid);
  },

  async "a polygon that is drawn is meshed, and refused where it crosses itself"(page) {
    await page.click("[data-tool=draw]");
    for (const p of [[-0.8, -0.6, 0], [0.8, -0.6, 0], [0, 0.8, 0], [-0.8, -0.6, 0]]) await clickAt(page, p);
    await idle(page);
    assert.ok((await report(page)).valid);
    assert.equal((await report(page)).euler, 1);
    // With a hole.
    await page.click("[data-tool=draw]");
    const outer = [[-0.9, -0.9, 0], [0.9, -0.9, 0], [0.9, 0.9, 0], [-0.9, 0.9, 0]], inner = [[-0.3, -0.3, 0], [0, 0.4, 0], [0.3, -0.3, 0]];
    for (const p of outer) await clickAt(page, p);
    await page.keyboard.down("Shift");
    await clickAt(page, outer[0]);
    await page.keyboard.up("Shift");
    for (const p of inner) await clickAt(page, p);
    await page.keyboard.press("Enter");
    await idle(page);
    assert.equal((await report(page)).euler, 0);
    await page.click("[data-tool=draw]");
    for (const p of [[-0.5, -0.5, 0], [0.5, 0.5, 0], [0.5, -0.5, 0], [-0.5, 0.5, 0], [-0.5, -0.5, 0]]) await clickAt(page, p);
    await idle(page);
    writeFileSync(join(folder, "drawn.geojson"), await page.evaluate(() => new TextDecoder().decode(playground.engine.file("drawn.geojson"))));
    const { stderr } = run("mesh", "drawn.geojson", "--metric", "uniform", "-n", "100", "-o", "a.mesh");
    assert.match(stderr, /crosses or overlaps itself/);
    assert.equal((await text(page, "#domain-fault")).replace("\nhelp", "\n  help").trim(), stderr.trim());
    const [x, y] = await page.evaluate(() => playground.ink.fault);
    assert.ok(Math.hypot(x, y) < 0.02, "a cross where it crosses");
  },

  async "a broken file is refused, with its line"(page) {
    writeFileSync(join(folder, "broken.mesh"), "MeshVersionFormatted 2\nDimension 2\nVertices 4\n0 0 0\n1 0 0\n1 x 0\n0 1 0\nEnd\n");
    await (await page.$("#opener")).uploadFile(join(folder, "broken.mesh"));
    await sleep(300);
    await idle(page);
    const { stderr } = run("mesh", "broken.mesh", "--metric", "uniform", "-n", "100", "-o", "a.mesh"), told = await text(page, "#domain-fault");
    const [what, help] = stderr.trim().split("\n  ");
    assert.ok(told.startsWith(what) && told.endsWith(help) && told.includes("\n  1 x 0\n"), `${told}\n${stderr}`);
  },

  async "files of every kind are opened"(page) {
    writeFileSync(join(folder, "hole.poly"), "8 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n5 1 1\n6 2 1\n7 2 2\n8 1 2\n8 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n5 5 6\n6 6 7\n7 7 8\n8 8 5\n1\n1 1.5 1.5\n");
    run("convert", "spot.obj", "spot.mesh");
    await type(page, "#metric", "uniform");
    for (const [name, planar] of [["hole.poly", true], ["aegean.geojson", true], ["spot.mesh", false], ["spot.obj", false]]) {
      await (await page.$("#opener")).uploadFile(join(folder, name));
      await sleep(300);
      await idle(page);
      assert.equal(await page.$eval("#domain", (it) => it.value), name);
      assert.ok((await report(page))?.valid, await page.$eval("#bench", (it) => it.innerText));
      assert.equal(await page.evaluate(() => playground.stage.isPlanar), planar);
    }
  },

  async "cancel ends the work within half a second, and work goes on after it"(page) {
    await page.evaluate(() => { document.getElementById("domain").value = "rect:-1,-1,1,1"; document.getElementById("metric").value = "shock:phi=10,lambda=0.06"; });
    await type(page, "#vertices", "30000");
    await page.waitForFunction(() => document.getElementById("stage").textContent === "relaxing", { timeout: 120_000 });
    await sleep(500);
    const took = await page.evaluate(async () => {
      const start = performance.now();
      document.getElementById("cancel").click();
      // The module is there again when it answers.
      await playground.engine.ask({ do: "look", domain: "rect:0,0,1,1" });
      return performance.now() - start;
    });
    assert.ok(took < 500, `${took} ms`);
    console.log(`    cancelled, and ready again, within ${took.toFixed(0)} ms`);
    await choose(page, "Shock, mild");
    assert.ok((await report(page)).valid);
  },

  async "cells and dual follow a seed"(page) {
    await page.click("[data-tool=seeds]");
    await idle(page);
    await page.waitForFunction(() => voronaut.mesh.cells && voronaut.mesh.vertices === 24, { timeout: 60_000 });
    const before = await cells(page), seed = await page.evaluate(() => playground.ink.seeds[0]);
    const [x, y] = await where(page, seed);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 40, y - 30, { steps: 8 });
    await page.waitForFunction((before) => playground.ink.held === 0 && voronaut.mesh.vertices === 24 && before !== undefined, {}, before);
    await page.mouse.up();
    await sleep(200);
    await idle(page);
    await page.waitForFunction((p) => playground.ink.seeds[0][0] !== p[0] && !playground.engine.isBusy, {}, seed);
    assert.notEqual(await cells(page), before);
    // The dual's vertex is where the seed is now.
    const away = await page.evaluate(() => { const s = playground.ink.seeds[0], v = voronaut.mesh.vertexOf(1); return Math.hypot(...voronaut.mesh.at(v).map((x, k) => x - s[k])); });
    assert.ok(away < 1e-6, `${away}`);
  },

  async "a geodesic between two clicks has the program's length"(page) {
    await page.click("[data-tool=geodesic]");
    const [from, to] = [[-0.7, -0.5, 0], [0.6, 0.4, 0]];
    await clickAt(page, from);
    await clickAt(page, to);
    await page.waitForFunction(() => /distance in the metric\d/.test(document.getElementById("way").textContent), { timeout: 60_000 });
    const ends = await page.evaluate(() => playground.ink.ends.map((p) => p.slice(0, 2).join(",")));
    const { stderr } = run("distance", "rect:-1,-1,1,1", "--metric", "shock:phi=1,lambda=0.6", `--from=${ends[0]}`, `--to=${ends[1]}`, "-o", "way.vtu", "--report", "way.json", "--threads", "1", "--canvas-size", "15000", "-q");
    assert.equal(stderr, "");
    const told = Number((await text(page, "#way")).match(/metric([\d.]+?)(?=edges|$)/)[1]), other = JSON.parse(read("way.json")).distance;
    assert.equal(told.toPrecision(3), other.toPrecision(3));
    assert.ok(await page.evaluate(() => playground.ink.path.length) > 3);
  },

  async "a geodesic on a surface"(page) {
    await choose(page, "Sphere");
    await page.click("[data-tool=geodesic]");
    const [x, y] = await where(page, [0, 0, 0]);
    await page.mouse.click(x - 60, y - 20);
    await page.mouse.click(x + 70, y + 40);
    await page.waitForFunction(() => /distance in the metric\d/.test(document.getElementById("way").textContent), { timeout: 60_000 });
    assert.ok(await page.evaluate(() => playground.ink.path.length) > 3);
  },

  async "an ellipse is under the pointer"(page) {
    const count = () => page.evaluate(() => {
      const canvas = document.getElementById("ink"), { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      return data.reduce((sum, x, i) => sum + (i % 4 === 3 && x > 0 ? 1 : 0), 0);
    });
    await page.mouse.move(...(await where(page, [0.2, 0.1, 0])));
    await sleep(300);
    assert.ok(await count() > 20);
    await page.click("#ellipse");
    await page.mouse.move(...(await where(page, [0.2, 0.11, 0])));
    await sleep(300);
    assert.equal(await count(), 0);
  },

  async "the number of vertices follows the slider"(page) {
    await page.focus("#count");
    for (let i = 0; i < 3; i++) await page.keyboard.press("ArrowLeft");
    await sleep(400);
    await idle(page);
    const asked = Number(await page.$eval("#vertices", (it) => it.value));
    assert.ok(asked < 2000 && (await report(page)).vertices === asked, `${asked}`);
  },

  async "what makes the same elsewhere is said"(page) {
    await type(page, "#metric", "formula:1/(0.01 + 0.2*abs(y))^2; 0; 25");
    await idle(page);
    assert.equal(await text(page, "#shell"), "voronaut mesh rect:-1,-1,1,1 --metric 'formula:1/(0.01 + 0.2*abs(y))^2; 0; 25' -n 2000 -o rect-2000.mesh");
    assert.match(await text(page, "#python"), /voronaut\.mesh\("rect:-1,-1,1,1", "formula:1\/\(0\.01 \+ 0\.2\*abs\(y\)\)\^2; 0; 25", n=2000\)/);
    const other = await theirs(page);
    same(await report(page), other.report);
    assert.ok((await saved(page, other.out, () => page.click("#save"))).equals(other.mesh), "the same bytes");
    await page.click("#copy-shell");
    await page.waitForFunction(() => document.getElementById("copy-shell").textContent === "copied");
  },

  async "every example makes a valid mesh"(page) {
    for (const name of await page.$$eval("#examples option", (all) => all.slice(1).map((it) => it.textContent))) {
      await choose(page, name);
      assert.ok((await report(page))?.valid, `${name}: ${await page.$eval("#bench", (it) => it.innerText)}`);
    }
  },
};

try {
  if (words[0] === "--pictures") await pictures({ open, choose, idle, where, folder: words[1] });
  else if (words[0] === "--measure") await measure({ open, choose, idle, report, type, theirs });
  else {
    let count = 0;
    for (const [name, test] of Object.entries(tests)) {
      if (words.length > 0 && !words.some((word) => name.includes(word))) continue;
      const start = performance.now(), page = await open();
      await test(page).catch((fault) => { console.error(`FAILED: ${name}`); throw fault; });
      page.quiet();
      await page.close();
      console.log(`ok: ${name} (${((performance.now() - start) / 1000).toFixed(1)} s)`);
      count++;
    }
    console.log(`${count} passed, 0 failed`);
  }
} finally {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
