// build.mjs PAGE: one HTML file from index.html, style.css, src/, the module (WASM) and examples (DATA).
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { gzipSync } from "node:zlib";
import { buildSync } from "esbuild";

const bundle = (entry, define = {}) =>
  buildSync({ entryPoints: [entry], bundle: true, minify: true, write: false, format: "iife", target: "es2022", define,
    charset: "utf8", legalComments: "none" }).outputFiles[0].text;
/** Removes comments of a .poly file. */
const figure = (name) => readFileSync(join(process.env.DATA, name), "utf8").split("\n")
  .map((line) => line.replace(/#.*/, "").trim().replace(/\s+/g, " ")).filter(Boolean).join("\n") + "\n";
const examples = [
  ["coast", "British Isles", "coast/islands.poly"], ["letter", "Letter R", "letter.poly"], ["gear", "Gear",
    "gear.poly"],
  ["aerofoil", "Aerofoil", "naca2412_box.poly"], ["koch", "Koch's lake", "koch_lake.poly"],
  ["section", "Retaining wall", "section.poly"],
].map(([key, name, file]) => ({ key, name, poly: figure(file) }));
const zipped = (bytes) => gzipSync(bytes, { level: 9 }).toString("base64");
const script = bundle("src/page.ts", {
  WORKER: JSON.stringify(bundle("src/worker.ts")), WASM: JSON.stringify(zipped(readFileSync(process.env.WASM))),
  EXAMPLES: JSON.stringify(zipped(JSON.stringify(examples))),
});
const style = readFileSync("style.css", "utf8").replace(/\s*\n\s*/g, " ");
const page = readFileSync("index.html", "utf8").replace("/*STYLE*/", () => style)
  .replace("/*SCRIPT*/", () => script.replace(/<\/script/g, "<\\/script"));
writeFileSync(process.argv[2], page);
console.log(`web: ptriangle.html: ${Buffer.byteLength(page)} bytes`);
