// The picture: WebGL2 with pan and zoom. A frame draws at most BUDGET triangles. If more are in sight, the last picture
// moves along. When the input stops, a new picture is drawn in slices, one per frame. Edges fade if they would fill the
// triangles; then the shade shows the density.
import type { Layout } from "./worker";

const BUDGET = 60000;
export type Colour = "angle" | "quality" | "region";
export interface Camera { x: number; y: number; scale: number } // the middle of the picture; pixels for a unit

const vertexShader = `#version 300 es
in vec2 place; in vec4 value;
uniform vec2 origin, half_size; uniform float scale; uniform int channel;
out vec3 corner; out float shade; flat out int edges;
void main() {
  int k = gl_VertexID % 3;
  corner = vec3(k == 0, k == 1, k == 2);
  shade = channel == 0 ? value.x : channel == 1 ? value.y : value.z;
  edges = int(value.w * 255.0 + 0.5);
  gl_Position = vec4((origin + place * scale) / half_size, 0, 1);
}`;
const fragmentShader = `#version 300 es
precision highp float;
in vec3 corner; in float shade; flat in int edges;
uniform sampler2D palette; uniform vec3 ink, line; uniform float dot_size;
out vec4 result;
void main() {
  vec3 slope = max(fwidth(corner), 1e-9), away = corner / slope;
  float height = 1.0 / max(slope.x, max(slope.y, slope.z)) / dot_size;
  vec3 fill = texture(palette, vec2((floor(shade * 255.0 + 0.5) + 0.5) / 256.0, 0.5)).rgb;
  fill = mix(fill, ink, 0.22 * (1.0 - smoothstep(0.5, 5.0, height)));
  float near_edge = min(away.x, min(away.y, away.z));
  float edge = (1.0 - smoothstep(0.25 * dot_size, 0.95 * dot_size, near_edge)) * smoothstep(3.0, 16.0, height);
  vec3 far = vec3((edges & 1) != 0 ? away.x : 1e9, (edges & 2) != 0 ? away.y : 1e9, (edges & 4) != 0 ? away.z : 1e9);
  float border = 1.0 - smoothstep(0.9 * dot_size, 1.7 * dot_size, min(far.x, min(far.y, far.z)));
  vec3 colour = mix(fill, ink, 0.62 * edge);
  result = vec4(mix(colour, line, border * smoothstep(0.2, 1.6, height)), 1);
}`;
const copyVertex = `#version 300 es
uniform vec4 box; out vec2 uv;
void main() { vec2 c = vec2(gl_VertexID & 1, gl_VertexID >> 1); uv = c; gl_Position = vec4(mix(box.xy, box.zw, c), 0,
  1); }`;
const copyFragment = `#version 300 es
precision highp float;
in vec2 uv; uniform sampler2D picture; out vec4 result;
void main() { result = texture(picture, uv); }`;

const RAMP = { // from the worst to the best angle or quality
  light: ["#9e2a2b", "#d1495b", "#eb8258", "#f3c26b", "#e8e3b3", "#b5d8b8", "#7cbfae", "#4a9da3"],
  dark: ["#ff5d5d", "#e0524f", "#d57a4b", "#b98f4a", "#7f8f63", "#3f7f74", "#2a6878", "#27506e"],
};
const REGIONS = {
  light: ["#a9cfd0", "#f2cf9b", "#c9c3e6", "#b9d9a5", "#efb9b0", "#e3dfa0", "#b5cdf0", "#e2bcd8"],
  dark: ["#27566a", "#7a5a2c", "#4b4480", "#3f6635", "#803f3b", "#6b6630", "#30538a", "#6d3f66"],
};
const rgb = (hex: string): [number, number, number] =>
  [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16)) as [number, number, number];

