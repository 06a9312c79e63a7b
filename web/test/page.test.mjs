// The page in headless Chromium, from file://, by real mouse events; pictures are left in SHOTS.
// Environment: PAGE, the HTML file; PACKAGE, the npm package's folder; DATA, a folder with inputs; SHOTS, a folder.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import test, { after, before } from "node:test";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const { load } = await import(join(process.env.PACKAGE, "index.js"));
const mesher = await load();
const url = pathToFileURL(process.env.PAGE).href, shots = process.env.SHOTS, data = process.env.DATA;
mkdirSync(shots, { recursive: true });
let browser;
before(async () => {
  browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking",
      "--disable-component-update", "--disable-sync", "--disable-quic", "--no-first-run"] });
});
after(() => browser?.close());

async function open(hash = "", options = {}) {
  const context = await browser.newContext({ viewport: { width: 1000, height: 640 }, acceptDownloads: true,
    ...options });
  const page = await context.newPage(), faults = [];
  page.on("pageerror", (e) => faults.push(e.message));
  page.on("request", (r) => { if (/^https?:/.test(r.url())) faults.push("asks for " + r.url()); });
  await page.goto(url + hash);
  await page.waitForFunction(() => window.ptriangle?.ready);
  page.done = async () => { assert.deepEqual(faults, []); await context.close(); };
  return page;
}
const shot = (page, name) => page.screenshot({ path: join(shots, name + ".png") });
const triangles = async (page) => Number((await page.textContent("#s-triangles")).replace(/,/g, ""));
/** Waits until the number of triangles is another one. */
async function meshed(page, before = -1) {
  await page.waitForFunction((n) => {
    const text = document.getElementById("s-triangles").textContent.replace(/,/g, "");
    return !document.getElementById("result").hidden && text !== "" && Number(text) !== n;
  }, before, { timeout: 60000 });
  await page.waitForTimeout(150);
  return triangles(page);
}
/** Share of the picture that is drawn, and its number of colours, from the pixels of the canvas. */
const pixels = (page) => page.evaluate(() => {
  const c = document.getElementById("gl"), copy = document.createElement("canvas");
  copy.width = c.width; copy.height = c.height;
  const x = copy.getContext("2d");
  x.drawImage(c, 0, 0);
  const d = x.getImageData(0, 0, c.width, c.height).data, colours = new Set();
  let drawn = 0;
  for (let i = 0; i < d.length; i += 4) if (d[i + 3] > 128) { drawn++;
    colours.add(d[i] >> 3 << 10 | d[i + 1] >> 3 << 5 | d[i + 2] >> 3); }
  return { drawn: drawn / (d.length / 4), colours: colours.size };
});
async function drop(page, name, text) {
  const handle = await page.evaluateHandle(([n, t]) => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([t], n));
    return transfer;
  }, [name, text]);
  for (const kind of ["dragenter", "dragover", "drop"]) await page.dispatchEvent("#stage", kind, {
    dataTransfer: handle });
}

