import { DATA_WIDTH, packField } from "../field/data.js";
import { occupancyOf } from "../field/occupancy.js";

/** A model's networks on a graphics processor, and the passes that draw them. */
export class FieldDrawing {
  /**
   * @param {WebGL2RenderingContext} gl
   * @param {import("../evaluate/model.js").NISPModel} model one with a field
   */
  constructor(gl, model) {
    this.gl = gl;
    this.metadata = model.metadata;
    this.occupancy = occupancyOf(/** @type {import("../evaluate/field.js").FieldQueries} */ (model.field).sdfNetwork);
    const { chartMaterials, chartHasUv } = model.metadata;
    const charts = Array.from(chartMaterials, (material, i) => [material, chartHasUv[i] ? 1 : 0, 0, 0]);
    const packed = packField(model.document, charts, this.occupancy.slope);
    this.groups = packed.groups;
    this.chartTable = packed.at;
    this.data = this.dataTexture(packed.texels, packed.height);
    this.grid = this.gridTexture();
  }

  dispose() {
    this.gl.deleteTexture(this.data);
    this.gl.deleteTexture(this.grid);
  }

  /** @param {Float32Array} texels @param {number} height */
  dataTexture(texels, height) {
    const { gl } = this;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, DATA_WIDTH, height, 0, gl.RGBA, gl.FLOAT, texels);
    this.unfiltered(gl.TEXTURE_2D);
    return texture;
  }

  gridTexture() {
    const { gl } = this;
    const { size, cells } = this.occupancy;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_3D, texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage3D(gl.TEXTURE_3D, 0, gl.R8, size, size, size, 0, gl.RED, gl.UNSIGNED_BYTE, cells);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 4);
    this.unfiltered(gl.TEXTURE_3D);
    return texture;
  }

  /** @param {number} kind */
  unfiltered(kind) {
    const { gl } = this;
    gl.texParameteri(kind, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(kind, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  }

  /** Materials, and whether with texture coordinates, that charts have. @returns {[number, boolean][]} */
  owners() {
    const { charts, chartMaterials, chartHasUv } = this.metadata;
    const keys = new Set(Array.from({ length: charts }, (_, i) => 2 * chartMaterials[i] + (chartHasUv[i] ? 1 : 0)));
    return [...keys].map((key) => [key >> 1, Boolean(key & 1)]);
  }

  /**
   * The first surface along each ray, into the target that is bound.
   * @param {import("./programs.js").Program} program trace, in use
   */
  trace(program) {
    const { gl } = this;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.data);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_3D, this.grid);
    gl.uniform1i(program.at("nispData"), 0);
    gl.uniform1i(program.at("nispOccupancy"), 1);
    gl.uniform1i(program.at("chart_table"), this.chartTable);
    gl.uniform4fv(program.at("uv_map"), this.metadata.uvMap);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }
}
