// Converts outlines (GeoJSON, DXF, SVG, drawn rings) to the text of a .poly file.
import DxfParser from "dxf-parser";
import { SVGPathData } from "svg-pathdata";

export interface Figure {
  name: string;
  poly: string;
  /** Rings define the domain (even-odd rule); otherwise holes and regions of the file do. */
  evenOdd: boolean;
  /** The text whose lines errors refer to. */
  file?: string;
  /** The text is a .node file. */
  node?: boolean;
  /** Note about parts that were left out. */
  note?: string;
  /** Name of the example. */
  key?: string;
}
export type Ring = [number, number][];
interface Line { points: Ring; closed: boolean }

function extentOf(lines: Line[]): number {
  const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  for (const l of lines) for (const p of l.points) for (const k of [0, 1]) {
    low[k] = Math.min(low[k]!, p[k]!);
    high[k] = Math.max(high[k]!, p[k]!);
  }
  return Math.max(high[0]! - low[0]!, high[1]! - low[1]!);
}

/** Rounds coordinates to nine digits of the extent, so that places that differ only by rounding are equal. */
function rounded(lines: Line[]): Line[] {
  const extent = extentOf(lines), known = extent > 0 && extent < Infinity;
  const unit = known ? 10 ** (8 - Math.floor(Math.log10(extent))) : 1;
  const round = (v: number) => Math.round(v * unit) / unit + 0;
  return lines.map((l) => ({ ...l, points: l.points.map(([x, y]) => [round(x), round(y)]) }));
}

/** Merges ends of lines that are closer than 1e-6 of the extent. */
function joined(lines: Line[]): Line[] {
  const reach = extentOf(lines) * 1e-6, cells = new Map<string, [number, number]>();
  for (const { points } of lines.filter((l) => !l.closed))
    for (const k of [0, points.length - 1]) {
      const [x, y] = points[k]!, i = Math.floor(x / reach), j = Math.floor(y / reach);
      const near = [0, -1, 1].flatMap((a) => [0, -1, 1].map((b) => cells.get(`${i + a} ${j + b}`)))
        .find((p) => p && Math.hypot(p[0] - x, p[1] - y) <= reach);
      if (near) points[k] = near; else cells.set(`${i} ${j}`, points[k]!);
    }
  return lines;
}

/** Merges equal points, so that lines that meet are joined. */
function toPoly(lines: Line[]): string {
  const places = new Map<string, number>(), points: string[] = [], segments: string[] = [];
  const number = ([x, y]: [number, number]) => {
    if (!Number.isFinite(x) || !Number.isFinite(y)) throw new Error(`a coordinate is not a finite number: ${x}, ${y}`);
    const key = `${x} ${y}`, known = places.get(key);
    if (known !== undefined) return known;
    points.push(`${points.length + 1} ${key}`);
    places.set(key, points.length);
    return points.length;
  };
  for (const { points: ring, closed } of lines) {
    const ids = ring.map(number);
    for (let i = closed ? 0 : 1; i < ids.length; i++) {
      const from = ids[(i + ids.length - 1) % ids.length]!, to = ids[i]!;
      if (from !== to) segments.push(`${segments.length + 1} ${from} ${to}`);
    }
  }
  if (!segments.length) throw new Error("no outlines are in it");
  return `${points.length} 2 0 0\n${points.join("\n")}\n${segments.length} 0\n${segments.join("\n")}\n0\n`;
}

export const fromRings = (rings: Ring[], name = "drawing"): Figure =>
  ({ name, poly: toPoly(rings.map((points) => ({ points, closed: true }))), evenOdd: true });

// --- GeoJSON: polygons and lines of any nesting; degrees become kilometres on a plane about their middle

function fromGeoJson(text: string): Line[] {
  let root: any;
  try { root = JSON.parse(text); } catch (fault) { throw new Error(`this is not JSON: ${(fault as Error).message}`); }
  const lines: Line[] = [];
  const add = (c: number[][], closed: boolean) => {
    const points = c.map((p) => [Number(p[0]), Number(p[1])] as [number, number]);
    const first = points[0], last = points[points.length - 1];
    if (closed && first && last && first[0] === last[0] && first[1] === last[1]) points.pop();
    lines.push({ points, closed });
  };
  const visit = (g: any): void => {
    switch (g?.type) {
      case "FeatureCollection": return g.features?.forEach(visit);
      case "Feature": return visit(g.geometry);
      case "GeometryCollection": return g.geometries.forEach(visit);
      case "Polygon": return g.coordinates.forEach((r: number[][]) => add(r, true));
      case "MultiPolygon": return g.coordinates.flat().forEach((r: number[][]) => add(r, true));
      case "LineString": return add(g.coordinates, false);
      case "MultiLineString": return g.coordinates.forEach((r: number[][]) => add(r, false));
    }
  };
  try { visit(root); } catch { throw new Error("coordinates or parts are missing in this GeoJSON"); }
  if (!lines.length) throw new Error("no polygons or lines are in this GeoJSON");
  const all = lines.flatMap((l) => l.points);
  if (!all.every(([x, y]) => Math.abs(x) <= 360 && Math.abs(y) <= 90)) return lines;
  const middle = (k: 0 | 1) => { let a = 1e9, b = -1e9; for (const p of all) { a = Math.min(a, p[k]); b = Math.max(b,
    p[k]); }
    return (a + b) / 2; };
  const x0 = middle(0), y0 = middle(1), wide = Math.cos(y0 * Math.PI / 180) * 111.32;
  return rounded(lines.map((l) => ({ ...l, points: l.points.map(([x, y]) => [(x - x0) * wide, (y - y0) * 110.57]) })));
}

