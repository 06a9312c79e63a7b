// The Worker: meshes, measures, and arranges the triangles for the view.
import { Mesh, MeshError, Mesher, Settings } from "./mesher";

/** A figure, with the name of a .poly or .node file, and the bounds of its mesh. */
export interface Job { id: number; name: string; text: string; settings: Settings }
export type Question =
  | { kind: "start"; module: WebAssembly.Module }
  | { kind: "mesh"; job: Job }
  | { kind: "write"; id: number; job: Job; name: string }; // writes the mesh of this job, made again if necessary

/** Triangles in chunks of neighbours. Positions are relative to the origin of the chunk, so any zoom is exact. */
export interface Layout {
  positions: Float32Array; // [triangles][3][2]
  values: Uint8Array;      // [triangles][3][4]: angle, quality, region, which edges are segments
  chunks: Float64Array;    // [chunks][8]: origin, box, first triangle, number of triangles
  box: number[];
}
export interface Result {
  id: number; ms: number; points: number; triangles: number; segments: number; minAngle: number; maxAngle: number;
  area: number; histogram: number[]; regions: number[]; notes: string; unmet: number[]; layout: Layout;
  outline: Float64Array;
  text: string; // of the figure, with hole points
}
export type Answer =
  | { kind: "ready"; version: string }
  | { kind: "progress"; done: number; triangles: number }
  | { kind: "result"; result: Result }
  | { kind: "files"; id: number; files: [string, Uint8Array][] }
  | { kind: "error"; id: number; text: string; line: number; status: number };

const CHUNK = 2048, BINS = 60;
const say = (answer: Answer, transfer: Transferable[] = []) =>
  (self as unknown as Worker).postMessage(answer, transfer);

/** The set of edges that are segments, a hash table with open addressing. */
function pairSet(segments: Int32Array): (a: number, b: number) => boolean {
  let size = 16;
  while (size < segments.length * 2) size *= 2;
  const keys = new Float64Array(size).fill(-1);
  const key = (a: number, b: number) => a < b ? a * 2 ** 28 + b : b * 2 ** 28 + a;
  const place = (a: number, b: number) => (Math.imul(Math.min(a, b), 0x9e3779b1) ^ Math.imul(Math.max(a, b),
    0x85ebca6b)) >>> 0;
  const find = (a: number, b: number) => {
    let i = place(a, b) & (size - 1);
    while (keys[i] !== -1 && keys[i] !== key(a, b)) i = (i + 1) & (size - 1);
    return i;
  };
  for (let i = 0; i < segments.length; i += 2) keys[find(segments[i]!, segments[i + 1]!)] = key(segments[i]!,
    segments[i + 1]!);
  return (a, b) => keys[find(a, b)] !== -1;
}

const spread = (v: number) => {
  v = (v | (v << 8)) & 0x00ff00ff; v = (v | (v << 4)) & 0x0f0f0f0f; v = (v | (v << 2)) & 0x33333333;
  return (v | (v << 1)) & 0x55555555;
};

/** Sorts triangles along a Morton curve by counting sort. */
function order(p: Float64Array, t: Int32Array, box: number[]): Uint32Array {
  const n = t.length / 3, bits = n > 50000 ? 10 : 7, cells = 1 << bits;
  const scale = cells / (Math.max(box[2]! - box[0]!, box[3]! - box[1]!) * 3 * 1.0001 || 1);
  const key = new Uint32Array(n), count = new Uint32Array((1 << (2 * bits)) + 1), sorted = new Uint32Array(n);
  for (let i = 0; i < n; i++) {
    const a = 2 * t[3 * i]!, b = 2 * t[3 * i + 1]!, c = 2 * t[3 * i + 2]!;
    const x = (p[a]! + p[b]! + p[c]! - 3 * box[0]!) * scale,
      y = (p[a + 1]! + p[b + 1]! + p[c + 1]! - 3 * box[1]!) * scale;
    count[(key[i] = spread(x) | (spread(y) << 1)) + 1]!++;
  }
  for (let i = 1; i < count.length; i++) count[i]! += count[i - 1]!;
  for (let i = 0; i < n; i++) sorted[count[key[i]!]!++] = i;
  return sorted;
}