export function paletteOf(colour: Colour, dark: boolean): Uint8Array {
  const stops = (colour === "region" ? REGIONS : RAMP)[dark ? "dark" : "light"].map(rgb), bytes = new Uint8Array(1024);
  for (let i = 0; i < 256; i++) {
    const t = i / 255 * (stops.length - 1), k = Math.min(stops.length - 2, Math.floor(t));
    for (let c = 0; c < 3; c++)
      bytes[4 * i + c] = colour === "region" ? stops[i % stops.length]![c]!
        : stops[k]![c]! + (stops[k + 1]![c]! - stops[k]![c]!) * (t - k);
    bytes[4 * i + 3] = 255;
  }
  return bytes;
}

export class View {
  camera: Camera = { x: 0, y: 0, scale: 1 };
  colour: Colour = "angle";
  dark = false;
  onframe = () => {};
  stats = { drawn: 0, slices: 0, mostInFrame: 0 }; // of the last picture
  private gl: WebGL2RenderingContext;
  private program: WebGLProgram;
  private copy: WebGLProgram;
  private places: Record<string, WebGLUniformLocation | null> = {};
  private box: number[] | null = null;
  private chunks: Float64Array = new Float64Array(0);
  private buffers: WebGLBuffer[];
  private array: WebGLVertexArrayObject;
  private palette: WebGLTexture;
  private many: WebGLFramebuffer;  // several samples per pixel
  private plain: WebGLFramebuffer; // their average: the picture
  private picture: WebGLTexture;
  private samples: WebGLRenderbuffer;
  private size = [0, 0];
  private taken: (Camera & { width: number; height: number }) | null = null; // camera of the picture
  private waiting = 0;
  private queue: number[] = [];
  private requested = false;
  private fitted = true;

