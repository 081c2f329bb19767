import { Arithmetic } from "./arithmetic.js";
import { FieldQueries } from "./field.js";
import { MeshQueries } from "./meshes.js";
import { baseColor, lookUp } from "./texture.js";

/**
 * A file's parts as one, ready to be asked: the field, its meshes, or both. Points are Float32Array
 * (3 n) of the normalized frame, or what `normalized` makes of world points. Charts are numbered
 * through: those of the field, then those of each copy of each mesh.
 */
export class NISPModel {
  /**
   * @param {import("../decoder/document.js").Document} document
   * @param {Arithmetic} [arithmetic]
   */
  constructor(document, arithmetic = new Arithmetic()) {
    this.document = document;
    this.metadata = document.metadata;
    this.arithmetic = arithmetic;
    this.field = document.metadata.specs.size ? new FieldQueries(document, arithmetic) : null;
    /** @type {MeshQueries|null} */
    this.meshQueries = null;
  }

  /** The mesh parts, made ready when they are first asked. */
  get meshes() {
    if (this.document.parts.length) this.meshQueries ??= new MeshQueries(this.document.parts);
    return this.meshQueries;
  }

  /** World points (3 n) in the normalized frame. @param {ArrayLike<number>} points */
  normalized(points) {
    const { frame } = this.metadata;
    return Float32Array.from(points, (value, i) => (value - frame[i % 3]) / frame[3]);
  }

  /** Normalized points (3 n) in the world. @param {ArrayLike<number>} points @returns {Float64Array} */
  world(points) {
    const { frame } = this.metadata;
    return Float64Array.from(points, (value, i) => value * frame[3] + frame[i % 3]);
  }

  /** Signed distances (n), normalized frame: the least of all parts. @param {Float32Array} points */
  sdf(points) {
    const { field, meshes } = this;
    const found = (field ?? /** @type {MeshQueries} */ (meshes)).sdf(points);
    if (!field || !meshes) return found;
    meshes.sdf(points).forEach((value, i) => (found[i] = Math.min(found[i], value)));
    return found;
  }

  /** The charts (n) of the nearest parts. @param {Float32Array} points @param {boolean} [openings] whether a point may be on an opening */
  charts(points, openings = true) {
    const { field, meshes } = this;
    if (!meshes) return /** @type {FieldQueries} */ (field).charts(points, openings);
    const found = meshes.charts(points);
    if (!field) return found;
    const own = field.charts(points, openings);
    const [one, other] = [field.sdf(points), meshes.sdf(points)];
    return found.map((chart, i) => (Math.abs(other[i]) < Math.abs(one[i]) ? field.chartCount + chart : own[i]));
  }

  /**
   * Texture coordinates (2 n), origin bottom-left; 0 on charts without.
   * @param {Float32Array} points @param {Int32Array} [charts] (n) in place of those that are found
   */
  uv(points, charts = this.charts(points)) {
    const { field, meshes } = this;
    if (!field || !meshes) return (field ?? /** @type {MeshQueries} */ (meshes)).uv(points, charts);
    const found = new Float32Array(2 * charts.length);
    const first = field.chartCount;
    const ask = (/** @type {FieldQueries|MeshQueries} */ part, /** @type {number} */ start, /** @type {(chart: number) => boolean} */ has) => {
      const own = Int32Array.from(charts.keys()).filter((i) => has(charts[i]));
      const places = new Float32Array(3 * own.length);
      own.forEach((i, at) => places.set(points.subarray(3 * i, 3 * i + 3), 3 * at));
      const uvs = part.uv(places, own.map((i) => charts[i] - start));
      own.forEach((i, at) => found.set(uvs.subarray(2 * at, 2 * at + 2), 2 * i));
    };
    ask(field, 0, (chart) => chart < first);
    ask(meshes, first, (chart) => chart >= first);
    return found;
  }

  /**
   * Colors (4 n): RGBA in [0, 1], sRGB-encoded.
   * @param {Float32Array} points
   * @param {(import("./texture.js").Pixels|null)[]} images decoded, by number of the texture
   */
  color(points, images) {
    const charts = this.charts(points, false);
    const uvs = this.uv(points, charts);
    const colors = new Float32Array(4 * charts.length);
    charts.forEach((chart, i) => colors.set(this.#colorAt(chart, uvs[2 * i], uvs[2 * i + 1], images), 4 * i));
    return colors;
  }

  /** @param {number} chart @param {number} u @param {number} v @param {(import("./texture.js").Pixels|null)[]} images */
  #colorAt(chart, u, v, images) {
    const { chartMaterials, chartHasUv } = this.document;
    const material = this.metadata.materials[chartMaterials[chart]];
    const use = chartHasUv[chart] ? material.maps.base_color : undefined;
    const image = use ? images[use.texture] : null;
    return baseColor(material.baseColor, use && image ? lookUp(image, u, v, use) : null);
  }
}