function boxOf(p: Float64Array, t: Int32Array): number[] {
  let x0 = Infinity, y0 = Infinity, x1 = -Infinity, y1 = -Infinity;
  for (const v of t.length ? t : p.map((_, i) => i).subarray(0, p.length / 2)) {
    const x = p[2 * v]!, y = p[2 * v + 1]!;
    if (x < x0) x0 = x; if (x > x1) x1 = x; if (y < y0) y0 = y; if (y > y1) y1 = y;
  }
  return [x0, y0, x1, y1];
}

function measure(mesh: Mesh): Omit<Result, "id" | "ms" | "outline" | "unmet" | "text"> {
  const { points: p, triangles: t } = mesh, n = t.length / 3, box = boxOf(p, t);
  const positions = new Float32Array(6 * n), values = new Uint8Array(12 * n), chunks: number[] = [];
  const histogram = new Array<number>(BINS).fill(0), isSegment = pairSet(mesh.segments);
  const onSegment = new Uint8Array(p.length / 2), regionNumber = new Map<number, number>();
  for (const v of mesh.segments) onSegment[v] = 1;
  const width = n ? mesh.regions.length / n : 0, degrees = 180 / Math.PI;
  let minAngle = 180, maxAngle = 0, area = 0;
  const sorted = order(p, t, box);
  for (let start = 0; start < n; start += CHUNK) {
    const end = Math.min(n, start + CHUNK), o = 2 * t[3 * sorted[start]!]!, ox = p[o]!, oy = p[o + 1]!;
    let bx0 = Infinity, by0 = Infinity, bx1 = -Infinity, by1 = -Infinity;
    for (let i = start; i < end; i++) {
      const k = 3 * sorted[i]!, a = t[k]!, b = t[k + 1]!, c = t[k + 2]!;
      const xa = p[2 * a]!, ya = p[2 * a + 1]!, xb = p[2 * b]!, yb = p[2 * b + 1]!, xc = p[2 * c]!, yc = p[2 * c + 1]!;
      positions[6 * i] = xa - ox; positions[6 * i + 1] = ya - oy; positions[6 * i + 2] = xb - ox;
      positions[6 * i + 3] = yb - oy; positions[6 * i + 4] = xc - ox; positions[6 * i + 5] = yc - oy;
      bx0 = Math.min(bx0, xa, xb, xc); bx1 = Math.max(bx1, xa, xb, xc);
      by0 = Math.min(by0, ya, yb, yc); by1 = Math.max(by1, ya, yb, yc);
      const la = Math.hypot(xb - xc, yb - yc), lb = Math.hypot(xc - xa, yc - ya), lc = Math.hypot(xa - xb, ya - yb);
      const twice = (xb - xa) * (yc - ya) - (xc - xa) * (yb - ya);
      const alpha = Math.atan2(twice, (xb - xa) * (xc - xa) + (yb - ya) * (yc - ya)) * degrees;
      const beta = Math.atan2(twice, (xa - xb) * (xc - xb) + (ya - yb) * (yc - yb)) * degrees,
        gamma = 180 - alpha - beta;
      const small = Math.min(alpha, beta, gamma), large = Math.max(alpha, beta, gamma);
      for (const angle of [alpha, beta, gamma]) histogram[Math.min(BINS - 1, Math.max(0,
        Math.floor(angle * BINS / 180)))]!++;
      if (small < minAngle) minAngle = small;
      if (large > maxAngle) maxAngle = large;
      area += twice / 2;
      const quality = 4 * twice * twice / ((la + lb + lc) * la * lb * lc || 1);
      let region = 0;
      if (width) {
        const attribute = mesh.regions[sorted[i]! * width]!;
        region = regionNumber.get(attribute) ?? regionNumber.set(attribute, regionNumber.size).size - 1;
      }
      const edges = (onSegment[b]! & onSegment[c]! && isSegment(b, c) ? 1 : 0) |
        (onSegment[c]! & onSegment[a]! && isSegment(c, a) ? 2 : 0) | (onSegment[a]! & onSegment[b]! && isSegment(a,
          b) ? 4 : 0);
      for (let v = 12 * i; v < 12 * i + 12; v += 4) {
        values[v] = small * 255 / 60; values[v + 1] = quality * 255; values[v + 2] = region % 256;
          values[v + 3] = edges;
      }
    }
    chunks.push(ox, oy, bx0, by0, bx1, by1, start, end - start);
  }
  return {
    points: p.length / 2, triangles: n, segments: mesh.segments.length / 2, minAngle: n ? minAngle : 0, maxAngle, area,
    histogram, regions: [...regionNumber.keys()], notes: mesh.notes,
    layout: { positions, values, chunks: new Float64Array(chunks), box },
  };
}