  constructor(readonly canvas: HTMLCanvasElement) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: true, premultipliedAlpha: true,
      preserveDrawingBuffer: true });
    if (!gl) throw new Error("this browser offers no WebGL2, so meshes are made but not drawn");
    this.gl = gl;
    this.program = this.build(vertexShader, fragmentShader);
    this.copy = this.build(copyVertex, copyFragment);
    for (const name of ["origin", "half_size", "scale", "channel", "ink", "line", "dot_size"])
      this.places[name] = gl.getUniformLocation(this.program, name);
    this.buffers = [gl.createBuffer()!, gl.createBuffer()!];
    this.array = gl.createVertexArray()!;
    this.palette = gl.createTexture()!;
    this.picture = gl.createTexture()!;
    this.many = gl.createFramebuffer()!;
    this.plain = gl.createFramebuffer()!;
    this.samples = gl.createRenderbuffer()!;
    new ResizeObserver(() => { if (this.fitted) this.fit(); this.request(); }).observe(canvas);
  }

  private build(vertex: string, fragment: string): WebGLProgram {
    const gl = this.gl, program = gl.createProgram()!;
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]] as const) {
      const shader = gl.createShader(kind)!;
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.bindAttribLocation(program, 0, "place");
    gl.bindAttribLocation(program, 1, "value");
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program) ?? "no shader");
    return program;
  }

  setLayout(layout: Layout | null): void {
    const gl = this.gl;
    this.chunks = layout ? layout.chunks : new Float64Array(0);
    this.box = layout ? layout.box : null;
    this.taken = null;
    if (layout) {
      gl.bindVertexArray(this.array);
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[0]!);
      gl.bufferData(gl.ARRAY_BUFFER, layout.positions, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(0);
      gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[1]!);
      gl.bufferData(gl.ARRAY_BUFFER, layout.values, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(1);
      gl.vertexAttribPointer(1, 4, gl.UNSIGNED_BYTE, true, 0, 0);
      gl.bindVertexArray(null);
    }
    this.request();
  }

  fitTo(box: number[]): void { this.box = box; this.fit(); }

  fit(): void {
    const w = this.canvas.clientWidth, h = this.canvas.clientHeight;
    if (!this.box || !w || !h) return;
    const [x0, y0, x1, y1] = this.box as [number, number, number, number], margin = 0.9;
    this.camera = { x: (x0 + x1) / 2, y: (y0 + y1) / 2,
      scale: margin * Math.min(w / (x1 - x0 || 1e-300), h / (y1 - y0 || 1e-300)) || 1 };
    this.fitted = true;
    this.request();
  }

  /** Convert between screen and figure. Screen positions are CSS pixels from the upper left corner. */
  toFigure(px: number, py: number): [number, number] {
    const c = this.camera;
    return [c.x + (px - this.canvas.clientWidth / 2) / c.scale, c.y - (py - this.canvas.clientHeight / 2) / c.scale];
  }
  toScreen(x: number, y: number): [number, number] {
    const c = this.camera;
    return [(x - c.x) * c.scale + this.canvas.clientWidth / 2, (c.y - y) * c.scale + this.canvas.clientHeight / 2];
  }

  pan(dx: number, dy: number): void {
    this.camera.x -= dx / this.camera.scale;
    this.camera.y += dy / this.camera.scale;
    this.fitted = false;
    this.request();
  }

  zoom(factor: number, px = this.canvas.clientWidth / 2, py = this.canvas.clientHeight / 2): void {
    const [x, y] = this.toFigure(px, py), b = this.box ?? [0, 0, 1, 1];
    const extent = Math.max(b[2]! - b[0]!, b[3]! - b[1]!) || 1;
    const scale = Math.min(1e12 / extent, Math.max(20 / extent, this.camera.scale * factor));
    this.camera.x = x - (x - this.camera.x) * this.camera.scale / scale;
    this.camera.y = y - (y - this.camera.y) * this.camera.scale / scale;
    this.camera.scale = scale;
    this.fitted = false;
    this.request();
  }

  repaint(): void { this.taken = null; this.request(); }

  request(): void {
    clearTimeout(this.waiting);
    this.queue = [];
    this.schedule();
  }

  private schedule(): void {
    if (this.requested) return;
    this.requested = true;
    requestAnimationFrame(() => { this.requested = false; this.frame(); });
  }

  /** Returns the visible chunks and their number of triangles. */
  private visible(): { list: number[]; triangles: number } {
    const { x, y, scale } = this.camera, hw = this.canvas.clientWidth / 2 / scale,
      hh = this.canvas.clientHeight / 2 / scale;
    const list: number[] = [], c = this.chunks;
    let triangles = 0;
    for (let i = 0; i < c.length; i += 8)
      if (c[i + 2]! <= x + hw && c[i + 4]! >= x - hw && c[i + 3]! <= y + hh && c[i + 5]! >= y - hh) {
        list.push(i);
        triangles += c[i + 7]!;
      }
    return { list, triangles };
  }

  private frame(): void {
    const gl = this.gl, ratio = devicePixelRatio || 1;
    const w = Math.round(this.canvas.clientWidth * ratio), h = Math.round(this.canvas.clientHeight * ratio);
    if (!w || !h) return;
    if (this.canvas.width !== w || this.canvas.height !== h) { this.canvas.width = w; this.canvas.height = h; }
    if (this.queue.length) { this.slice(); return; }
    const { list, triangles } = this.visible();
    this.screen();
    if (triangles <= BUDGET) {
      this.draw(list);
      this.stats = { drawn: triangles, slices: 1, mostInFrame: triangles };
    } else if (!this.isTaken()) {
      this.paste();
      this.waiting = window.setTimeout(() => this.begin(list), this.taken ? 120 : 0);
    } else this.paste();
    gl.flush();
    this.onframe();
  }

  private isTaken(): boolean {
    const t = this.taken, c = this.camera;
    return !!t && t.x === c.x && t.y === c.y && t.scale === c.scale && t.width === this.canvas.width
      && t.height === this.canvas.height;
  }

  private screen(): void {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
  }

  private draw(list: number[]): void {
    const gl = this.gl, ratio = this.canvas.width / this.canvas.clientWidth, c = this.chunks, { x, y,
      scale } = this.camera;
    gl.useProgram(this.program);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.palette);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, paletteOf(this.colour, this.dark));
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.uniform2f(this.places.half_size!, this.canvas.width / 2, this.canvas.height / 2);
    gl.uniform1f(this.places.scale!, scale * ratio);
    gl.uniform1i(this.places.channel!, ["angle", "quality", "region"].indexOf(this.colour));
    gl.uniform1f(this.places.dot_size!, ratio);
    gl.uniform3fv(this.places.ink!, rgb(this.dark ? "#0b1116" : "#1d3b44").map((v) => v / 255));
    gl.uniform3fv(this.places.line!, rgb(this.dark ? "#eef4f2" : "#10242b").map((v) => v / 255));
    gl.bindVertexArray(this.array);
    for (const i of list) {
      gl.uniform2f(this.places.origin!, (c[i]! - x) * scale * ratio, (c[i + 1]! - y) * scale * ratio);
      gl.drawArrays(gl.TRIANGLES, 3 * c[i + 6]!, 3 * c[i + 7]!);
    }
    gl.bindVertexArray(null);
  }

  /** Draws the last picture at its place under the current camera. */
  private paste(): void {
    const gl = this.gl, t = this.taken, c = this.camera;
    if (!t) return;
    const k = c.scale / t.scale, w = t.width / this.canvas.width * k, h = t.height / this.canvas.height * k;
    const mx = (t.x - c.x) * c.scale / (this.canvas.clientWidth / 2),
      my = (t.y - c.y) * c.scale / (this.canvas.clientHeight / 2);
    gl.useProgram(this.copy);
    gl.bindTexture(gl.TEXTURE_2D, this.picture);
    gl.uniform4f(gl.getUniformLocation(this.copy, "box"), mx - w, my - h, mx + w, my + h);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }

  private begin(list: number[]): void {
    const gl = this.gl, w = this.canvas.width, h = this.canvas.height;
    if (this.size[0] !== w || this.size[1] !== h) {
      gl.bindRenderbuffer(gl.RENDERBUFFER, this.samples);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, Math.min(4, gl.getParameter(gl.MAX_SAMPLES)), gl.RGBA8, w, h);
      gl.bindFramebuffer(gl.FRAMEBUFFER, this.many);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.RENDERBUFFER, this.samples);
      gl.bindTexture(gl.TEXTURE_2D, this.picture);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, w, h, 0, gl.RGBA, gl.UNSIGNED_BYTE, null);
      for (const [name, v] of [[gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_MAG_FILTER, gl.LINEAR],
        [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]] as const)
        gl.texParameteri(gl.TEXTURE_2D, name, v);
      gl.bindFramebuffer(gl.FRAMEBUFFER, this.plain);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.picture, 0);
      this.size = [w, h];
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.many);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    this.queue = list.slice();
    this.stats = { drawn: 0, slices: 0, mostInFrame: 0 };
    this.schedule();
  }

  private slice(): void {
    const gl = this.gl, w = this.canvas.width, h = this.canvas.height, now: number[] = [];
    let triangles = 0;
    while (this.queue.length && triangles < BUDGET - 2048) {
      const i = this.queue.pop()!;
      now.push(i);
      triangles += this.chunks[i + 7]!;
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.many);
    gl.viewport(0, 0, w, h);
    this.draw(now);
    this.stats.drawn += triangles;
    this.stats.slices++;
    this.stats.mostInFrame = Math.max(this.stats.mostInFrame, triangles);
    if (this.queue.length) { gl.flush(); this.schedule(); return; }
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.many);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, this.plain);
    gl.blitFramebuffer(0, 0, w, h, 0, 0, w, h, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    this.taken = { ...this.camera, width: w, height: h };
    this.screen();
    this.paste();
    this.onframe();
  }
}
