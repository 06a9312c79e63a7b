// The page: figures in, settings, the Worker, the picture, statistics, downloads, links.
import { Figure, fromRings, parse } from "./input";
import { Drawing } from "./draw";
import type { Settings } from "./mesher";
import { bytesOf, pack, save, unpack, unzip, zip } from "./share";
import { Colour, paletteOf, View } from "./view";
import type { Answer, Job, Question, Result } from "./worker";

declare const WORKER: string, WASM: string, EXAMPLES: string;
type Element = HTMLElement & HTMLInputElement & HTMLCanvasElement;
const $ = (id: string) => document.getElementById(id) as unknown as Element;
const show = (id: string, on: boolean) => { $(id).hidden = !on; };
const number = new Intl.NumberFormat("en", { maximumFractionDigits: 0 });
const short = (v: number) => v === 0 ? "" : String(Number(v.toPrecision(3)));

interface Example { key: string; name: string; poly: string }
let examples: Example[] = [];
let figure: Figure | null = null, drawn: Figure | null = null; // drawn: the figure made from the drawn rings
let result: Result & { figure: Figure; job: Job } | null = null; // the result on display
let extent = 1; // larger side of the figure
const settings = { minAngle: 30, maxArea: 0, size: 0, growth: 0.12, conforming: false, protect: false };

// --- the Worker

let wasm: WebAssembly.Module, worker: Worker, busy = 0, jobs = 0, ready = false, busySign = 0;
const source = URL.createObjectURL(new Blob([WORKER], { type: "text/javascript" }));
const ask = (question: Question) => worker.postMessage(question);
const waiters = new Map<number, (answer: Answer) => void>();

function startWorker(): void {
  worker = new Worker(source);
  worker.onmessage = ({ data }: MessageEvent<Answer>) => hear(data);
  worker.onerror = (e) => { idle(); fail(`the mesher stopped: ${e.message}`); };
  ask({ kind: "start", module: wasm });
}

function hear(answer: Answer): void {
  if (answer.kind === "ready") {
    ready = true;
    $("version").textContent = `ptriangle ${answer.version}, WebAssembly`;
  } else if (answer.kind === "progress") {
    $("busy-text").textContent = `${number.format(answer.triangles)} triangles`;
    $("progress").value = String(answer.done);
  } else {
    const id = answer.kind === "result" ? answer.result.id : answer.id, waiter = waiters.get(id);
    waiters.delete(id);
    waiter?.(answer);
  }
}

function call(question: (id: number) => Question): Promise<Answer> {
  const id = ++jobs;
  return new Promise((done) => { waiters.set(id, done); ask(question(id)); });
}

function idle(): void { busy = 0; clearTimeout(busySign); show("busy", false); }

/** Ends what the Worker does, at once. */
function stop(): void {
  worker.terminate();
  waiters.clear();
  idle();
  startWorker();
}

/** Nothing is shown. */
function clear(): void {
  result = null;
  view.setLayout(null);
  show("result", false);
}

function fail(text: string): void {
  $("error").querySelector("span")!.textContent = text;
  show("error", true);
}

// --- meshing

let later = 0;
function soon(): void { clearTimeout(later); later = window.setTimeout(run, 40); }

function wanted(): Settings {
  return { ...settings, growth: settings.size ? settings.growth : 0, evenOdd: figure?.evenOdd ?? false,
    regionAreas: true };
}

async function run(): Promise<void> {
  clearTimeout(later);
  if (!figure || !ready) return;
  if (busy) stop();
  const now = figure, id = busy = ++jobs;
  const job = { id, name: `${now.name}.${now.node ? "node" : "poly"}`, text: now.poly, settings: wanted() };
  $("busy-text").textContent = "Meshing";
  $("progress").removeAttribute("value");
  busySign = window.setTimeout(() => show("busy", true), 250);
  const answer = await new Promise<Answer>((done) => {
    waiters.set(id, done);
    ask({ kind: "mesh", job });
  });
  if (busy !== id) return;
  idle();
  if (answer.kind === "error") {
    fail(`${now.file ?? now.name}${now.file && answer.line ? `, line ${answer.line}` : ""}: ${answer.text}`);
    if (result?.figure !== now) { clear(); show("empty", !drawing.on); }
  } else if (answer.kind === "result") {
    show("error", false);
    accept({ ...answer.result, figure: now, job });
  }
}