test("the gallery meshes the coast, and everything reacts to mouse and keys", async () => {
  const page = await open("", { viewport: { width: 1280, height: 800 } });
  await page.waitForTimeout(1200);
  await shot(page, "empty");
  await page.click("#gallery button:has-text('British Isles')");
  const n = await meshed(page);
  assert(n > 2000);
  await shot(page, "coast");
  const whole = await pixels(page);
  assert(whole.drawn > 0.15 && whole.colours > 20, JSON.stringify(whole));
  assert(parseFloat(await page.textContent("#s-angle")) > 5);
  // the slider, by the keyboard and by the mouse
  await page.focus("#angle");
  for (let i = 0; i < 6; i++) await page.keyboard.press("ArrowLeft");
  const fewer = await meshed(page, n);
  assert(fewer < n, `${fewer} of ${n}`);
  const slider = await page.locator("#area").boundingBox();
  await page.mouse.move(slider.x + 8, slider.y + slider.height / 2);
  await page.mouse.down();
  await page.mouse.move(slider.x + slider.width * 0.5, slider.y + slider.height / 2, { steps: 8 });
  await page.mouse.up();
  await page.waitForTimeout(600);
  assert(await triangles(page) > fewer);
  // wheel and drag
  const stage = await page.locator("#stage").boundingBox();
  const scale = () => page.evaluate(() => ({ ...window.ptriangle.view.camera }));
  const first = await scale();
  await page.mouse.move(stage.x + stage.width * 0.4, stage.y + stage.height * 0.5);
  for (let i = 0; i < 6; i++) await page.mouse.wheel(0, -300);
  await page.waitForTimeout(300);
  assert((await scale()).scale > 5 * first.scale);
  await shot(page, "coast-near");
  await page.mouse.down();
  await page.mouse.move(stage.x + stage.width * 0.6, stage.y + stage.height * 0.5, { steps: 4 });
  await page.mouse.up();
  assert((await scale()).x < first.x + 1e9 && (await scale()).x !== first.x);
  await page.focus("#gl");
  await page.keyboard.press("0");
  await page.waitForTimeout(200);
  assert(Math.abs((await scale()).scale / first.scale - 1) < 0.05);
  await page.done();
});

test("a million triangles: no frame draws them all", async () => {
  const page = await open("#example=letter&angle=30&area=0.000072");
  const n = await meshed(page);
  assert(n > 950000, String(n));
  await page.waitForFunction((m) => window.ptriangle.view.stats.drawn >= m, n, { timeout: 60000 });
  await page.waitForTimeout(500);
  const far = await page.evaluate(() => window.ptriangle.view.stats);
  assert(far.slices > 10 && far.mostInFrame <= 60000, JSON.stringify(far));
  await shot(page, "million-far");
  const picture = await pixels(page);
  assert(picture.drawn > 0.1, JSON.stringify(picture));
  const stage = await page.locator("#stage").boundingBox();
  await page.mouse.move(stage.x + stage.width * 0.42, stage.y + stage.height * 0.55);
  for (let i = 0; i < 9; i++) await page.mouse.wheel(0, -250);
  await page.waitForTimeout(800);
  const near = await page.evaluate(() => window.ptriangle.view.stats);
  assert(near.slices === 1 && near.drawn < 60000, JSON.stringify(near));
  await shot(page, "million-near");
  console.log(`a million: ${n} triangles, meshed in ${await page.textContent("#s-time")}; far: ${far.slices} slices, ` +
    `near: ${near.drawn} triangles in a frame`);
  await page.done();
});

test("files of all kinds are dropped and pasted; errors are one sentence with the place", async () => {
  const page = await open();
  await drop(page, "gear.poly", readFileSync(join(data, "gear.poly"), "utf8"));
  let n = await meshed(page);
  const inputs = {
    "lake.geojson": JSON.stringify({ type: "Polygon", coordinates: [[[8, 47], [9, 47], [9, 47.6], [8, 47.6], [8, 47]],
      [[8.3, 47.2], [8.6, 47.2], [8.5, 47.4], [8.3, 47.2]]] }),
    "ring.svg": "<svg xmlns='http://www.w3.org/2000/svg'><circle cx='50' cy='50' r='40'/>" +
      "<rect x='35' y='35' width='25' height='30'/></svg>",
    "plate.dxf": ["0", "SECTION", "2", "ENTITIES", "0", "LINE", "8", "0", "10", "0", "20", "0", "11", "10", "21", "0",
      "0", "LINE",
      "8", "0", "10", "10", "20", "0", "11", "10", "21", "6", "0", "LINE", "8", "0", "10", "10", "20", "6", "11", "0",
        "21", "0",
      "0", "CIRCLE", "8", "0", "10", "7", "20", "2", "40", "1", "0", "ENDSEC", "0", "EOF"].join("\n"),
  };
  for (const [name, text] of Object.entries(inputs)) {
    await drop(page, name, text);
    n = await meshed(page, n);
    assert(n > 5, `${name}: ${n}`);
    assert((await page.textContent("#name")) === name.replace(/\..*/, ""));
  }
  await drop(page, "bad.poly", "4 2 0 0\n1 0 0\n2 1 0\n3 1 x\n4 0 1\n0 0\n0\n");
  await page.waitForSelector("#error:not([hidden])");
  assert.match(await page.textContent("#error span"), /^bad\.poly, line 4: vertex 3 has no y coordinate/);
  await shot(page, "error");
  await drop(page, "words.txt", "hello");
  await page.waitForFunction(() => /^words\.txt: this is no/.test(document.querySelector("#error span").textContent));
  await page.click("#paste");
  await page.fill("#paste-text", "M0 0 H100 V60 Q50 90 0 60 Z M30 20 h20 v20 h-20 z");
  await page.click("#paste-go");
  await page.waitForFunction(() => document.getElementById("name").textContent === "pasted");
  await page.waitForTimeout(400);
  const centre = await page.evaluate(() => {
    const { view } = window.ptriangle, gl = view.canvas.getContext("webgl2"), bytes = new Uint8Array(4);
    const at = (x, y) => { const [px, py] = view.toScreen(x, y); gl.readPixels(px, view.canvas.height - py, 1, 1,
      gl.RGBA,
      gl.UNSIGNED_BYTE, bytes); return bytes[3]; };
    return [at(80, -30), at(40, -30)];
  });
  assert(centre[0] > 200 && centre[1] === 0, `inside ${centre[0]}, in the hole ${centre[1]}`);
  await page.done();
});

