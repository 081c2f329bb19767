import { offsetsOf, Renderer } from "./renderer.js";

/**
 * samples along a pixel's side when nothing moves; milliseconds after which that is so; pixels at most;
 * milliseconds that a part of a field's picture may take; least share of its width while it moves.
 */
const PANE = Object.freeze({ samples: 3, restAfter: 200, mostPixels: 2 ** 21, slice: 60, leastScale: 0.1 });

/** A canvas with its renderer, redrawn when asked to, and refined while at rest. */
export class Pane {
  /** @param {HTMLCanvasElement} canvas @param {import("./camera.js").Camera} camera */
  constructor(canvas, camera) {
    this.canvas = canvas;
    this.camera = camera;
    this.renderer = new Renderer(canvas);
    /** @type {import("./renderer.js").Look} */
    this.look = { field: false, channel: "color", wireframe: false, slice: 0 };
    this.changedAt = -Infinity;
    this.pending = 0;
    this.moving = false;
    // Both follow from how long the last ones took.
    this.scale = 0.3;
    this.rows = 32;
    this.observer = new ResizeObserver(() => this.changed());
    this.observer.observe(canvas);
  }

  dispose() {
    this.observer.disconnect();
    cancelAnimationFrame(this.pending);
    this.renderer.dispose();
  }

  /** @param {Partial<import("./renderer.js").Look>} look */
  show(look) {
    Object.assign(this.look, look);
    this.changed();
  }

  changed() {
    this.renderer.restart();
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
    if (moving !== this.moving) this.renderer.restart();
    this.moving = moving;
    const offsets = offsetsOf(moving ? 1 : PANE.samples);
    if (this.renderer.samples < offsets.length) this.addTo(offsets[this.renderer.samples]);
    if (moving || this.renderer.samples < offsets.length) this.schedule();
  }

  /** Draws one more sample, or a part of it, in about as long as a slice. @param {number[]} offset */
  addTo(offset) {
    const { renderer, camera, look, moving } = this;
    const { width, height } = this.size(moving && look.field ? this.scale : 1);
    const started = performance.now();
    const rows = moving ? height : this.rows;
    if (renderer.addSample(camera, look, width, height, offset, rows)) renderer.present();
    else renderer.finish();
    if (!look.field) return;
    const share = Math.min(Math.max(PANE.slice / Math.max(performance.now() - started, 1), 0.25), 2);
    if (moving) this.scale = Math.min(Math.max(this.scale * Math.sqrt(share), PANE.leastScale), 1);
    else this.rows = Math.max(1, Math.round(this.rows * share));
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
