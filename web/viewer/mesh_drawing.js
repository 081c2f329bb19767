/** A mesh on a graphics processor. */
export class MeshDrawing {
  /** @param {WebGL2RenderingContext} gl @param {import("../extract/mesh.js").MeshData} mesh */
  constructor(gl, mesh) {
    this.gl = gl;
    this.groups = mesh.groups;
    /** @type {(WebGLBuffer|null)[]} */
    this.buffers = [];
    this.array = gl.createVertexArray();
    gl.bindVertexArray(this.array);
    [mesh.positions, mesh.normals, mesh.uvs, mesh.charts].forEach((values, i) => {
      this.buffer(gl.ARRAY_BUFFER, values);
      gl.enableVertexAttribArray(i);
      gl.vertexAttribPointer(i, [3, 3, 2, 1][i], gl.FLOAT, false, 0, 0);
    });
    this.triangles = this.buffer(gl.ELEMENT_ARRAY_BUFFER, mesh.indices);
    this.sides = this.buffer(gl.ELEMENT_ARRAY_BUFFER, sidesOf(mesh.indices));
    gl.bindVertexArray(null);
  }

  /** @param {number} kind @param {Float32Array|Uint32Array} values */
  buffer(kind, values) {
    const { gl } = this;
    const buffer = gl.createBuffer();
    this.buffers.push(buffer);
    gl.bindBuffer(kind, buffer);
    gl.bufferData(kind, values, gl.STATIC_DRAW);
    return buffer;
  }

  dispose() {
    this.gl.deleteVertexArray(this.array);
    for (const buffer of this.buffers) this.gl.deleteBuffer(buffer);
  }

  /**
   * @param {import("./programs.js").Program} program mesh, in use
   * @param {import("./materials.js").MaterialSet} materials
   * @param {boolean} partsAlone without the field's surface
   */
  draw(program, materials, partsAlone) {
    const { gl } = this;
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.triangles);
    const see_through = (/** @type {{material: number}} */ group) => materials.materials[group.material].alphaMode === "blend";
    for (const last of [false, true]) {
      gl.depthMask(!last);
      for (const group of this.shown(partsAlone).filter((each) => see_through(each) === last)) {
        materials.apply(program, group.material, group.textured, 0);
        gl.drawElements(gl.TRIANGLES, group.count, gl.UNSIGNED_INT, 4 * group.start);
      }
    }
    gl.depthMask(true);
    gl.bindVertexArray(null);
  }

  /** @param {boolean} partsAlone */
  shown(partsAlone) {
    return this.groups.filter(({ fitted }) => !partsAlone || !fitted);
  }

  /** @param {boolean} partsAlone */
  drawSides(partsAlone) {
    const { gl } = this;
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.sides);
    for (const { start, count } of this.shown(partsAlone)) gl.drawElements(gl.LINES, 2 * count, gl.UNSIGNED_INT, 8 * start);
    gl.bindVertexArray(null);
  }
}

/** @param {Uint32Array} indices */
function sidesOf(indices) {
  const sides = new Uint32Array(2 * indices.length);
  indices.forEach((vertex, i) => {
    sides[2 * i] = vertex;
    sides[2 * i + 1] = indices[i % 3 === 2 ? i - 2 : i + 1];
  });
  return sides;
}
