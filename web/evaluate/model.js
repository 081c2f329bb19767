import { Arithmetic } from "./arithmetic.js";
import { NetworkEvaluator } from "./network.js";
import { baseColor, lookUp } from "./texture.js";

/**
 * A file's networks, ready to be asked. Points are Float32Array (3 n) of the normalized frame, or
 * what `normalized` makes of world points.
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
    const network = (/** @type {string} */ name) => {
      const spec = document.metadata.specs.get(name);
      const tensors = document.tensors.get(name);
      return spec && tensors ? new NetworkEvaluator(spec, tensors, arithmetic) : null;
    };
    this.sdfNetwork = /** @type {NetworkEvaluator} */ (network("sdf"));
    this.chartNetwork = network("chart");
    this.uvNetwork = network("uv");
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

  /** Signed distances (n), normalized frame. @param {Float32Array} points */
  sdf(points) {
    return this.sdfNetwork.evaluate(points);
  }

  /** Signed distances and their gradients. @param {Float32Array} points */
  gradient(points) {
    return this.sdfNetwork.gradient(points);
  }

  /** @param {Float32Array} points @param {boolean} [openings] whether a point may be on an opening */
  charts(points, openings = true) {
    if (!this.chartNetwork) return new Int32Array(points.length / 3);
    const { charts, openings: has } = this.metadata;
    return this.chartNetwork.classify(points, has && !openings ? charts - 1 : charts);
  }

  /**
   * Texture coordinates (2 n), origin bottom-left; 0 on charts without.
   * @param {Float32Array} points @param {Int32Array} [charts] (n) in place of those that are found
   */
  uv(points, charts = this.charts(points)) {
    const { uvMap, chartHasUv } = this.metadata;
    if (!this.uvNetwork) return new Float32Array((2 * points.length) / 3);
    const found = this.uvNetwork.evaluate(points, charts);
    for (let i = 0; i < found.length; i++) {
      const scaled = found[i] * uvMap[2 + (i & 1)] + uvMap[i & 1];
      found[i] = chartHasUv[charts[i >> 1]] ? scaled : 0;
    }
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
    charts.forEach((chart, i) => colors.set(this.colorAt(chart, uvs[2 * i], uvs[2 * i + 1], images), 4 * i));
    return colors;
  }

  /** @param {number} chart @param {number} u @param {number} v @param {(import("./texture.js").Pixels|null)[]} images */
  colorAt(chart, u, v, images) {
    const material = this.metadata.materials[this.metadata.chartMaterials[chart]];
    const use = this.metadata.chartHasUv[chart] ? material.maps.base_color : undefined;
    const image = use ? images[use.texture] : null;
    return baseColor(material.baseColor, use && image ? lookUp(image, u, v, use) : null);
  }
}