test("an outline and a hole are drawn with the mouse", async () => {
  const page = await open();
  await page.click("#draw");
  const box = await page.locator("#stage").boundingBox(), at = (x, y) => [box.x + x * box.width,
    box.y + y * box.height];
  await page.mouse.click(...at(0.5, 0.5));
  await page.click("#draw"); // one corner is no figure
  assert(await page.isVisible("#gallery"));
  await page.click("#draw");
  const outline = [[0.2, 0.25], [0.55, 0.15], [0.8, 0.4], [0.7, 0.8], [0.3, 0.75]];
  for (const p of outline) await page.mouse.click(...at(...p));
  await page.mouse.click(...at(...outline[0]));
  const n = await meshed(page);
  for (const p of [[0.42, 0.42], [0.55, 0.42], [0.5, 0.6]]) await page.mouse.click(...at(...p));
  await page.keyboard.press("Enter");
  const m = await meshed(page, n);
  assert(m > n, `${m} with a hole, ${n} without`);
  await shot(page, "drawing-hint");
  await page.click("#draw");
  await page.click("#draw"); // goes on with the same rings
  assert.equal(await triangles(page), m);
  const hint = await page.locator("#hint").boundingBox(); // lets clicks through
  assert.equal(await page.evaluate(([x, y]) => document.elementFromPoint(x, y).id, [hint.x + 9, hint.y + 9]), "gl");
  await page.mouse.move(...at(0.8, 0.4));
  await page.mouse.down();
  await page.mouse.move(...at(0.88, 0.5), { steps: 5 });
  await page.mouse.up();
  await page.waitForTimeout(400);
  await page.focus("#size-text");
  await page.keyboard.type("2");
  await page.keyboard.press("Enter");
  await page.waitForFunction((k) => Number(document.getElementById("s-triangles").textContent.replace(/,/g, "")) > k,
    2 * m);
  await shot(page, "drawing");
  const there = await page.evaluate(() => location.hash);
  assert.match(there, /figure=/);
  await page.waitForTimeout(100);
  const k = await triangles(page), again = await open(there);
  assert.equal(await meshed(again), k);
  assert.equal(await again.inputValue("#size-text"), "2");
  await again.done();
  await page.done();
});

