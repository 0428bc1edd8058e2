// Pages in a browser, used as a person would: by mouse, fingers and keys, and judged by what is shown.
//
//     node test/browser.mjs PROGRAM [NAME...]      # voronaut's program; only tests whose names have one of these words
//     node test/browser.mjs PROGRAM --measure      # times of frames and of loading, and the sizes of pages
//     node test/browser.mjs PROGRAM --pictures DIR PAGE...   # a picture of each page, light and dark
//
// CHROMIUM names the browser; without it, Debian's.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import puppeteer from "puppeteer-core";
import { grid } from "./meshes.mjs";

const [program, ...words] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "voronaut-page-"));
const run = (...args) => execFileSync(resolve(program), [...args, "-q"], { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });
const browser = await puppeteer.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"],
});
const sleep = (ms) => new Promise((done) => setTimeout(done, ms));

/** A page, with what it asked for and what it complained of. */
async function open(name, size = { width: 1280, height: 800 }) {
  const page = await browser.newPage();
  await page.setViewport(size);
  const [requests, complaints] = [[], []];
  page.on("request", (request) => requests.push(request.url()));
  page.on("console", (message) => { if (["error", "warn", "assert"].includes(message.type())) complaints.push(message.text()); });
  page.on("pageerror", (fault) => complaints.push(String(fault)));
  const address = pathToFileURL(resolve(folder, name)).href;
  await page.goto(address);
  await page.waitForFunction(() => document.documentElement.dataset.ready, { timeout: 120000 });
  assert.equal(await page.evaluate(() => document.documentElement.dataset.ready), "true");
  page.quiet = () => {
    assert.deepEqual(requests.filter((url) => url !== address && !/^(data|blob):/.test(url)), [], "no network request");
    // Chromium remarks on the time that reading pixels takes.
    assert.deepEqual(complaints.filter((text) => !/GPU stall|GL Driver Message/.test(text)), [], "no complaint");
  };
  return page;
}

/** The pixels of a part of what is shown. */
async function pixels(page, clip) {
  await settle(page);
  const png = await page.screenshot({ encoding: "base64", clip });
  const list = await page.evaluate(async (data) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height), context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    return [...context.getImageData(0, 0, image.width, image.height).data];
  }, png);
  return Array.from({ length: list.length / 4 }, (_, i) => list.slice(4 * i, 4 * i + 3));
}

const middle = { x: 300, y: 120, width: 600, height: 560 };
/** Waits until what was asked for is drawn. */
const settle = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done)))));

/** How much of the middle is not paper, and how many colours it has. */
async function seen(page) {
  const all = await pixels(page, middle);
  const paper = await page.evaluate(() => voronaut.inks.paper);
  const drawn = all.filter((p) => p.some((x, k) => Math.abs(x - paper[k]) > 6));
  return { share: drawn.length / all.length, colours: new Set(all.map((p) => p.map((x) => x >> 3).join())).size, all };
}
const differ = (a, b) => a.filter((p, i) => p.some((x, k) => Math.abs(x - b[i][k]) > 12)).length / a.length;

const text = (page, selector) => page.$eval(selector, (it) => it.textContent);
const isShown = (page, selector) => page.$eval(selector, (it) => !it.hidden);
/** Where a vertex, or the middle of a triangle, is on the screen. */
const where = (page, kind, index) => page.evaluate((kind, index) => {
  const { mesh, scene, camera } = voronaut;
  const list = kind === "vertex" ? [index] : [...mesh.corners.subarray(3 * index, 3 * index + 3)];
  const all = list.map((v) => camera.project(scene.place(mesh.positions, v)));
  return [0, 1].map((k) => all.reduce((sum, p) => sum + p[k], 0) / all.length);
}, kind, index);

/** The triangle that is largest on the screen. */
const largest = (page) => page.evaluate(() => {
  const { mesh, scene, camera } = voronaut, areas = [];
  for (let t = 0; t < mesh.triangles; t++) {
    const [p, q, r] = [0, 1, 2].map((k) => camera.project(scene.place(mesh.positions, mesh.corners[3 * t + k])));
    areas.push(Math.abs((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])));
  }
  return areas.indexOf(Math.max(...areas));
});

