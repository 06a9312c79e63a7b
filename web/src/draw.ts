// Rings drawn with the mouse or a finger. A click adds a corner, a click on the first corner closes the ring, and
// corners can be dragged. Rings in rings are holes.
import type { Ring } from "./input";
import type { View } from "./view";

export class Drawing {
  on = false;
  rings: Ring[] = [];
  private open: Ring = [];
  private held: [number, number] | null = null; // ring and corner being dragged
  private mouse: [number, number] | null = null;

  constructor(private view: View, private under: HTMLElement, private canvas: HTMLCanvasElement,
    private changed: (rings: Ring[]) => void) {}

  enter(rings: Ring[] = []): void {
    this.on = true;
    this.rings = rings;
    this.open = [];
    this.sign();
  }

  leave(): void {
    if (this.open.length > 2) this.close();
    this.on = false;
    this.open = [];
    this.sign();
  }

  private sign(): void {
    const hint = document.getElementById("hint")!;
    document.body.classList.toggle("drawing", this.on);
    document.getElementById("draw")!.setAttribute("aria-pressed", String(this.on));
    hint.hidden = !this.on;
    hint.textContent = this.open.length > 2 ? "Click the first corner, or press Enter, to close the outline"
      : this.open.length || !this.rings.length ? "Click to set corners"
        : "Drag corners, draw a hole, or press Draw again to end";
    this.paint();
  }

  private rounded(px: number, py: number): [number, number] {
    const unit = 10 ** Math.floor(Math.log10(1 / this.view.camera.scale));
    return this.view.toFigure(px, py).map((v) => Number((Math.round(v / unit) * unit).toPrecision(12))) as [number,
      number];
  }

  private near(p: [number, number], px: number, py: number, reach = 10): boolean {
    const [x, y] = this.view.toScreen(...p);
    return Math.hypot(x - px, y - py) <= reach;
  }

  /** Returns true if the event belongs to the drawing. */
  down(e: PointerEvent): boolean {
    if (!this.on || e.button !== 0) return false;
    const { offsetX: px, offsetY: py } = e;
    if (!this.open.length)
      for (const [r, ring] of this.rings.entries())
        for (const [k, p] of ring.entries())
          if (this.near(p, px, py)) {
            this.held = [r, k];
            this.under.setPointerCapture(e.pointerId);
            return true;
          }
    if (this.open.length > 2 && this.near(this.open[0]!, px, py, 12)) this.close();
    else if (!this.open.length || !this.near(this.open[this.open.length - 1]!, px, py,
      3)) this.open.push(this.rounded(px, py));
    this.sign();
    return true;
  }

  move(e: PointerEvent): void {
    if (!this.on) return;
    this.mouse = [e.offsetX, e.offsetY];
    if (this.held) {
      this.rings[this.held[0]]![this.held[1]] = this.rounded(e.offsetX, e.offsetY);
      this.changed(this.rings);
    }
    this.paint();
  }

  up(): void { this.held = null; }

  key(e: KeyboardEvent): void {
    if (!this.on) return;
    if (e.key === "Enter" && this.open.length > 2) this.close();
    else if (e.key === "Backspace" && this.open.length) this.open.pop();
    else if (e.key === "Escape") { if (this.open.length) this.open = []; else { this.leave(); return; } }
    else return;
    e.preventDefault();
    this.sign();
  }

  private close(): void {
    this.rings.push(this.open);
    this.open = [];
    this.changed(this.rings);
  }

  paint(): void {
    const canvas = this.canvas, ratio = devicePixelRatio || 1, c = canvas.getContext("2d")!;
    const w = Math.round(canvas.clientWidth * ratio), h = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.clearRect(0, 0, w, h);
    if (!this.on) return;
    const accent = getComputedStyle(document.body).getPropertyValue("--accent"), at = (p: [number,
      number]) => this.view.toScreen(...p);
    c.strokeStyle = c.fillStyle = accent;
    c.lineWidth = 2;
    c.beginPath();
    for (const ring of this.rings) {
      ring.forEach((p, i) => i ? c.lineTo(...at(p)) : c.moveTo(...at(p)));
      c.closePath();
    }
    this.open.forEach((p, i) => i ? c.lineTo(...at(p)) : c.moveTo(...at(p)));
    if (this.open.length && this.mouse) c.lineTo(...this.mouse);
    c.stroke();
    for (const p of [...this.rings.flat(), ...this.open]) {
      c.beginPath();
      c.arc(...at(p), p === this.open[0] && this.open.length > 2 ? 7 : 4.5, 0, 7);
      c.fill();
    }
  }
}