let fitNext = false;
function accept(r: NonNullable<typeof result>): void {
  result = r;
  show("empty", false);
  show("result", r.triangles > 0);
  if (!r.triangles)
    fail(`${r.figure.name}: ${r.notes.trim().replace(/open at .*/, "open at the red points") || "the mesh is empty"}`);
  view.setLayout(r.layout);
  const box = r.triangles ? r.layout.box : boxOf(r.outline);
  extent = Math.max(box[2]! - box[0]!, box[3]! - box[1]!) || 1;
  if (fitNext) { view.fitTo(box); fitNext = false; }
  tell(r);
  fill();
  remember();
}

function boxOf(p: Float64Array): number[] {
  const box = [Infinity, Infinity, -Infinity, -Infinity];
  p.forEach((v, i) => { box[i & 1] = Math.min(box[i & 1]!, v); box[2 + (i & 1)] = Math.max(box[2 + (i & 1)]!, v); });
  return box.every(Number.isFinite) ? box : [0, 0, 1, 1];
}

/** Returns why angles are smaller than the bound. */
function unmet(r: Result & { job: Job }): string {
  const bound = r.job.settings.minAngle!;
  if (Math.floor(r.minAngle * 100 + 1e-6) >= bound * 100) return ""; // by rounding alone
  const reasons = ["at small angles of the figure", "in gaps too narrow to fill",
    "at the boundary, which gets no new points",
    "because the bound would need endless points", "where coordinates are too imprecise"];
  const parts = r.unmet.slice(0, 5)
    .map((n, i) => n ? `${number.format(n)} triangle${n > 1 ? "s" : ""} ${reasons[i]}` : "").filter(Boolean);
  return parts.length ? `Below ${bound}°: ${parts.join(", ")}.` : "";
}

function tell(r: NonNullable<typeof result>): void {
  const text = (id: string, value: string) => { $(id).textContent = value; };
  text("s-triangles", number.format(r.triangles));
  text("s-points", number.format(r.points));
  text("s-angle", r.triangles ? `${(Math.floor(r.minAngle * 100 + 1e-6) / 100).toFixed(2)}°` : "–");
  text("s-large", r.triangles ? `${r.maxAngle.toFixed(1)}°` : "–");
  text("s-time", r.ms < 1000 ? `${r.ms < 10 ? r.ms.toFixed(1) : r.ms.toFixed(0)} ms` : `${(r.ms / 1000).toFixed(2)} s`);
  text("notes", [r.figure.note, r.notes.trim(), unmet(r)].filter(Boolean).join("\n"));
  const most = Math.max(1, ...r.histogram), n = r.histogram.length, palette = paletteOf("angle", view.dark);
  $("histogram").innerHTML = r.histogram.map((c, i) => {
    const h = c ? Math.max(0.8, 62 * c / most) : 0, angle = (i + 0.5) * 180 / n;
    const at = 4 * Math.round(255 * Math.max(0, Math.min(1, angle <= 60 ? angle / 60 : (180 - angle) / 120)));
    return `<rect x="${i * 240 / n + 0.3}" y="${64 - h}" width="${240 / n - 0.6}" height="${h}"
      fill="rgb(${palette.subarray(at, at + 3)})"><title>${i * 180 / n}° to ${(i + 1) * 180 / n}°: ${
      number.format(c)}</title></rect>`;
  }).join("");
}

function take(f: Figure, keep = false): void {
  figure = f;
  fitNext = true;
  if (!keep) settings.maxArea = settings.size = 0;
  $("name").textContent = f.name;
  show("error", false);
  show("empty", false);
  fill();
  run();
}

function takeText(name: string, text: string): void {
  leaveDrawing();
  try { take(parse(name, text)); } catch (fault) { fail(`${name}: ${(fault as Error).message}`); }
}

async function takeFile(file: File | undefined): Promise<void> {
  if (file) takeText(file.name, await file.text());
}