/** Vertices and triangles of a file, to hold figures against. */
function medit(name) {
  const words = readFileSync(join(folder, name), "utf8").split(/\s+/);
  const section = (title, columns) => {
    const at = words.indexOf(title), count = Number(words[at + 1]);
    return Array.from({ length: count }, (_, i) => words.slice(at + 2 + columns * i, at + 2 + columns * (i + 1)).map(Number));
  };
  const dimension = Number(words[words.indexOf("Dimension") + 1]);
  return { dimension, vertices: section("Vertices", dimension + 1), triangles: section("Triangles", 4) };
}

async function dragOn(page, selector, from, to) {
  const box = await (await page.$(selector)).boundingBox();
  await page.mouse.move(box.x + from * box.width, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + to * box.width, box.y + box.height / 2, { steps: 6 });
  await page.mouse.up();
  await sleep(250);
}

const tests = {
  async "a plane mesh is drawn with its figures"(page) {
    const { share, colours } = await seen(page);
    assert.ok(share > 0.3 && colours > 60, `${share} ${colours}`);
    const { vertices, triangles } = medit("disk.mesh");
    const facts = (await text(page, "#facts")).replaceAll("\u2009", "").replaceAll("\u202f", "");
    assert.match(facts.replace(/(\d)\D(\d{3})/g, "$1$2"), new RegExp(`${vertices.length} vertices · ${triangles.length} triangles`));
    assert.match(await text(page, "#foot"), /26 bits \([\d.]+ bits a triangle\)/);
  },

  async "hovering tells of the vertex of the file"(page) {
    const { vertices } = medit("disk.mesh");
    const number = 700;
    const at = await page.evaluate((number) => voronaut.mesh.vertexOf(number), number);
    const [x, y] = await where(page, "vertex", at);
    await page.mouse.move(x + 1, y);
    await sleep(600);
    assert.ok(await isShown(page, "#tip"));
    const told = await text(page, "#tip");
    assert.match(told, /^Vertex 700/);
    const coordinates = told.match(/x, y([−\d.e]+), ([−\d.e]+?)(?=[a-z])/).slice(1).map((word) => Number(word.replace("−", "-")));
    coordinates.forEach((x, k) => assert.ok(Math.abs(x - vertices[number - 1][k]) < 1e-7, `${told} ${vertices[number - 1]}`));
    assert.match(told, /sizes asked for/);
  },

  async "hovering tells of edges and their metric length"(page) {
    const t = await largest(page);
    const spot = await page.evaluate((t) => {
      const { mesh, scene, camera } = voronaut;
      const edges = [0, 1, 2].map((k) => {
        const e = mesh.edgesOf[3 * t + k];
        const [p, q] = [0, 1].map((i) => camera.project(scene.place(mesh.positions, mesh.edges[2 * e + i])));
        return { size: Math.hypot(p[0] - q[0], p[1] - q[1]), x: (p[0] + q[0]) / 2, y: (p[1] + q[1]) / 2, length: mesh.field("length").values[e] };
      });
      return edges.sort((a, b) => b.size - a.size)[0];
    }, t);
    await page.mouse.move(spot.x, spot.y);
    await sleep(600);
    const told = await text(page, "#tip");
    assert.match(told, /^Edge \d+–\d+/);
    const length = Number(told.match(/length in the metric([\d.]+)/)[1]);
    assert.ok(Math.abs(length - spot.length) < 1e-6 && length > 0.1 && length < 10, told);
  },

  async "clicking picks the triangle of the file"(page) {
    const { triangles } = medit("disk.mesh");
    const t = await largest(page);
    // Near enough for its middle to be far from its corners and sides, which hands reach first.
    for (let turn = 0; turn < 3; turn++) {
      await page.mouse.move(...(await where(page, "triangle", t)));
      await page.mouse.wheel({ deltaY: -800 });
      await settle(page);
    }
    await page.mouse.click(...(await where(page, "triangle", t)));
    await sleep(500);
    const told = await text(page, "#picked");
    assert.match(told, /^✕Triangle/);
    const number = Number(told.match(/Triangle ([\d\s]+?)vertices/)[1].replace(/\s/g, ""));
    const corners = told.match(/vertices(\d+), (\d+), (\d+?)quality/).slice(1).map(Number);
    const sorted = (list) => [...list].sort((a, b) => a - b);
    assert.deepEqual(sorted(corners), sorted(triangles[number - 1].slice(0, 3)), told);
    await page.keyboard.press("Escape");
    assert.ok(!(await isShown(page, "#picked")));
    await page.click("#fit");
  },

  async "brushing a histogram selects and fades"(page) {
    await page.select("#colour", "quality");
    // Away from the mesh, for nothing is to be told over it.
    await page.mouse.move(940, 790);
    await sleep(300);
    const before = (await seen(page)).all;
    // Qualities are from 0 to 1: half of the triangles.
    const half = await page.evaluate(() => [...voronaut.mesh.field("quality").values].sort((a, b) => a - b)[voronaut.mesh.triangles >> 1]);
    await dragOn(page, '[data-of="quality"] svg', 0.0, half);
    const said = (await text(page, '[data-of="quality"] output')).replace(/\s/g, "");
    const [chosen, all] = said.match(/(\d+)of(\d+)triangles/).slice(1).map(Number);
    assert.ok(Math.abs(chosen - all / 2) <= 0.06 * all, said);
    assert.ok(differ(before, (await seen(page)).all) > 0.1, "the others fade");
    await dragOn(page, '[data-of="length"] svg', 0.6, 1);
    assert.match(await text(page, '[data-of="length"] output'), /edges/);
    for (const name of ["quality", "length"]) {
      await page.$eval(`[data-of="${name}"] svg`, (it) => it.focus());
      await page.keyboard.press("Escape");
    }
    await sleep(300);
    assert.ok(differ(before, (await seen(page)).all) < 0.01, "and come back");
  },

  async "finding goes to a number"(page) {
    await page.evaluate(() => document.activeElement.blur());
    await page.keyboard.press("/");
    await page.keyboard.type("vertex 17");
    await page.keyboard.press("Enter");
    await sleep(400);
    assert.match(await text(page, "#picked"), /^✕Vertex 17/);
    const [x, y] = await where(page, "vertex", await page.evaluate(() => voronaut.mesh.vertexOf(17)));
    assert.ok(Math.hypot(x - (1280 - 316) / 2, y - 400) < 2, `${x} ${y}`);
    await page.click("#find", { clickCount: 3 });
    await page.keyboard.type("triangle 99999999");
    await page.keyboard.press("Enter");
    assert.match(await text(page, "#missing"), /none of that number/);
    await page.keyboard.press("Escape");
    await page.click("#fit");
  },

  async "cells, distances, ellipses and why edges are not unit are shown"(page) {
    const looks = {};
    for (const name of ["Voronoi cells", "distance in the metric", "cause", "length", "nothing"]) {
      await page.select("#colour", name);
      await sleep(300);
      looks[name] = await seen(page);
      assert.ok(looks[name].share > 0.3, name);
    }
    assert.ok(differ(looks["Voronoi cells"].all, looks["distance in the metric"].all) > 0.2);
    assert.ok(differ(looks["cause"].all, looks["nothing"].all) > 0.01);
    await page.select("#colour", "cause");
    assert.match(await text(page, "#legend"), /unit length.*boundary.*count.*turning metric.*irregular/s);
    await page.select("#colour", "nothing");
    await page.click('[data-layer="ellipses"]');
    await sleep(400);
    assert.ok(differ((await seen(page)).all, looks["nothing"].all) > 0.02);
    await page.click('[data-layer="ellipses"]');
    await page.select("#colour", "quality");
  },

  async "keys and wheel move, dark is dark"(page) {
    const before = await page.evaluate(() => ({ scale: voronaut.camera.scale, edges: voronaut.layers.edges }));
    await page.focus("#view");
    await page.keyboard.press("e");
    assert.notEqual(await page.evaluate(() => voronaut.layers.edges), before.edges);
    await page.keyboard.press("e");
    await page.mouse.move(500, 400);
    await page.mouse.wheel({ deltaY: -400 });
    await page.keyboard.press("+");
    await sleep(200);
    assert.ok((await page.evaluate(() => voronaut.camera.scale)) > 1.5 * before.scale);
    await page.keyboard.press("0");
    await page.click("#theme");
    await sleep(300);
    const [paper] = await pixels(page, { x: 20, y: 700, width: 1, height: 1 });
    assert.ok(paper.every((x) => x < 60), `${paper}`);
    await page.click("#theme");
  },

  async "pictures are saved"(page) {
    const session = await browser.target().createCDPSession();
    const downloads = mkdtempSync(join(folder, "downloads-"));
    await session.send("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: downloads });
    for (const id of ["png", "svg"]) await page.click(`#${id}`);
    for (let tries = 0; tries < 40 && readdirSync(downloads).filter((name) => /\.(png|svg)$/.test(name)).length < 2; tries++) await sleep(250);
    const [png, svg] = ["disk.png", "disk.svg"].map((name) => readFileSync(join(downloads, name)));
    assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], [1280, 800]);
    assert.ok(png.length > 30000);
    const { triangles } = medit("disk.mesh");
    assert.ok(svg.toString().split("<path").length > triangles.length && svg.toString().includes("quality in the metric"));
  },

  async "steps are played, and two are compared"() {
    const page = await open("steps.html");
    const first = await text(page, "#facts");
    await page.focus("#step");
    await page.keyboard.press("ArrowRight");
    await sleep(300);
    assert.equal(await text(page, "#which"), "2/3");
    assert.notEqual(await text(page, "#facts"), first);
    await page.click("#play");
    await sleep(1300);
    assert.notEqual(await text(page, "#which"), "2/3");
    await page.click("#play");
    await page.focus("#step");
    await page.keyboard.press("Home");
    await page.select("#compare", "2");
    await sleep(400);
    assert.ok(await isShown(page, "#divider"));
    assert.match(await text(page, "#names"), /step-1.*step-3/);
    const before = await pixels(page, { x: 300, y: 200, width: 200, height: 300 });
    const box = await (await page.$("#divider")).boundingBox();
    await page.mouse.move(box.x + 11, 500);
    await page.mouse.down();
    await page.mouse.move(250, 500, { steps: 5 });
    await page.mouse.up();
    await sleep(400);
    assert.ok(differ(before, await pixels(page, { x: 300, y: 200, width: 200, height: 300 })) > 0.05, "the other mesh is there now");
    page.quiet();
    await page.close();
  },

  async "a surface is turned and cut"() {
    const page = await open("torus.html");
    const before = await seen(page);
    await page.mouse.move(500, 400);
    await page.mouse.down();
    await page.mouse.move(600, 450, { steps: 5 });
    await page.mouse.up();
    await sleep(300);
    const turned = await seen(page);
    assert.ok(differ(before.all, turned.all) > 0.05, `${differ(before.all, turned.all)} of ${before.share}`);
    await page.select("#axis", "2");
    await page.focus("#clip");
    for (let i = 0; i < 60; i++) await page.keyboard.press("ArrowLeft");
    await sleep(300);
    const cut = await seen(page);
    assert.ok(differ(turned.all, cut.all) > 0.05, "something is cut away");
    await page.keyboard.press("Home");
    await sleep(300);
    assert.ok((await seen(page)).share < 0.02, "all is cut away");
    page.quiet();
    await page.close();
  },

  async "fingers pinch, on a small screen"() {
    const page = await open("disk.html", { width: 390, height: 780, hasTouch: true, isMobile: true });
    const scale = () => page.evaluate(() => voronaut.camera.scale);
    const before = await scale(), session = await page.createCDPSession();
    const touch = (type, ...points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
    await touch("touchStart", [150, 300], [240, 300]);
    for (let i = 1; i <= 5; i++) await touch("touchMove", [150 - 15 * i, 300], [240 + 15 * i, 300]);
    await touch("touchEnd");
    assert.ok((await scale()) > 1.8 * before);
    page.quiet();
    await page.close();
  },

  async "a page without WebGL says so"() {
    const page = await browser.newPage();
    await page.evaluateOnNewDocument(() => { HTMLCanvasElement.prototype.getContext = () => null; });
    await page.goto(pathToFileURL(join(folder, "disk.html")).href);
    await page.waitForFunction(() => document.documentElement.dataset.ready === "false", { timeout: 60000 });
    assert.match(await text(page, "#wait"), /WebGL2/);
    await page.close();
  },
};

