// Makes the playground: one file, with the module, the scripts, the style and the files of examples in it.
//
//     node build.mjs MODULE.wasm DATA OUT
//     node build.mjs --check    # the scripts alone
import { build } from "esbuild";
import { readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { constants, deflateRawSync } from "node:zlib";

const here = dirname(fileURLToPath(import.meta.url));
const [module, data, out] = process.argv.slice(2);
const bundle = async (entry, options) => {
  const made = await build({ entryPoints: [join(here, entry)], bundle: true, minify: true, write: false, charset: "utf8", ...options });
  return made.outputFiles[0].text.trim();
};
const script = { format: "iife", target: "es2022", legalComments: "none" };
const deflated = (path) => deflateRawSync(readFileSync(path), { level: constants.Z_BEST_COMPRESSION });
const style = await bundle("src/playground.css", {});
const worker = await bundle("src/worker.ts", script);
const main = await bundle("src/main.ts", { ...script, define: { WORKER: JSON.stringify(worker) } });
if (/<\/script/i.test(main) || main.includes("{{")) throw new Error("the script would end its own tag");
if (module === "--check") process.exit(0);
const files = [...readFileSync(join(here, "src/examples.ts"), "utf8").match(/FILES = \[(.*)\]/)[1].matchAll(/"([^"]+)"/g)];
const scripts = files.map(([, name]) => `<script type="text/plain" id="${name}">${deflated(join(data, name)).toString("base64")}</script>`);
const packed = deflated(module);
const page = readFileSync(join(here, "page.html"), "utf8")
  .replace("{{by}}", () => `voronaut ${process.env.VERSION ?? ""}`.trim())
  .replace("{{files}}", () => scripts.join("\n"))
  .replace("{{module}}", () => packed.toString("base64"))
  .replace("/*style*/", () => style)
  .replace("/*script*/", () => main);
writeFileSync(out, page);
console.log(`${out}: ${(page.length / 1e6).toFixed(2)} MB, of which the module has ${(packed.length / 1e6).toFixed(2)} MB compressed`);