test("downloads have the C writers' bytes", async () => {
  const page = await open("#example=section&angle=28&colour=region");
  await meshed(page);
  await shot(page, "regions");
  const starts = { zip: "PK", vtu: "<?xml", msh: "$MeshFormat", "2dm": "MESH2D", 14: "", grd: "", poly: "79 2",
    png: "\x89PNG" };
  for (const [format, start] of Object.entries(starts)) {
    await page.selectOption("#format", format);
    const [download] = await Promise.all([page.waitForEvent("download"), page.click("#download")]);
    const bytes = readFileSync(await download.path()).toString("latin1");
    assert(bytes.length > 1000 && bytes.startsWith(start), `${download.suggestedFilename()}: ${bytes.slice(0, 20)}`);
    if (format === "zip") for (const end of [".node", ".ele", ".poly"]) assert(bytes.includes("retaining-wall" + end));
  }
  await page.done();
});

async function downloaded(page, format) {
  await page.selectOption("#format", format);
  const [download] = await Promise.all([page.waitForEvent("download", { timeout: 10000 }), page.click("#download")]);
  return readFileSync(await download.path());
}
/** The same file by the package. */
function byPackage(name, text, settings, out) {
  mesher.read(name, text);
  mesher.mesh(settings);
  return Buffer.from(mesher.write(out).get(out));
}
const says = (page, words) => page.waitForFunction((w) => document.querySelector("#error span").textContent.includes(w),
  words, { timeout: 20000 });
const equal = (a, b) => assert(a.equals(b), `${a.length} and ${b.length} bytes differ`);

test("a download has the mesh that is shown, whatever was meshed or stopped since", async () => {
  const page = await open("#example=letter&angle=28"), letter = readFileSync(join(data, "letter.poly"));
  await meshed(page);
  await page.waitForTimeout(1500); // for the gallery
  const wanted = byPackage("letter.poly", letter, { minAngle: 28 }, "letter-r.2dm");
  equal(await downloaded(page, "2dm"), wanted);
  await page.emulateMedia({ colorScheme: "dark" }); // draws the gallery again
  await page.waitForTimeout(1500);
  equal(await downloaded(page, "2dm"), wanted);
  await page.fill("#area-text", "0.00001");
  await page.keyboard.press("Enter");
  await page.click("#stop", { timeout: 20000 });
  equal(await downloaded(page, "2dm"), wanted);
  await page.fill("#area-text", "1e-300"); // refused
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => !/^Stopped/.test(document.querySelector("#error span").textContent));
  equal(await downloaded(page, "2dm"), wanted);
  await page.click("#link");
  await page.waitForFunction(() => document.getElementById("link").textContent.includes("ink"));
  assert.equal(await page.evaluate(() => location.hash), "#angle=28&example=letter");
  await page.click("#examples");
  await page.dblclick("#examples");
  await page.fill("#area-text", "0.1"); // brings nothing back
  await page.keyboard.press("Enter");
  await page.waitForTimeout(500);
  assert(await page.isVisible("#gallery") && await page.isHidden("#result"));
  assert.equal(await page.locator("#gallery button").count(), 6);
  await page.done();
});

test("points alone, from a file and by a link", async () => {
  const page = await open(), text = "6 2 0 0\n1 0 0\n2 9 0\n3 9 7\n4 1 8\n5 4 4\n6 6 3\n";
  await drop(page, "spots.node", text);
  const n = await meshed(page);
  equal(await downloaded(page, "2dm"), byPackage("spots.node", text, { minAngle: 30 }, "spots.2dm"));
  const again = await open(await page.evaluate(() => location.hash));
  assert.equal(await meshed(again), n);
  await drop(again, "apart.poly", "0 2 0 0\n1 0\n1 1 2\n0\n");
  await says(again, "its points are in another file");
  await again.done();
  await page.done();
});

test("figures by the even-odd rule keep their holes in .poly files", async () => {
  const page = await open(), box = (x, y, r) => `M${x - r} ${y - r}h${2 * r}v${2 * r}h${-2 * r}z`;
  await drop(page, "rings.svg", `<svg xmlns='http://www.w3.org/2000/svg'><path d='${box(50, 50, 40)}` +
    `${box(50, 50, 30)}${box(50, 50, 15)}${box(45, 50, 4)}${box(56, 50, 2)}'/></svg>`);
  const n = await meshed(page), figure = await downloaded(page, "poly");
  assert.equal(figure.toString().trim().split("\n").at(-4), "3", figure.toString());
  mesher.read("rings.poly", figure);
  assert.equal(mesher.mesh({ minAngle: 30 }).triangles.length, 3 * n);
  await page.done();
});

