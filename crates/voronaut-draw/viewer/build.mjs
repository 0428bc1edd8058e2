// Makes the page without meshes, src/page/viewer.html of the crate: one file, with the script and the style in it.
//
//     node build.mjs [PLACE]            # writes it there
//     node build.mjs --check [PLACE]    # whether what is there is what the sources give
import { build } from "esbuild";
import { createHash } from "node:crypto";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const place = process.argv.slice(2).find((word) => !word.startsWith("--")) ?? join(here, "../src/page/viewer.html");
const bundle = async (entry, options) => {
  const made = await build({ entryPoints: [join(here, entry)], bundle: true, minify: true, write: false, charset: "utf8", ...options });
  return made.outputFiles[0].text.trim();
};
const style = await bundle("src/page.css", {});
const script = await bundle("src/main.ts", { format: "iife", target: "es2022", legalComments: "none" });
if (/<\/script|\{\{/i.test(script)) throw new Error("the script would end its own tag, or has a place in it");
// Names and contents of all sources: so that it is seen without node where one of them has changed since.
const sources = ["package-lock.json", "page.html", ...readdirSync(join(here, "src")).sort().map((name) => `src/${name}`)];
const digest = createHash("sha256");
for (const name of sources) digest.update(name).update("\0").update(readFileSync(join(here, name))).update("\0");
const page = readFileSync(join(here, "page.html"), "utf8")
  .replace('content="voronaut"', () => `content="voronaut" data-sources="${digest.digest("hex")}"`)
  .replace("/*style*/", () => style)
  .replace("/*script*/", () => script);
if (process.argv.includes("--check")) {
  if (readFileSync(place, "utf8") !== page) {
    console.error("viewer.html is not what its sources give: run scripts/test_page --build");
    process.exit(1);
  }
} else {
  writeFileSync(place, page);
  console.log(`viewer.html: ${page.length} characters`);
}
