import { NetworkEvaluator } from "./network.js";

/** A file's networks, to be asked at points: Float32Array (3 n) of the normalized frame. */
export class FieldQueries {
  /**
   * @param {import("../decoder/document.js").Document} document one with networks
   * @param {import("./arithmetic.js").Arithmetic} arithmetic
   */
  constructor({ metadata, tensors }, arithmetic) {
    this.metadata = metadata;
    const network = (/** @type {string} */ name) => {
      const spec = metadata.specs.get(name);
      const held = tensors.get(name);
      return spec && held ? new NetworkEvaluator(spec, held, arithmetic) : null;
    };
    this.sdfNetwork = /** @type {NetworkEvaluator} */ (network("sdf"));
    this.chartNetwork = network("chart");
    this.uvNetwork = network("uv");
  }

  get chartCount() {
    return this.metadata.charts;
  }

  /** Signed distances (n). @param {Float32Array} points */
  sdf(points) {
    return this.sdfNetwork.evaluate(points);
  }

  /** @param {Float32Array} points @param {boolean} openings whether a point may be on an opening */
  charts(points, openings) {
    if (!this.chartNetwork) return new Int32Array(points.length / 3);
    const { charts, openings: has } = this.metadata;
    return this.chartNetwork.classify(points, has && !openings ? charts - 1 : charts);
  }

  /** Texture coordinates (2 n) on charts (n); 0 on those without. @param {Float32Array} points @param {Int32Array} charts */
  uv(points, charts) {
    const { uvMap, chartHasUv } = this.metadata;
    if (!this.uvNetwork) return new Float32Array((2 * points.length) / 3);
    const found = this.uvNetwork.evaluate(points, charts);
    for (let i = 0; i < found.length; i++) {
      const scaled = found[i] * uvMap[2 + (i & 1)] + uvMap[i & 1];
      found[i] = chartHasUv[charts[i >> 1]] ? scaled : 0;
    }
    return found;
  }
}
