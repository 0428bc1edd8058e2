// What the playground looks like, and how long it takes.

/** Pictures of what one does, the second of which is that of the docs. */
export async function pictures({ open, choose, idle, where, folder }) {
  const sleep = (ms) => new Promise((done) => setTimeout(done, ms));
  const page = await open();
  const shot = async (name) => { await sleep(400); await page.screenshot({ path: `${folder}/${name}.png` }); };
  await shot("begin");
  await choose(page, "Aegean");
  await page.mouse.move(660, 690);
  await shot("aegean");
  await choose(page, "SPOT");
  await shot("spot");
  await choose(page, "320 cells");
  await shot("cells");
  await choose(page, "Shock, mild");
  await page.click("[data-tool=geodesic]");
  for (const p of [[-0.8, -0.5, 0], [0.7, 0.6, 0]]) await page.mouse.click(...(await where(page, p)));
  await idle(page);
  await shot("geodesic");
  await page.click("[data-tool=seeds]");
  await idle(page);
  await shot("seeds");
  await page.click("[data-tool=draw]");
  for (const p of [[-0.5, -0.5, 0], [0.5, 0.5, 0], [0.5, -0.5, 0], [-0.5, 0.5, 0], [-0.5, -0.5, 0]]) await page.mouse.click(...(await where(page, p)));
  await idle(page);
  await shot("crossing");
  await page.$eval("#domain", (it) => { it.value = "rect:-1,-1,1,1"; });
  await page.$eval("#metric", (it) => { it.value = "formula:1/(0.01+x; 0; 1"; it.dispatchEvent(new Event("change")); });
  await idle(page);
  await page.click("#theme");
  await shot("formula-dark");
}

/** The shock of 5,000 vertices, beside the program with one thread. */
export async function measure({ open, idle, report, type, theirs }) {
  const page = await open();
  for (const metric of ["shock:phi=1,lambda=0.6", "shock:phi=10,lambda=0.06"]) {
    await type(page, "#vertices", "5000");
    await type(page, "#metric", metric);
    await idle(page);
    const [ours, others] = [[], []];
    for (let i = 0; i < 3; i++) {
      await page.click("#go");
      await idle(page);
      ours.push((await report(page)).seconds.total);
      others.push((await theirs(page)).report.seconds.total);
    }
    const least = (all) => Math.min(...all), [a, b] = [least(ours), least(others)];
    console.log(`${metric}: ${a.toFixed(2)} s in the browser, ${b.toFixed(2)} s by the program: ${(a / b).toFixed(2)} times`);
  }
}
