import { offsetsOf, Renderer } from "./renderer.js";

/** Samples along a pixel's side when nothing moves; pixels of a field while something does. */
const PANE = Object.freeze({ samples: 3, movingScale: 0.35, restAfter: 200, mostPixels: 2 ** 21 });

/** A canvas with its renderer, redrawn when asked to, and refined while at rest. */
export class Pane {
  /** @param {HTMLCanvasElement} canvas @param {import("./camera.js").Camera} camera */
  constructor(canvas, camera) {
    this.canvas = canvas;
    this.camera = camera;
    this.renderer = new Renderer(canvas);
    /** @type {import("./renderer.js").Look} */
    this.look = { field: false, channel: "color", wireframe: false };
    this.changedAt = -Infinity;
    this.pending = 0;
    this.moving = false;
    new ResizeObserver(() => this.changed()).observe(canvas);
  }

  /** @param {Partial<import("./renderer.js").Look>} look */
  show(look) {
    Object.assign(this.look, look);
    this.changed();
  }

  changed() {
    this.renderer.samples = 0;
    this.changedAt = performance.now();
    this.schedule();
  }

  schedule() {
    this.pending ||= requestAnimationFrame(() => {
      this.pending = 0;
      this.frame();
    });
  }

  frame() {
    if (!this.canvas.clientWidth || !this.renderer.materials) return;
    const moving = performance.now() - this.changedAt < PANE.restAfter;
    if (moving !== this.moving) this.renderer.samples = 0;
    this.moving = moving;
    const { width, height } = this.size(moving && this.look.field ? PANE.movingScale : 1);
    const offsets = offsetsOf(moving ? 1 : PANE.samples);
    if (this.renderer.samples < offsets.length) {
      this.renderer.addSample(this.camera, this.look, width, height, offsets[this.renderer.samples]);
      this.renderer.present();
    }
    if (moving || this.renderer.samples < offsets.length) this.schedule();
  }

  /** The canvas's size, and that of what is drawn for it. @param {number} scale */
  size(scale) {
    const { canvas } = this;
    const area = canvas.clientWidth * canvas.clientHeight;
    const ratio = Math.min(devicePixelRatio, Math.sqrt(PANE.mostPixels / Math.max(area, 1)));
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((side) => Math.max(1, Math.round(side * ratio)));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    return { width: Math.ceil(width * scale), height: Math.ceil(height * scale) };
  }
}