// --- settings: a slider and a number each; lengths and areas by their logarithm

const scales: Record<string, { get: () => number; set: (v: number) => void; from: (s: number) => number;
  to: (v: number) => number }> = {
  angle: { get: () => settings.minAngle, set: (v) => { settings.minAngle = Math.min(38, v); }, from: (s) => s,
    to: (v) => v },
  area: { get: () => settings.maxArea, set: (v) => { settings.maxArea = v; },
    from: (s) => s ? Number((extent ** 2 * 10 ** (-1.2 - s * 0.052)).toPrecision(3)) : 0,
    to: (v) => v ? (-1.2 - Math.log10(v / extent ** 2)) / 0.052 : 0 },
  size: { get: () => settings.size, set: (v) => { settings.size = v; },
    from: (s) => s ? Number((extent * 10 ** (-0.5 - s * 0.025)).toPrecision(3)) : 0,
    to: (v) => v ? (-0.5 - Math.log10(v / extent)) / 0.025 : 0 },
  growth: { get: () => settings.growth, set: (v) => { settings.growth = v; }, from: (s) => s, to: (v) => v },
};

function fill(): void {
  for (const [id, s] of Object.entries(scales)) {
    if (document.activeElement !== $(id)) $(id).value = String(s.to(s.get()));
    const text = short(s.get());
    if (document.activeElement !== $(id + "-text"))
      $(id + "-text").value = id === "angle" ? (text || "0") + "°" : id === "growth" ? text || "0" : text;
    $(id).setAttribute("aria-valuetext", text || (id === "angle" ? "no bound" : "any"));
  }
  $("growth-row").classList.toggle("off", !settings.size);
  $("growth").disabled = $("growth-text").disabled = !settings.size;
  $("conforming").checked = settings.conforming;
  $("protect").checked = settings.protect;
  const [low, high] = view.colour === "angle" ? ["0°", "60°"] : view.colour === "quality" ? ["flat", "equilateral"]
    : [`${result?.regions.length || 1} ${result && result.regions.length > 1 ? "regions" : "region"}`, ""];
  $("low").textContent = low!;
  $("high").textContent = high!;
  const ramp = new ImageData(256, 1), colours = paletteOf(view.colour, view.dark);
  const n = Math.max(1, Math.min(8, result?.regions.length ?? 1));
  for (let i = 0; i < 256; i++) {
    const from = view.colour === "region" ? Math.floor(i * n / 256) : i;
    ramp.data.set(colours.subarray(4 * from, 4 * from + 4), 4 * i);
  }
  $("ramp").getContext("2d")!.putImageData(ramp, 0, 0);
}

for (const [id, s] of Object.entries(scales)) {
  $(id).addEventListener("input", () => { s.set(s.from(Number($(id).value))); fill(); soon(); });
  $(id + "-text").addEventListener("change", () => {
    const v = parseFloat($(id + "-text").value.replace(",", "."));
    if (v >= 0 || !$(id + "-text").value.trim()) s.set(Number.isFinite(v) ? v : 0);
    $(id + "-text").blur();
    fill();
    soon();
  });
}
for (const id of ["conforming", "protect"] as const)
  $(id).addEventListener("change", () => { settings[id] = $(id).checked; soon(); });
for (const radio of document.querySelectorAll<HTMLInputElement>("input[name=colour]"))
  radio.addEventListener("change", () => { view.colour = radio.value as Colour; view.repaint(); fill(); remember(); });

// --- the picture, under mouse, fingers and keys

let view: View;
try { view = new View($("gl")); } catch (fault) { fail((fault as Error).message); throw fault; }
const dark = matchMedia("(prefers-color-scheme: dark)");
const themed = () => { view.dark = dark.matches; view.repaint(); fill(); if (result) tell(result);
  if (examples.length) gallery(); };
const drawing = new Drawing(view, $("gl"), $("over"), (rings) => {
  if (!rings.length) return;
  const fitted = fitNext;
  figure = drawn = fromRings(rings);
  fitNext = fitted && false;
  soon();
});
view.onframe = () => {
  drawing.paint();
  if (result && !result.triangles && !drawing.on) outline(result.outline);
};