function makePages() {
  run("mesh", "disk:0,0,1", "--metric", "swirl", "-n", "1500", "-o", "disk.mesh", "--view", "disk.html", "--cells");
  for (const i of [1, 2, 3]) run("mesh", "rect:0,0,1,1", "--metric", `formula:1/(0.01+0.1*abs(y-${0.2 * i}))^2; 0; 40`, "-n", `${300 * i}`, "-o", `step-${i}.mesh`);
  run("view", "step-1.mesh", "step-2.mesh", "step-3.mesh", "-o", "steps.html");
  run("mesh", "torus:1,0.4", "--metric", "curvature", "-n", "800", "-o", "torus.mesh", "--view", "torus.html");
}

async function test(names) {
  makePages();
  const page = await open("disk.html");
  await page.select("#colour", "quality");
  for (const layer of ["edges", "geodesics"]) await page.click(`[data-layer="${layer}"]`);
  let failures = 0;
  for (const [name, act] of Object.entries(tests)) {
    if (names.length > 0 && !names.some((word) => name.includes(word))) continue;
    try {
      await page.bringToFront();
      await act(page);
      console.log(`ok      ${name}`);
    } catch (fault) {
      failures++;
      console.log(`FAILED  ${name}\n${fault.stack}`);
    }
  }
  page.quiet();
  return failures;
}

