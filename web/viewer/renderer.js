import { FieldDrawing } from "./field_drawing.js";
import { MaterialSet } from "./materials.js";
import { MeshDrawing } from "./mesh_drawing.js";
import { Programs } from "./programs.js";
import { planeBefore, SliceDrawing } from "./slice_drawing.js";
import { Target } from "./targets.js";

export const CHANNELS = ["color", "normal", "uv", "chart", "distance"];

/**
 * What and how to draw.
 * @typedef {{field: boolean, channel: string, wireframe: boolean, slice: number}} Look
 * @typedef {import("./camera.js").Camera} Camera
 */

/** How much nearer than its surface a wireframe is drawn, of the depth in clip space: some drivers leave polygonOffset undone. */
const LINES_NEARER = 1e-3;

/** Draws one asset into a canvas, sample after sample: a picture gets better while nothing moves. */
export class Renderer {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    const gl = canvas.getContext("webgl2", { antialias: false, depth: false });
    if (!gl) throw new Error("WebGL 2: expected it, found a browser without");
    if (!gl.getExtension("EXT_color_buffer_float")) throw new Error("WebGL 2: expected float targets, found none");
    this.gl = gl;
    this.programs = new Programs(gl);
    this.found = new Target(gl, 4, gl.RGBA32F, false);
    this.one = new Target(gl, 1, gl.RGBA16F, true);
    this.sum = new Target(gl, 1, gl.RGBA16F, false);
    this.samples = 0;
    this.traced = 0;
    /** @type {FieldDrawing|null} */ this.field = null;
    /** @type {MeshDrawing|null} */ this.mesh = null;
    /** @type {SliceDrawing|null} */ this.slice = null;
    /** @type {MaterialSet|null} */ this.materials = null;
  }

  /** @param {import("../decoder/metadata.js").Material[]} materials @param {(ImageBitmap|null)[]} images */
  setMaterials(materials, images) {
    for (const old of [this.materials, this.field, this.mesh, this.slice]) old?.dispose();
    this.materials = new MaterialSet(this.gl, materials, images);
    this.field = this.mesh = this.slice = null;
  }

  /** Gives back all that the graphics processor holds. */
  dispose() {
    this.gl.getExtension("WEBGL_lose_context")?.loseContext();
  }

  /** @param {import("../evaluate/model.js").NISPModel} model */
  setField(model) {
    this.field = new FieldDrawing(this.gl, model);
  }

  /** @param {import("../evaluate/model.js").NISPModel} model */
  setSlice(model) {
    this.slice = new SliceDrawing(this.gl, model);
  }

  /** @param {import("../extract/mesh.js").MeshData} mesh */
  setMesh(mesh) {
    this.mesh?.dispose();
    this.mesh = new MeshDrawing(this.gl, mesh);
  }

  /** Begins a new picture. */
  restart() {
    this.samples = this.traced = 0;
  }

  /**
   * Adds one sample of the picture to those so far. Rays of a field are traced so many rows at a time,
   * as a graphics processor that is kept busy for long is taken away: to be called again until it is true.
   * @param {Camera} camera @param {Look} look @param {number} width @param {number} height
   * @param {number[]} offset of the sample in its pixel, from -0.5 to 0.5
   * @param {number} [rows]
   * @returns {boolean} whether the sample is there
   */
  addSample(camera, look, width, height, offset, rows = height) {
    const { gl } = this;
    const jitter = [(2 * offset[0]) / width, (2 * offset[1]) / height];
    const sliced = this.slice !== null && look.channel === "distance";
    const traced = look.field && this.field !== null && !sliced;
    if (traced) {
      this.traceField(camera, width, height, jitter, rows);
      if (this.traced < height) return false;
      this.traced = 0;
    }
    this.one.bind(width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.enable(gl.DEPTH_TEST);
    if (traced) this.shadeField(camera, look, width, height, jitter);
    // In the field's view, what the file holds as triangles stands beside it.
    if (this.mesh) this.drawMesh(camera, look, width, height, jitter, traced);
    if (sliced) this.drawSlice(camera, look, width, height, jitter);
    gl.disable(gl.DEPTH_TEST);
    this.accumulate(width, height);
    return true;
  }

  /** @param {Camera} camera @param {number} width @param {number} height @param {number[]} jitter @param {number} rows */
  traceField(camera, width, height, jitter, rows) {
    const { gl } = this;
    const field = /** @type {FieldDrawing} */ (this.field);
    this.found.bind(width, height);
    gl.disable(gl.BLEND);
    const program = this.programs.trace(field.groups);
    this.rays(program, camera, width, height, jitter);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(0, this.traced, width, rows);
    field.trace(program);
    gl.disable(gl.SCISSOR_TEST);
    this.traced += rows;
  }

  /** Waits until all is drawn. */
  finish() {
    this.gl.readPixels(0, 0, 1, 1, this.gl.RGBA, this.gl.FLOAT, new Float32Array(4));
  }

  /** @param {import("./programs.js").Program} program @param {Camera} camera @param {number} width @param {number} height @param {number[]} jitter */
  rays(program, camera, width, height, jitter) {
    const { gl } = this;
    gl.uniform3fv(program.at("eye"), camera.eye());
    gl.uniformMatrix3fv(program.at("axes"), false, camera.axes());
    gl.uniform2fv(program.at("half_size"), camera.halfSize(width, height));
    gl.uniform2fv(program.at("jitter"), jitter);
  }

  /** @param {Camera} camera @param {Look} look @param {number} width @param {number} height @param {number[]} jitter */
  shadeField(camera, look, width, height, jitter) {
    const { gl } = this;
    const program = this.programs.shadeField();
    this.rays(program, camera, width, height, jitter);
    this.light(program, camera, look);
    gl.uniformMatrix4fv(program.at("projection"), false, camera.projection(width, height, jitter));
    gl.uniform1f(program.at("width"), (2 * camera.halfSize(width, height)[0]) / width);
    ["hits", "normals", "uvs", "slopes"].forEach((name, i) => {
      gl.activeTexture(gl.TEXTURE0 + i);
      gl.bindTexture(gl.TEXTURE_2D, this.found.textures[i]);
      gl.uniform1i(program.at(name), i);
    });
    for (const [material, textured] of /** @type {FieldDrawing} */ (this.field).owners()) {
      gl.uniform2f(program.at("owner"), material, textured ? 1 : 0);
      /** @type {MaterialSet} */ (this.materials).apply(program, material, textured, 4);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }
  }

  /** @param {import("./programs.js").Program} program @param {Camera} camera @param {Look} look */
  light(program, camera, look) {
    this.gl.uniform3fv(program.at("lamp"), camera.lamp());
    this.gl.uniform1i(program.at("channel"), CHANNELS.indexOf(look.channel));
  }

  /**
   * @param {Camera} camera @param {Look} look @param {number} width @param {number} height @param {number[]} jitter
   * @param {boolean} partsAlone without the field's surface
   */
  drawMesh(camera, look, width, height, jitter, partsAlone) {
    const { gl } = this;
    const mesh = /** @type {MeshDrawing} */ (this.mesh);
    const projection = camera.projection(width, height, jitter);
    const program = this.programs.mesh();
    gl.uniformMatrix4fv(program.at("projection"), false, projection);
    gl.uniform3fv(program.at("eye"), camera.eye());
    this.light(program, camera, look);
    this.cut(program, camera, look);
    mesh.draw(program, /** @type {MaterialSet} */ (this.materials), partsAlone);
    if (look.wireframe) {
      const nearer = projection.map((value, i) => (i % 4 === 2 ? value - LINES_NEARER * projection[i + 1] : value));
      const lines = this.programs.lines();
      gl.uniformMatrix4fv(lines.at("projection"), false, nearer);
      this.cut(lines, camera, look);
      mesh.drawSides(partsAlone);
    }
  }

  /** What lies before a slice is left out. @param {import("./programs.js").Program} program @param {Camera} camera @param {Look} look */
  cut(program, camera, look) {
    const { axis, place, side } = planeBefore(camera, look.slice);
    const normal = [0, 1, 2].map((i) => (i === axis ? side : 0));
    const cut = this.slice && look.channel === "distance" ? [...normal, side * place] : [0, 0, 0, 1];
    this.gl.uniform4fv(program.at("cut"), cut);
  }

  /** @param {Camera} camera @param {Look} look @param {number} width @param {number} height @param {number[]} jitter */
  drawSlice(camera, look, width, height, jitter) {
    const program = this.programs.slice();
    this.gl.uniformMatrix4fv(program.at("projection"), false, camera.projection(width, height, jitter));
    /** @type {SliceDrawing} */ (this.slice).draw(program, planeBefore(camera, look.slice));
  }

  /** @param {number} width @param {number} height */
  accumulate(width, height) {
    const { gl } = this;
    this.sum.bind(width, height);
    if (this.samples++ === 0) gl.clear(gl.COLOR_BUFFER_BIT);
    gl.blendFunc(gl.ONE, gl.ONE);
    const program = this.programs.add();
    this.picture(program, this.one);
    gl.disable(gl.BLEND);
  }

  /** @param {import("./programs.js").Program} program @param {Target} target */
  picture(program, target) {
    const { gl } = this;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, target.textures[0]);
    gl.uniform1i(program.at("picture"), 0);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  /** Shows the mean of the samples in the canvas. */
  present() {
    const { gl, canvas } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, canvas.width, canvas.height);
    this.resolve(true);
  }

  /** @param {boolean} premultiplied */
  resolve(premultiplied) {
    const { gl } = this;
    gl.disable(gl.BLEND);
    const program = this.programs.present();
    gl.uniform1f(program.at("samples"), this.samples);
    gl.uniform1i(program.at("premultiplied"), premultiplied ? 1 : 0);
    this.picture(program, this.sum);
  }

  /**
   * A finished picture: RGBA, sRGB-encoded, straight alpha, top row first.
   * @param {Camera} camera @param {Look} look @param {number} size @param {number} across samples along a pixel's side
   * @returns {Uint8Array}
   */
  render(camera, look, size, across) {
    const { gl } = this;
    this.restart();
    for (const offset of offsetsOf(across)) this.addSample(camera, look, size, size, offset);
    const target = new Target(gl, 1, gl.RGBA8, false);
    target.bind(size, size);
    this.resolve(false);
    const pixels = new Uint8Array(4 * size * size);
    gl.readPixels(0, 0, size, size, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    target.dispose();
    this.restart();
    const row = 4 * size;
    return Uint8Array.from(pixels, (_, i) => pixels[(size - 1 - Math.floor(i / row)) * row + (i % row)]);
  }
}

/** Places of samples in a pixel, on a grid. @param {number} across @returns {number[][]} */
export function offsetsOf(across) {
  return Array.from({ length: across * across }, (_, i) =>
    [i % across, Math.floor(i / across)].map((place) => (place + 0.5) / across - 0.5),
  );
}