// --- DXF: lines, polylines with bulges, circles, arcs, ellipses, splines

function arc(cx: number, cy: number, r: number, from: number, to: number): Ring {
  const n = Math.max(2, Math.ceil(Math.abs(to - from) / (Math.PI / 24)));
  return Array.from({ length: n + 1 }, (_, i) => {
    const a = from + (to - from) * i / n;
    return [cx + r * Math.cos(a), cy + r * Math.sin(a)];
  });
}

/** A bulge is the tangent of a quarter of the arc's angle. */
function bulged(p: any, q: any): Ring {
  const b = p.bulge ?? 0;
  if (!b) return [[p.x, p.y]];
  const dx = q.x - p.x, dy = q.y - p.y, h = (1 / b - b) / 4;
  const cx = (p.x + q.x) / 2 - dy * h, cy = (p.y + q.y) / 2 + dx * h, from = Math.atan2(p.y - cy, p.x - cx);
  const points = arc(cx, cy, Math.hypot(p.x - cx, p.y - cy), from, from + 4 * Math.atan(b)).slice(0, -1);
  points[0] = [p.x, p.y];
  return points;
}

function fromDxf(text: string): { lines: Line[]; note: string } {
  let entities: any[];
  try { entities = new DxfParser().parseSync(text)?.entities ?? []; }
  catch (fault) { throw new Error(`this DXF cannot be read: ${(fault as Error).message}`); }
  const lines: Line[] = [];
  let left = 0;
  const add = (points: Ring, closed: boolean) => points.length && lines.push({ points, closed });
  for (const e of entities) {
    const v = e.vertices ?? [];
    if (e.type === "LINE") add(v.map((p: any) => [p.x, p.y]), false);
    else if (e.type === "LWPOLYLINE" || e.type === "POLYLINE") {
      const n = v.length, closed = Boolean(e.shape);
      const ring = v.flatMap((p: any, i: number) => i + 1 < n || closed ? bulged(p, v[(i + 1) % n]) : [[p.x, p.y]]);
      add(ring, closed);
    } else if (e.type === "CIRCLE") add(arc(e.center.x, e.center.y, e.radius, 0, 2 * Math.PI).slice(0, -1), true);
    else if (e.type === "ARC")
      add(arc(e.center.x, e.center.y, e.radius, e.startAngle,
        e.endAngle < e.startAngle ? e.endAngle + 2 * Math.PI : e.endAngle), false);
    else if (e.type === "ELLIPSE") {
      const { x, y } = e.majorAxisEndPoint, k = e.axisRatio;
      const whole = Math.abs(e.endAngle - e.startAngle - 2 * Math.PI) < 1e-6;
      const points = arc(0, 0, 1, e.startAngle, e.endAngle)
        .map(([c, s]) => [e.center.x + x * c - y * k * s, e.center.y + y * c + x * k * s] as [number, number]);
      add(whole ? points.slice(0, -1) : points, whole);
    } else if (e.type === "SPLINE" && e.fitPoints?.length) add(e.fitPoints.map((p: any) => [p.x, p.y]),
      Boolean(e.closed));
    else if (["SPLINE", "INSERT", "3DFACE"].includes(e.type)) left++;
  }
  const note = left ? `${left} spline${left > 1 ? "s" : ""}, blocks or faces were left out` : "";
  if (!lines.length) throw new Error("no lines, polylines, circles or arcs are in this DXF" + (note && `; ${note}`));
  return { lines: joined(rounded(lines)), note };
}

// --- SVG: paths and simple shapes, or the text of one path; y points upwards afterwards