/** Milliseconds that the browser's processes have worked so far, all together. */
function worked() {
  const all = readdirSync("/proc").filter((name) => /^\d+$/.test(name)).flatMap((name) => {
    try {
      const told = readFileSync(`/proc/${name}/stat`, "utf8"), words = told.slice(told.lastIndexOf(")") + 2).split(" ");
      return [{ pid: Number(name), parent: Number(words[1]), ms: 10 * (Number(words[11]) + Number(words[12])) }];
    } catch {
      return [];
    }
  });
  const ours = new Set([browser.process().pid]);
  for (let size = 0; size < ours.size;) {
    size = ours.size;
    for (const it of all) if (ours.has(it.parent)) ours.add(it.pid);
  }
  return all.filter((it) => ours.has(it.pid)).reduce((sum, it) => sum + it.ms, 0);
}

/** Times by the clock; with other work on the machine they say little. */
async function measure() {
  console.log("kind   triangles  page MB  written s  load ms  turned frames/s  frame ms  processor ms/frame  script ms/frame");
  for (const kind of ["plane", "torus"]) {
    for (const count of [1e4, 1e5, 1e6]) {
      writeFileSync(join(folder, "g.mesh"), grid(kind, count));
      run("convert", "g.mesh", "g.meshb");
      run("view", "g.meshb", "-o", "g.html", "--report", "g.json");
      const { seconds } = JSON.parse(readFileSync(join(folder, "g.json"), "utf8"));
      const page = await open("g.html");
      const load = await page.evaluate(() => voronaut.course.loadMs);
      await page.evaluate(() => { voronaut.measure(3); });
      const before = worked();
      const { frame, own } = await page.evaluate(() => voronaut.measure(10));
      const busy = (worked() - before) / 10;
      await page.mouse.move(450, 400);
      await page.mouse.down();
      const [start, frames] = [performance.now(), await page.evaluate(() => voronaut.course.frames)];
      for (let i = 0; performance.now() - start < 4000; i++) await page.mouse.move(450 + 100 * Math.sin(i / 20), 400 + 60 * Math.cos(i / 23));
      const rate = ((await page.evaluate(() => voronaut.course.frames)) - frames) / ((performance.now() - start) / 1000);
      await page.mouse.up();
      const size = statSync(join(folder, "g.html")).size / 1e6;
      console.log([kind.padEnd(6), String(count).padStart(9), size.toFixed(2).padStart(8), seconds.total.toFixed(2).padStart(10),
        load.toFixed(0).padStart(8), rate.toFixed(1).padStart(16), frame.toFixed(0).padStart(9), busy.toFixed(0).padStart(19), own.toFixed(2).padStart(16)].join(" "));
      page.quiet();
      await page.close();
    }
  }
}

async function pictures(to, names) {
  for (const name of names) {
    const page = await open(resolve(name));
    await sleep(500);
    await page.screenshot({ path: join(to, `${basename(name, ".html")}.png`) });
    await page.click("#theme");
    await sleep(500);
    await page.screenshot({ path: join(to, `${basename(name, ".html")}-dark.png`) });
    page.quiet();
    await page.close();
  }
}

let failures = 0;
try {
  if (!existsSync(program)) throw new Error(`no program ${program}`);
  if (words[0] === "--measure") await measure();
  else if (words[0] === "--pictures") await pictures(words[1], words.slice(2));
  else failures = await test(words);
} finally {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
process.exit(failures ? 1 : 0);