/** Adds hole points to figures with the even-odd rule, so that other programs find the same domain. The holes are faces
 * that the triangulation of the whole enclosed area has, but that of the domain does not: one point for each. */
function withHoles(mesher: Mesher, text: string): string {
  const all = mesher.mesh(), p = all.points.slice(), t = all.triangles.slice(), segments = all.segments.slice();
  const domain = mesher.mesh({ evenOdd: true }).triangles;
  if (domain.length === t.length) return text;
  const corners = (of: Int32Array, i: number) => `${of.subarray(i, i + 3).slice().sort()}`;
  const inside = new Set<string>(), isSegment = pairSet(segments), sides = new Map<string, number>();
  for (let i = 0; i < domain.length; i += 3) inside.add(corners(domain, i));
  const face = new Int32Array(t.length).map((_, i) => i), largest = new Map<number, [number, number, number]>();
  const root = (i: number): number => { while (face[i] !== i) i = face[i] = face[face[i]!]!; return i; };
  for (let i = 0; i < t.length; i += 3) {
    if (inside.has(corners(t, i))) { face[i] = -1; continue; }
    for (let k = 0; k < 3; k++) {
      const a = t[i + k]!, b = t[i + (k + 1) % 3]!, other = sides.get(`${b} ${a}`);
      if (isSegment(a, b)) continue;
      if (other === undefined) sides.set(`${a} ${b}`, i); else face[root(i)] = root(other);
    }
  }
  for (let i = 0; i < t.length; i += 3) {
    if (face[i]! < 0) continue;
    const [a, b, c] = [2 * t[i]!, 2 * t[i + 1]!, 2 * t[i + 2]!];
    const twice = (p[b]! - p[a]!) * (p[c + 1]! - p[a + 1]!) - (p[c]! - p[a]!) * (p[b + 1]! - p[a + 1]!);
    if (twice > (largest.get(root(i))?.[0] ?? 0))
      largest.set(root(i), [twice, (p[a]! + p[b]! + p[c]!) / 3, (p[a + 1]! + p[b + 1]! + p[c + 1]!) / 3]);
  }
  return text.replace(/\n0\n$/, `\n${largest.size}\n` +
    [...largest.values()].map(([, x, y], i) => `${i + 1} ${x} ${y}\n`).join(""));
}

let loading: Promise<Mesher>, meshed = 0; // number of the job whose mesh is in memory
let last = 0;

function run(mesher: Mesher, { id, name, text, settings }: Job): Result {
  meshed = 0;
  last = performance.now();
  mesher.read(name, text);
  if (settings.evenOdd) mesher.read(name, text = withHoles(mesher, text));
  const f = mesher.figure(), outline = new Float64Array(f.segments.length * 2);
  f.segments.forEach((v, i) => { outline[2 * i] = f.points[2 * v] ?? NaN;
    outline[2 * i + 1] = f.points[2 * v + 1] ?? NaN; });
  const start = performance.now(), mesh = mesher.mesh(settings), ms = performance.now() - start;
  meshed = id;
  return { ...measure(mesh), id, ms, outline, unmet: mesher.unmet(settings), text };
}

self.onmessage = async ({ data }: MessageEvent<Question>) => {
  const id = data.kind === "mesh" ? data.job.id : data.kind === "write" ? data.id : 0;
  try {
    if (data.kind === "start") {
      loading = Mesher.load(data.module, (done, triangles) => {
        if (performance.now() - last < 80) return;
        last = performance.now();
        say({ kind: "progress", done, triangles });
      });
      say({ kind: "ready", version: (await loading).version });
      return;
    }
    const mesher = await loading;
    if (data.kind === "mesh") {
      const result = run(mesher, data.job), { positions, values, chunks } = result.layout;
      say({ kind: "result", result }, [positions.buffer, values.buffer, chunks.buffer, result.outline.buffer]);
    } else {
      if (meshed !== data.job.id) run(mesher, data.job);
      say({ kind: "files", id, files: [...mesher.write(data.name)] });
    }
  } catch (fault) {
    const at = fault instanceof MeshError ? fault : { line: 0, status: 7 };
    const text = fault instanceof MeshError ? fault.message : `the mesher failed: ${(fault as Error).message}`;
    say({ kind: "error", id, text, line: at.line, status: at.status });
  }
};