/** Shows the figure if there is no mesh, and marks its open ends. */
function outline(p: Float64Array): void {
  const c = $("over").getContext("2d")!, ends = new Map<string, [number, number]>();
  c.beginPath();
  for (let i = 0; i < p.length; i += 2) {
    const at = view.toScreen(p[i]!, p[i + 1]!), key = `${p[i]} ${p[i + 1]}`;
    if (i % 4) c.lineTo(...at); else c.moveTo(...at);
    if (!ends.delete(key)) ends.set(key, at);
  }
  c.lineWidth = 2;
  c.strokeStyle = getComputedStyle(document.body).color;
  c.stroke();
  c.fillStyle = getComputedStyle(document.body).getPropertyValue("--warn");
  for (const at of ends.values()) { c.beginPath(); c.arc(...at, 6, 0, 7); c.fill(); }
}

const fingers = new Map<number, [number, number]>();
$("gl").addEventListener("pointerdown", (e) => {
  if (drawing.down(e)) return;
  $("gl").setPointerCapture(e.pointerId);
  fingers.set(e.pointerId, [e.offsetX, e.offsetY]);
});
$("gl").addEventListener("pointermove", (e) => {
  const was = fingers.get(e.pointerId);
  if (!was) { drawing.move(e); return; }
  const other = [...fingers].find(([id]) => id !== e.pointerId)?.[1];
  fingers.set(e.pointerId, [e.offsetX, e.offsetY]);
  if (other) {
    const before = Math.hypot(was[0] - other[0], was[1] - other[1]), after = Math.hypot(e.offsetX - other[0],
      e.offsetY - other[1]);
    view.pan((e.offsetX - was[0]) / 2, (e.offsetY - was[1]) / 2);
    if (before > 0) view.zoom(after / before, (e.offsetX + other[0]) / 2, (e.offsetY + other[1]) / 2);
  } else view.pan(e.offsetX - was[0], e.offsetY - was[1]);
});
for (const kind of ["pointerup", "pointercancel"] as const)
  $("gl").addEventListener(kind, (e) => { fingers.delete(e.pointerId); drawing.up(); });
$("gl").addEventListener("dblclick", (e) => { if (!drawing.on) view.zoom(2, e.offsetX, e.offsetY); });
$("gl").addEventListener("wheel", (e) => {
  e.preventDefault();
  view.zoom(Math.exp(-e.deltaY * (e.deltaMode ? 0.05 : e.ctrlKey ? 0.01 : 0.002)), e.offsetX, e.offsetY);
}, { passive: false });
$("gl").addEventListener("keydown", (e) => {
  const step = 60;
  const move: Record<string, [number, number]> = { ArrowLeft: [step, 0], ArrowRight: [-step, 0], ArrowUp: [0, step],
    ArrowDown: [0, -step] };
  if (move[e.key]) view.pan(...move[e.key]!);
  else if (e.key === "+" || e.key === "=") view.zoom(1.4);
  else if (e.key === "-") view.zoom(1 / 1.4);
  else if (e.key === "0") view.fit();
  else return;
  e.preventDefault();
});
$("in").onclick = () => view.zoom(1.6);
$("out").onclick = () => view.zoom(1 / 1.6);
$("fit").onclick = () => view.fit();

// --- figures

$("open").onclick = () => $("file").click();
$("file").onchange = () => { takeFile($("file").files?.[0]); $("file").value = ""; };
$("paste").onclick = () => { $("paste-text").value = ""; ($("paste-box") as unknown as HTMLDialogElement).showModal();
  };
$("paste-go").onclick = () => takeText("pasted", $("paste-text").value);
function startPage(): void {
  if (busy) stop();
  figure = null;
  clear();
  show("error", false);
  show("empty", true);
  $("name").textContent = "";
}
/** Shows the figure, or the start page if there is none. */
function leaveDrawing(): void {
  if (drawing.on) drawing.leave();
  if (!figure) startPage();
}
$("examples").onclick = () => { drawing.leave(); startPage(); };
$("draw").onclick = () => {
  if (drawing.on) { leaveDrawing(); return; }
  if (figure && figure === drawn) { drawing.enter(drawing.rings); return; } // continues the drawing
  show("empty", false);
  show("error", false);
  if (busy) stop();
  figure = null;
  clear();
  settings.maxArea = settings.size = 0;
  view.fitTo([0, 0, 100, 70]);
  $("name").textContent = "drawing";
  drawing.enter();
};
$("stop").onclick = () => {
  stop();
  if (result?.figure !== figure) clear();
  fail("Stopped. Change a bound to mesh again.");
};
$("error").querySelector("button")!.onclick = () => show("error", false);