test("odd drawings: what can be read is read, open outlines are shown", async () => {
  const page = await open();
  await drop(page, "odd.svg", `<s:svg xmlns:s='http://www.w3.org/2000/svg' viewBox='0 0 200 100'><s:defs><s:path
    d='M0 0h900v900z'/></s:defs><s:rect width='100%' height='100%'/><s:rect width='2em' height='5'/><s:rect/>
    <s:path d='M1 1 L oops'/><s:polygon/><s:circle cx='50' cy='50' r='5mm'/></s:svg>`);
  await meshed(page);
  assert.deepEqual(await page.evaluate(() => window.ptriangle.result().layout.box), [0, -100, 200, 0]);
  const line = (...p) => ["0", "LINE", "8", "0", ...[10, 20, 11, 21].flatMap((code, i) => [code, p[i]])];
  const dxf = (...lines) => ["0", "SECTION", "2", "ENTITIES", ...lines.flat(), "0", "ENDSEC", "0", "EOF"].join("\n");
  await drop(page, "open.dxf", dxf(line(0, 0, 10, 0), line(10, 0, 5, 8), line(5, 8, 1, 1)));
  await says(page, "open: the mesh is empty: the outline is open at the red points");
  assert(await page.isHidden("#result"));
  await page.waitForTimeout(200);
  await shot(page, "open-outline");
  assert(await page.evaluate(() => { const c = document.getElementById("over");
    return c.getContext("2d").getImageData(0, 0, c.width, c.height).data.some((v) => v); }));
  await drop(page, "gaps.dxf", dxf(line(0, 0, 10, 0), line(10.000004, 0, 5, 8), line(5, 8.000003, 0, 0.000002),
    ["0", "INSERT", "8", "0", "2", "B", "10", "0", "20", "0"]));
  await page.waitForFunction(() => !document.getElementById("result").hidden);
  assert.match(await page.textContent("#notes"), /^1 spline, blocks or faces/);
  await drop(page, "bad.svg", "<svg><path></svg>");
  await says(page, "bad.svg: this is no valid XML: error on line 1");
  await drop(page, "none.json", '{"type":"FeatureCollection"}');
  await says(page, "none.json: no polygons or lines");
  await drop(page, "fine.poly", "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n1\n1 0.2 0.2 7 0.001\n");
  await page.waitForFunction(() => window.ptriangle.result()?.figure.name === "fine");
  assert(await triangles(page) > 500); // the region's own bound on areas
  await page.fill("#angle-text", "wide");
  await page.keyboard.press("Enter");
  assert.equal(await page.inputValue("#angle-text"), "30°");
  await page.done();
  const steep = await open("#example=letter&angle=89");
  await meshed(steep);
  assert.equal(await steep.inputValue("#angle-text"), "38°");
  await steep.done();
});

test("a long run is stopped, and the next one works", async () => {
  const page = await open("#example=letter&angle=30&area=0.00001");
  await page.click("#stop", { timeout: 20000 });
  assert.match(await page.textContent("#error span"), /^Stopped/);
  await page.fill("#area-text", "0.1");
  await page.keyboard.press("Enter");
  assert(await meshed(page) < 10000);
  await page.done();
});

test("dark, and at the width of a phone", async () => {
  const page = await open("#example=coast&angle=30", { colorScheme: "dark", viewport: { width: 1280, height: 800 } });
  await meshed(page);
  await shot(page, "dark");
  await page.done();
  const phone = await open("", { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2 });
  await phone.waitForTimeout(1000);
  await shot(phone, "phone-empty");
  await phone.click("#gallery button:has-text('Gear')");
  await meshed(phone);
  await shot(phone, "phone");
  assert(await phone.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
  await phone.done();
});