function pathLines(d: string): Line[] {
  const lines: Line[] = [];
  let line: Line = { points: [], closed: false }, at: [number, number] = [0, 0];
  const end = () => { if (line.points.length > 1) lines.push(line); };
  const go = (x: number, y: number) => { at = [x, y]; line.points.push([x, -y]); };
  const curve = (f: (t: number) => [number, number]) => { for (let i = 1; i <= 16; i++) go(...f(i / 16)); };
  for (const c of new SVGPathData(d).toAbs().normalizeHVZ(false).normalizeST().qtToC().aToC().commands as any[]) {
    const [x, y] = at;
    if (c.type === SVGPathData.MOVE_TO) { end(); line = { points: [], closed: false }; go(c.x, c.y); }
    else if (c.type === SVGPathData.LINE_TO) go(c.x, c.y);
    else if (c.type === SVGPathData.CLOSE_PATH) {
      const [first, last] = [line.points[0]!, line.points[line.points.length - 1]!];
      if (line.points.length > 1 && first[0] === last[0] && first[1] === last[1]) line.points.pop();
      line.closed = true;
    } else if (c.type === SVGPathData.QUAD_TO)
      curve((t) => [x, y].map((p, k) => (1 - t) ** 2 * p! + 2 * t * (1 - t) * [c.x1, c.y1][k] +
        t * t * [c.x, c.y][k]) as [number, number]);
    else if (c.type === SVGPathData.CURVE_TO)
      curve((t) => [x, y].map((p, k) => (1 - t) ** 3 * p! + 3 * t * (1 - t) ** 2 * [c.x1, c.y1][k] +
        3 * t * t * (1 - t) * [c.x2, c.y2][k] + t ** 3 * [c.x, c.y][k]) as [number, number]);
  }
  end();
  return lines.map((l) => ({ points: l.points, closed: true }));
}

const units: Record<string, number> = { "": 1, px: 1, mm: 96 / 25.4, cm: 96 / 2.54, in: 96, pt: 4 / 3, pc: 16 };

/** Leaves out empty and unreadable shapes, as browsers do. */
function fromSvg(text: string): Line[] {
  const lines: Line[] = [];
  let fault = "";
  const add = (d: string) => {
    try { lines.push(...pathLines(d).filter((l) => l.points.every((p) => p.every(Number.isFinite)))); }
    catch (error) { fault = (error as Error).message; }
  };
  if (text.trimStart().startsWith("<")) {
    const page = new DOMParser().parseFromString(text, "image/svg+xml"), bad = page.querySelector("parsererror");
    if (bad)
      throw new Error(`this is no valid XML: ${/error on line[^\n]*?(?=\n|Below|$)/.exec(bad.textContent!) ?? ""}`);
    const root = page.documentElement, box = (root.getAttribute("viewBox") ??
      `0 0 ${root.getAttribute("width")} ${root.getAttribute("height")}`).split(/[\s,]+/).map(parseFloat);
    for (const e of page.querySelectorAll("path, polygon, polyline, rect, circle, ellipse")) {
      if (e.closest("defs, clipPath, mask, symbol, pattern, marker")) continue;
      const n = (name: string) => {
        const [, v, unit] = /^\s*([-+.\de]*\d\.?)\s*(\S*)/.exec(e.getAttribute(name) ?? "0") ?? [];
        const [, , wide, high] = box as [number, number, number, number];
        const whole = /x|width/.test(name) ? wide : name === "r" ? Math.hypot(wide, high) / Math.SQRT2 : high;
        return parseFloat(v!) * (unit === "%" ? whole / 100 : units[unit!] ?? NaN);
      };
      const w = n("width"), h = n("height"), rx = n("rx") || n("r") || n("ry"), ry = n("ry") || n("r") || rx;
      if (e.localName === "path") add(e.getAttribute("d") ?? "");
      else if (e.localName.startsWith("poly")) add(`M${e.getAttribute("points") ?? ""}Z`);
      else if (e.localName === "rect") { if (w > 0 && h > 0) add(`M${n("x")} ${n("y")}h${w}v${h}h${-w}z`); }
      else if (rx > 0 && ry > 0)
        add(`M${n("cx") - rx} ${n("cy")}a${rx} ${ry} 0 1 0 ${2 * rx} 0a${rx} ${ry} 0 1 0 ${-2 * rx} 0z`);
    }
  } else add(text);
  if (!lines.length) throw new Error(fault ? `a path cannot be read: ${fault}` : "no paths are in this SVG");
  return rounded(lines);
}

/** Detects the format by the content, because file names may be wrong. */
export function parse(name: string, text: string): Figure {
  const start = text.slice(0, 2000).trimStart(), stem = name.replace(/\.[a-z0-9]+$/i, "") || "figure";
  const outlines = (lines: Line[]): Figure => ({ name: stem, poly: toPoly(lines), evenOdd: true });
  if (!start) throw new Error("the file is empty");
  if (start.startsWith("{") || start.startsWith("[")) return outlines(fromGeoJson(text));
  if (start.startsWith("<") || /^[Mm]\s*[-+.\d]/.test(start)) return outlines(fromSvg(text));
  if (/^(999[^]*?\n)?0\s*\n\s*SECTION/m.test(start)) {
    const { lines, note } = fromDxf(text);
    return { ...outlines(lines), note };
  }
  if (/^(#|[-+.\d])/.test(start)) {
    const rows = text.split("\n").map((row) => row.replace(/#.*/, "").trim()).filter(Boolean);
    const n = parseInt(rows[0] ?? "");
    if (n === 0) throw new Error("its points are in another file: paste the points of the .node file into it");
    const node = /\.node$/i.test(name) || (!/\.poly$/i.test(name) && rows.length === n + 1);
    return { name: stem, poly: text, evenOdd: false, file: name, ...(node && { node }) };
  }
  throw new Error("this is no .poly, GeoJSON, DXF or SVG");
}