let depth = 0;
const dropping = (on: boolean) => document.body.classList.toggle("dropping", on);
addEventListener("dragenter", (e) => { e.preventDefault(); depth++; dropping(true); });
addEventListener("dragleave", () => { if (--depth <= 0) { depth = 0; dropping(false); } });
addEventListener("dragover", (e) => e.preventDefault());
addEventListener("drop", (e) => {
  e.preventDefault();
  depth = 0;
  dropping(false);
  const file = e.dataTransfer?.files[0], text = e.dataTransfer?.getData("text");
  if (file) takeFile(file); else if (text) takeText("dropped", text);
});
addEventListener("paste", (e) => {
  if ((e.target as HTMLElement).closest("input, textarea")) return;
  const file = e.clipboardData?.files[0], text = e.clipboardData?.getData("text");
  if (file) takeFile(file); else if (text) takeText("pasted", text);
});
addEventListener("keydown", (e) => {
  if (!(e.target as HTMLElement).closest("input, textarea, dialog") && drawing.on) {
    drawing.key(e);
    if (!drawing.on) leaveDrawing();
  }
});

const ofExample = (e: Example): Figure => ({ ...e, evenOdd: false });

let painter: Worker | null = null;
/** Makes the thumbnails in a separate Worker. */
function gallery(): void {
  painter?.terminate();
  const own = painter = new Worker(source), canvases: HTMLCanvasElement[] = [];
  own.postMessage({ kind: "start", module: wasm });
  $("gallery").textContent = "";
  for (const [id, example] of examples.entries()) {
    const button = document.createElement("button"), canvas = document.createElement("canvas");
    canvas.width = 400;
    canvas.height = 300;
    canvases.push(canvas);
    button.append(canvas, example.name);
    button.onclick = () => take(ofExample(example));
    $("gallery").append(button);
    own.postMessage({ kind: "mesh", job: { id, name: "x.poly", text: example.poly, settings: { minAngle: 26 } } });
  }
  own.onmessage = ({ data }: MessageEvent<Answer>) => {
    if (data.kind !== "result") return;
    thumbnail(canvases[data.result.id]!, data.result);
    if (data.result.id === examples.length - 1) own.terminate();
  };
}

function thumbnail(canvas: HTMLCanvasElement, r: Result): void {
  const c = canvas.getContext("2d")!, [x0, y0, x1, y1] = r.layout.box as [number, number, number, number];
  const scale = Math.min(canvas.width / (x1 - x0), canvas.height / (y1 - y0)) * 0.95;
  const { chunks, positions: p, values } = r.layout, palette = paletteOf("angle", view.dark);
  c.lineWidth = r.triangles > 3000 ? 0.35 : 0.9;
  c.strokeStyle = view.dark ? "#0b1116" : "#1d3b44";
  for (let k = 0; k < chunks.length; k += 8)
    for (let i = chunks[k + 6]!; i < chunks[k + 6]! + chunks[k + 7]!; i++) {
      const x = (v: number) => (chunks[k]! + p[v]! - (x0 + x1) / 2) * scale + canvas.width / 2;
      const y = (v: number) => canvas.height / 2 - (chunks[k + 1]! + p[v]! - (y0 + y1) / 2) * scale,
        v = 4 * values[12 * i]!;
      c.fillStyle = `rgb(${palette[v]},${palette[v + 1]},${palette[v + 2]})`;
      c.beginPath();
      c.moveTo(x(6 * i), y(6 * i + 1));
      c.lineTo(x(6 * i + 2), y(6 * i + 3));
      c.lineTo(x(6 * i + 4), y(6 * i + 5));
      c.closePath();
      c.fill();
      c.stroke();
    }
}

