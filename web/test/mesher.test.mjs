// The npm package in node: same bytes as the native program, errors with their place, formats, speed.
// Environment: PACKAGE, its folder; NATIVE, a folder with the program triangle; DATA, a folder with inputs.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { copyFileSync, existsSync, mkdtempSync, readdirSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import test from "node:test";

const { load, MeshError } = await import(join(process.env.PACKAGE, "index.js"));
const native = join(process.env.NATIVE, "triangle");
const data = process.env.DATA;
const mesher = await load();
const inputs = ["", "coast", "nasty", "regress"].flatMap((folder) =>
  readdirSync(join(data, folder)).filter((f) => /\.(poly|node)$/.test(f)).map((f) => join(data, folder, f)))

/** Rows of a text without comments. The arrays of a mesh have 0 where the input says -0; the program keeps that. */
const rows = (bytes) => bytes.toString().split("\n").filter((line) => !line.startsWith("#")).join("\n")
  .replace(/(?<= )-0(?= )/g, "0");

function byProgram(input, switches) {
  const folder = mkdtempSync(join(tmpdir(), "web-"));
  const stem = basename(input).replace(/\.[a-z]+$/, "");
  copyFileSync(input, join(folder, basename(input)));
  try {
    execFileSync(native, [switches, basename(input)], { cwd: folder, stdio: "pipe" });
  } catch (fault) {
    return { error: fault.stderr.toString() };
  }
  return { node: readFileSync(join(folder, stem + ".1.node")), ele: readFileSync(join(folder, stem + ".1.ele")) };
}

function byModule(input, settings, first) {
  try {
    mesher.read(basename(input), readFileSync(input));
    mesher.mesh(settings);
  } catch (fault) {
    assert(fault instanceof MeshError, String(fault.stack));
    return { error: fault.message };
  }
  const files = mesher.write("m", first);
  return { node: Buffer.from(files.get("m.node")), ele: Buffer.from(files.get("m.ele") ?? "0") };
}

function compare(input, letters, settings) {
  const poly = input.endsWith(".poly") ? "p" : "";
  const there = byProgram(input, "-" + poly + letters);
  const first = there.node && rows(there.node).trim().split("\n")[1]?.trim().startsWith("0") ? 0 : 1;
  const here = byModule(input, settings, first);
  assert.equal(here.error === undefined, there.error === undefined, `${input}: ${here.error} / ${there.error}`);
  if (here.error !== undefined) return 0;
  assert(rows(here.node) === rows(there.node), input + ": .node");
  // without -A the program leaves out the regions' attributes
  const corners = (bytes) => rows(bytes).split("\n").slice(1).map((row) => row.trim().split(/\s+/,
    4).join(" ")).join("\n");
  assert(corners(here.ele) === corners(there.ele), input + ": .ele");
  return 1;
}

test("meshes have the bytes of the native program", () => {
  let same = 0;
  // The program alone refuses points at one place; the library alone looks at regions that nobody asked for; its arrays
  // round coordinates below 2^-216 (triangle/mesh/grid.h), which the last two have.
  const differ = ["identical.node", "region_no_value.poly", "bent_valley.poly",
    "denormal_coordinate.poly"];
  for (const input of inputs.filter((f) => !differ.includes(basename(f))))
    same += compare(input, "q30Q", { minAngle: 30 });
  for (const name of ["letter", "gear", "section", "coast/islands"])
    same += compare(join(data, name + ".poly"), "q33DQ", { minAngle: 33, conforming: true });
  same += compare(join(data, "letter.poly"), "q25a0.0005Q", { minAngle: 25, maxArea: 0.0005 });
  same += compare(join(data, "gear.poly"), "Q", {});
  console.log(`${same} meshes with the native program's bytes, of ${inputs.length + 6} inputs`);
  assert(same > 60);
});

test("lengths give the program's mesh", () => {
  const input = join(data, "letter.poly");
  const folder = mkdtempSync(join(tmpdir(), "web-"));
  copyFileSync(input, join(folder, "letter.poly"));
  execFileSync(native, ["-pq25Q", "--size", "0.02", "letter.poly"], { cwd: folder });
  const here = byModule(input, { minAngle: 25, size: 0.02 }, 1);
  assert(rows(here.ele) === rows(readFileSync(join(folder, "letter.1.ele"))));
});

