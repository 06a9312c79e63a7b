// The mesher in WebAssembly, for node, browsers and workers. Figures are passed as the text of .poly or .node files.
// Meshes are returned as typed arrays, or as the bytes of a file in any format that ptriangle writes. The same input
// gives the same bytes on all platforms.

export interface Settings {
  /** No smaller angle, in degrees; 0: no bound. 30 is a good choice, 34 works on nearly all figures. */
  minAngle?: number;
  /** Largest area of a triangle; 0: no bound. */
  maxArea?: number;
  /** Length of edges; 0: no bound. With growth, the length on all segments. */
  size?: number;
  /** Growth of edges per unit of distance from the segments; 0: the size applies everywhere. */
  growth?: number;
  /** Every triangle is Delaunay, not only constrained Delaunay. */
  conforming?: boolean;
  /** Inserts no new points on the boundary. */
  protect?: boolean;
  /** Points inside an odd number of rings are in the domain. Otherwise the figure's holes decide. */
  evenOdd?: boolean;
  /** Applies the area bounds of regions. */
  regionAreas?: boolean;
}

/** A figure or a bound is invalid; line counts from 1, 0 if the error concerns no line. */
export class MeshError extends Error {
  constructor(readonly status: number, message: string, readonly line: number) {
    super(message);
    this.name = "MeshError";
  }
}

/** Views of the module's memory: copy them before the next call. Triangles are counter-clockwise. */
export interface Mesh {
  points: Float64Array;
  pointMarkers: Int32Array;
  triangles: Int32Array;
  /** Attribute of each triangle's region, or empty. */
  regions: Float64Array;
  segments: Int32Array;
  segmentMarkers: Int32Array;
  /** Warnings about the result, one per line, or "". */
  notes: string;
}

export type Progress = (done: number, triangles: number) => void;

interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  malloc(n: number): number;
  free(at: number): void;
  web_file(name: number, size: number): number;
  web_file_bytes(name: number): number;
  web_file_size(name: number): number;
  web_file_remove(name: number): void;
  web_read(name: number): number;
  web_mesh(angle: number, area: number, size: number, growth: number, flags: number): number;
  web_unmet(angle: number, flags: number, reason: number): number;
  web_write(name: number, first: number): number;
  web_error_text(): number;
  web_error_line(): number;
  web_notes(): number;
  web_version(): number;
  web_rows(what: number): number;
  web_rows_n(what: number): number;
  web_rows_width(what: number): number;
  web_rows_stride(what: number): number;
}

const statusWords = ["", "out of memory", "too large", "bad input", "cannot read", "cannot write", "no room",
  "internal error", "stopped"];

export class Mesher {
  private hasFigure = false;
  private constructor(private readonly c: Exports) {}

  /** Starts the module, given as bytes or as a compiled module. */
  static async load(wasm: BufferSource | WebAssembly.Module, progress: Progress = () => {}): Promise<Mesher> {
    const nothing = () => 52; // "not supported", for functions of the C library that print
    const imports = {
      host: { progress },
      wasi_snapshot_preview1: { fd_close: nothing, fd_seek: nothing, fd_write: nothing },
    };
    const module = wasm instanceof WebAssembly.Module ? wasm : await WebAssembly.compile(wasm);
    const instance = await WebAssembly.instantiate(module, imports);
    const c = instance.exports as unknown as Exports;
    c._initialize();
    return new Mesher(c);
  }

  get version(): string { return this.text(this.c.web_version()); }

  /** Reads a figure. The ending of the name, .poly or .node, selects the format. Frees the last figure and its mesh. */
  read(name: string, content: string | Uint8Array): void {
    const bytes = typeof content === "string" ? new TextEncoder().encode(content) : content;
    this.hasFigure = false;
    this.named(name, (at) => {
      const place = this.c.web_file(at, bytes.length);
      if (!place) throw new MeshError(1, "out of memory", 0);
      new Uint8Array(this.c.memory.buffer, place, bytes.length).set(bytes);
      const status = this.c.web_read(at);
      this.c.web_file_remove(at);
      this.check(status);
      this.hasFigure = true;
    });
  }