// --- downloads and links

$("download").onclick = async () => {
  if (!result) return;
  const { figure, job } = result, format = $("format").value;
  const name = figure.name.replace(/[^\p{L}\p{N}_.-]+/gu, "-").toLowerCase() || "mesh";
  if (format === "png") { $("gl").toBlob((b) => b && save(name + ".png", b)); return; }
  if (format === "poly") { save(name + (figure.node ? ".node" : ".poly"), result.text); return; }
  $("busy-text").textContent = "Writing";
  if (!busy) busySign = window.setTimeout(() => show("busy", true), 250);
  const answer = await call((id) => ({ kind: "write", id, job, name: format === "zip" ? name : `${name}.${format}` }));
  if (!busy) idle();
  if (answer.kind === "error") fail(answer.text);
  else if (answer.kind === "files")
    format === "zip" ? save(name + ".zip", zip(answer.files)) : save(answer.files[0]![0], answer.files[0]![1]);
};

/** Returns the part of the link after #: the figure and settings on display. */
async function hash({ figure, job: { settings: s } }: NonNullable<typeof result>): Promise<string> {
  const words = new URLSearchParams({ angle: String(s.minAngle) });
  if (s.maxArea) words.set("area", String(s.maxArea));
  if (s.size) { words.set("size", String(s.size)); words.set("growth", String(s.growth)); }
  if (s.conforming) words.set("conforming", "1");
  if (s.protect) words.set("protect", "1");
  if (view.colour !== "angle") words.set("colour", view.colour);
  if (figure.key) words.set("example", figure.key);
  else words.set("figure", await pack(JSON.stringify(figure)));
  return "#" + words;
}

/** Updates the address after each mesh. A large figure is put into a link only on request. */
async function remember(): Promise<void> {
  if (!result || (!result.figure.key && result.figure.poly.length > 20000)) return;
  history.replaceState(null, "", await hash(result));
}

$("link").onclick = async () => {
  if (!result) return;
  const link = location.href.replace(/#.*/, "") + await hash(result), button = $("link");
  history.replaceState(null, "", link);
  let said = "Link copied";
  try { await navigator.clipboard.writeText(link); } catch { said = "The address bar holds the link"; }
  button.textContent = link.length > 30000 ? `${said}: ${number.format(link.length / 1000)} kB` : said;
  setTimeout(() => { button.textContent = "Copy a link to this mesh"; }, 2500);
};

async function fromLink(): Promise<boolean> {
  const words = new URLSearchParams(location.hash.slice(1)), key = words.get("example"), packed = words.get("figure");
  if (!key && !packed) return false;
  const value = (name: string, otherwise: number) => {
    const v = Number(words.get(name) ?? otherwise);
    return Number.isFinite(v) && v >= 0 ? v : otherwise;
  };
  Object.assign(settings, { minAngle: Math.min(38, value("angle", 30)), maxArea: value("area", 0),
    size: value("size", 0), growth: value("growth", 0.12), conforming: words.has("conforming"),
    protect: words.has("protect") });
  const wish = CSS.escape(words.get("colour") ?? "angle");
  const colour = document.querySelector<HTMLInputElement>(`input[name=colour][value="${wish}"]`);
  if (colour) { colour.checked = true; view.colour = colour.value as Colour; }
  const example = examples.find((e) => e.key === key);
  try {
    take(example ? ofExample(example) : JSON.parse(await unpack(packed ?? "")), true);
  } catch { fail("This link is damaged: it holds no figure."); return false; }
  return true;
}

(async () => {
  wasm = await WebAssembly.compile(await unzip(bytesOf(WASM)) as BufferSource);
  examples = JSON.parse(new TextDecoder().decode(await unzip(bytesOf(EXAMPLES))));
  startWorker();
  ready = true;
  themed();
  dark.addEventListener("change", themed);
  await fromLink();
  addEventListener("hashchange", fromLink);
  Object.assign(window, { ptriangle: { view, settings, result: () => result, ready: true } });
})().catch((fault) => fail(`This browser cannot run the mesher: ${(fault as Error).message}`));