test("edges grow away from the boundary, whose segments have no markers", () => {
  mesher.read("square.poly", "4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n");
  const even = mesher.mesh({ minAngle: 30, size: 0.02 }).triangles.length;
  const grown = mesher.mesh({ minAngle: 30, size: 0.02, growth: 0.3 }).triangles.length;
  assert(grown < even / 3, `${grown} of ${even}`);
});

test("every format is written, and Triangle's own is read again", () => {
  mesher.read("section.poly", readFileSync(join(data, "section.poly")));
  const { triangles } = mesher.mesh({ minAngle: 30 });
  const n = triangles.length / 3;
  assert.match(Buffer.from(mesher.write("x.vtu").get("x.vtu")).toString("latin1"), /^<\?xml[^]*UnstructuredGrid/);
  assert.match(Buffer.from(mesher.write("x.msh").get("x.msh")).toString("latin1"), /^\$MeshFormat/);
  assert.match(Buffer.from(mesher.write("x.2dm").get("x.2dm")).toString(), /^MESH2D/);
  assert.equal(Buffer.from(mesher.write("x.14").get("x.14")).toString().split("\n")[1].trim().split(/\s+/)[0],
    String(n));
  const own = mesher.write("x");
  assert.deepEqual([...own.keys()], ["x.node", "x.ele", "x.poly"]);
  assert.throws(() => mesher.write("x.shp"), /there is no format \.shp/);
  const n_points = mesher.current().points.length;
  mesher.read("again.node", own.get("x.node"));
  assert.equal(mesher.figure().points.length, n_points);
});

test("an error names the line, and the module goes on", () => {
  assert.throws(() => mesher.read("bad.poly", "4 2 0 0\n1 0 0\n2 1 0\n3 1 x\n4 0 1\n"), (fault) =>
    fault instanceof MeshError && fault.status === 3 && fault.line === 4);
  assert.throws(() => mesher.read("figure.shp", "1"), /file type is unknown/);
  mesher.read("square.poly", readFileSync(join(data, "square.poly")));
  assert(mesher.mesh({ minAngle: 30 }).triangles.length > 0);
});

test("calls out of order, and bounds without meaning, are refused", async () => {
  const fresh = await load();
  assert.throws(() => fresh.mesh({ minAngle: 30 }), /no figure has been read/);
  assert.throws(() => fresh.write("x.vtu"), /there is no mesh to write/);
  fresh.read("letter.poly", readFileSync(join(data, "letter.poly")));
  assert.throws(() => fresh.mesh({ size: -1 }), /size is -1/);
  assert.throws(() => fresh.mesh({ maxArea: NaN }), /maxArea is NaN/);
  assert.throws(() => fresh.write("x"), /there is no mesh to write/);
  fresh.mesh();
  fresh.write("x");
  fresh.read("square.poly", readFileSync(join(data, "square.poly")));
  assert.throws(() => fresh.write("x"), /there is no mesh to write/);
  assert.equal(fresh.current().triangles.length, 0);
});

test("speed beside that of the native program, which is told and not judged", () => {
  const input = join(data, "letter.poly");
  const best = (run) => Math.min(...[1, 2, 3, 4, 5].map(run));
  const own = best(() => {
    const output = execFileSync(native, ["-pq30a0.0001NEP", input], { encoding: "utf8", cwd: tmpdir() });
    return Number(/Total running milliseconds:\s*([0-9]+)/.exec(output)[1]);
  });
  mesher.read("letter.poly", readFileSync(input));
  const here = best(() => { const t = performance.now(); mesher.mesh({ minAngle: 30, maxArea: 0.0001 });
    return performance.now() - t; });
  console.log(`letter, area 0.0001: ${mesher.current().triangles.length / 3} triangles, ${here.toFixed(0)} ms, ` +
    `native ${own} ms`);
});
