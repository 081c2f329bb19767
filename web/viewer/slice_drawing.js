/** Samples along a slice's side: of networks alone, and where triangles are searched, which takes longer. */
const SAMPLES = Object.freeze({ field: 192, triangles: 64 });

/** A plane through the normalized frame: across which axis, where on it, and on which side the eye is. @typedef {{axis: number, place: number, side: number}} Plane */

/** Signed distances on a plane, across the axis that the eye looks along most. */
export class SliceDrawing {
  /** @param {WebGL2RenderingContext} gl @param {import("../evaluate/model.js").NISPModel} model */
  constructor(gl, model) {
    this.gl = gl;
    this.model = model;
    this.texture = gl.createTexture();
    this.measured = "";
  }

  dispose() {
    this.gl.deleteTexture(this.texture);
  }

  /**
   * Into the target that is bound.
   * @param {import("./programs.js").Program} program slice, in use
   * @param {Plane} plane
   */
  draw(program, { axis, place }) {
    const { gl } = this;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    if (this.measured !== `${axis} ${place}`) this.measure(axis, place);
    gl.uniform1i(program.at("distances"), 0);
    gl.uniform1i(program.at("axis"), axis);
    gl.uniform1f(program.at("place"), place);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }

  /** @param {number} axis @param {number} place */
  measure(axis, place) {
    const { gl, model } = this;
    const size = model.meshes ? SAMPLES.triangles : SAMPLES.field;
    const distances = model.sdf(pointsOf(axis, place, size));
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.R32F, size, size, 0, gl.RED, gl.FLOAT, distances);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    this.measured = `${axis} ${place}`;
  }
}

/** @param {import("./camera.js").Camera} camera @param {number} place @returns {Plane} */
export function planeBefore(camera, place) {
  const backward = camera.axes().slice(6);
  const sizes = backward.map(Math.abs);
  const axis = sizes.indexOf(Math.max(...sizes));
  return { axis, place, side: Math.sign(backward[axis]) };
}

/** Points (3 size^2) of a plane, row by row. @param {number} axis @param {number} place @param {number} size */
function pointsOf(axis, place, size) {
  const points = new Float32Array(3 * size * size);
  for (let i = 0; i < size * size; i++) {
    points[3 * i + axis] = place;
    points[3 * i + ((axis + 1) % 3)] = (2 * (i % size) + 1) / size - 1;
    points[3 * i + ((axis + 2) % 3)] = (2 * Math.floor(i / size) + 1) / size - 1;
  }
  return points;
}