  /** Returns the points of the figure, and the segments between them. */
  figure(): { points: Float64Array; segments: Int32Array } {
    return { points: this.reals(6), segments: this.ints(7) };
  }

  /** Meshes the figure. Without bounds the result is its constrained Delaunay triangulation. */
  mesh(s: Settings = {}): Mesh {
    if (!this.hasFigure) throw new MeshError(3, "no figure has been read", 0);
    for (const key of ["minAngle", "maxArea", "size", "growth"] as const)
      if (!((s[key] ?? 0) >= 0)) throw new MeshError(3, `${key} is ${s[key]}, and must be 0 or more`, 0);
    this.check(this.c.web_mesh(s.minAngle ?? 0, s.maxArea ?? 0, s.size ?? 0, s.growth ?? 0, this.flags(s)));
    return this.current();
  }

  /** Returns the number of triangles that violate this angle bound, by reason: small angles of the figure, narrow gaps,
   * protected segments, a bound that needs endless points, precision, deferred. */
  unmet(s: Settings): number[] {
    return Array.from({ length: 6 }, (_, reason) =>
      this.c.web_unmet(s.minAngle ?? 0, this.flags(s), reason));
  }

  /** Returns new views of the mesh, for instance after memory has grown. */
  current(): Mesh {
    return {
      points: this.reals(0), pointMarkers: this.ints(1), triangles: this.ints(2), regions: this.reals(3),
      segments: this.ints(4), segmentMarkers: this.ints(5), notes: this.text(this.c.web_notes()),
    };
  }

  /** Returns the mesh as files: x.vtu, x.msh, x.2dm, x.14 and x.grd are one file; "x" is x.node, x.ele and x.poly. */
  write(name: string, first: 0 | 1 = 1): Map<string, Uint8Array> {
    this.named(name, (at) => this.check(this.c.web_write(at, first)));
    const files = new Map<string, Uint8Array>();
    for (const each of [name, name + ".node", name + ".ele", name + ".poly"])
      this.named(each, (at) => {
        const place = this.c.web_file_bytes(at);
        if (!place) return;
        files.set(each, new Uint8Array(this.c.memory.buffer, place, this.c.web_file_size(at)).slice());
        this.c.web_file_remove(at);
      });
    return files;
  }

  private flags(s: Settings): number {
    return (s.conforming ? 1 : 0) | (s.protect ? 2 : 0) | (s.evenOdd ? 4 : 0) | (s.regionAreas ? 8 : 0);
  }

  private check(status: number): void {
    if (status === 0) return;
    const text = this.text(this.c.web_error_text()) || statusWords[status] || `error ${status}`;
    throw new MeshError(status, text, this.c.web_error_line());
  }

  private text(at: number): string {
    const bytes = new Uint8Array(this.c.memory.buffer, at);
    return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
  }

  private named<T>(name: string, use: (at: number) => T): T {
    const bytes = new TextEncoder().encode(name + "\0");
    const at = this.c.malloc(bytes.length);
    if (!at) throw new MeshError(1, "out of memory", 0);
    new Uint8Array(this.c.memory.buffer, at, bytes.length).set(bytes);
    try { return use(at); } finally { this.c.free(at); }
  }

  private reals(what: number): Float64Array { return this.rows(what, Float64Array); }
  private ints(what: number): Int32Array { return this.rows(what, Int32Array); }

  private rows<A extends Float64Array | Int32Array>(
    what: number, type: { new (b: ArrayBuffer, at: number, n: number): A; new (n: number): A },
  ): A {
    const c = this.c, n = c.web_rows_n(what), width = c.web_rows_width(what), stride = c.web_rows_stride(what);
    if (n === 0) return new type(0);
    const all = new type(c.memory.buffer as ArrayBuffer, c.web_rows(what), (n - 1) * stride + width);
    if (stride === width) return all;
    const packed = new type(n * width);
    for (let i = 0; i < n; i++) for (let k = 0; k < width; k++) packed[i * width + k] = all[i * stride + k];
    return packed;
  }
}
