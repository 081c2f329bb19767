import { coordinateCount, inputCount } from "../decoder/topology.js";

/** Points of a block: two layers' activations of it stay in a core's fastest cache. */
export const POINTS = 64;

/** @typedef {{weight: number, bias: number, rows: number, columns: number}} Layer addresses */

/** A network ready to be evaluated at many points of the normalized frame. */
export class NetworkEvaluator {
  /**
   * @param {import("../decoder/topology.js").Spec} spec
   * @param {import("../decoder/weights.js").Tensors} tensors
   * @param {import("./arithmetic.js").Arithmetic} arithmetic
   */
  constructor(spec, tensors, arithmetic) {
    this.spec = spec;
    this.arithmetic = arithmetic;
    this.coordinates = coordinateCount(spec);
    this.inputs = inputCount(spec);
    this.affine = spec.conditioning === "chart_affine";
    const values = (/** @type {string} */ name) => tensors.get(name)?.values ?? new Float32Array(0);
    this.embedding = values("embedding");
    this.slopes = values("slopes");
    this.offsets = values("offsets");
    const widest = Math.max(this.inputs, spec.outputs, ...spec.hidden) + 1;
    this.input = arithmetic.reserve(this.inputs * POINTS);
    this.buffers = [arithmetic.reserve(widest * POINTS), arithmetic.reserve(widest * POINTS)];
    this.layers = [...spec.hidden, spec.outputs].map((_, i) =>
      this.#layer(values(`weight.${i}`), values(`bias.${i}`), i < spec.hidden.length),
    );
  }

  /**
   * Sine layers compute sin(pi t): w0 / pi is in their weights.
   * @param {Float32Array} weight @param {Float32Array} bias @param {boolean} hidden
   * @returns {Layer}
   */
  #layer(weight, bias, hidden) {
    const scale = hidden && this.spec.activation === "sine" ? this.spec.w0 / Math.PI : 1;
    const rows = bias.length;
    const columns = weight.length / rows;
    return {
      weight: this.matrix(rows, columns, (i, j) => scale * weight[i * columns + j]),
      bias: this.matrix(rows, 1, (i) => scale * bias[i]),
      rows,
      columns,
    };
  }

  /** Stores a matrix, with an even number of rows. @param {number} rows @param {number} columns @param {(i: number, j: number) => number} value */
  matrix(rows, columns, value) {
    const at = this.arithmetic.reserve((rows + (rows & 1)) * columns);
    const all = this.arithmetic.all;
    for (let i = 0, k = at >> 2; i < rows; i++) {
      for (let j = 0; j < columns; j++) all[k++] = value(i, j);
    }
    return at;
  }

  /**
   * Calls `use` for each block of points with what the network gives: where its outputs are in the
   * memory, a row of POINTS floats for each.
   * @param {Float32Array} points (3 n)
   * @param {Int32Array|null} charts (n), wanted by networks that are conditioned
   * @param {(all: Float32Array, at: number, start: number, count: number) => void} use
   */
  blocks(points, charts, use) {
    const total = points.length / 3;
    for (let start = 0; start < total; start += POINTS) {
      const count = Math.min(POINTS, total - start);
      this.enter(points, charts, start, count);
      const at = this.forward() >> 2;
      if (this.affine && charts) this.#addAffine(points, charts, start, count, at);
      this.finish(at);
      use(this.arithmetic.all, at, start, count);
    }
  }

  /**
   * Outputs, point after point.
   * @param {Float32Array} points (3 n) @param {Int32Array|null} [charts] (n)
   * @returns {Float32Array} (outputs n)
   */
  evaluate(points, charts = null) {
    const { outputs } = this.spec;
    const found = new Float32Array((points.length / 3) * outputs);
    this.blocks(points, charts, (all, at, start, count) => {
      for (let row = 0; row < outputs; row++) {
        for (let p = 0; p < count; p++) found[(start + p) * outputs + row] = all[at + row * POINTS + p];
      }
    });
    return found;
  }

  /**
   * Number of the largest of the first `among` outputs at each point, 0 where one is NaN.
   * @param {Float32Array} points (3 n) @param {number} [among]
   * @returns {Int32Array} (n)
   */
  classify(points, among = this.spec.outputs) {
    const found = new Int32Array(points.length / 3);
    this.blocks(points, null, (all, at, start, count) => {
      for (let p = 0; p < count; p++) {
        let best = 0;
        for (let row = 0; row < among; row++) {
          const logit = all[at + row * POINTS + p];
          if (Number.isNaN(logit)) {
            best = 0;
            break;
          }
          if (logit > all[at + best * POINTS + p]) best = row;
        }
        found[start + p] = best;
      }
    });
    return found;
  }

  /** Inputs of a block of points. @param {Float32Array} points @param {Int32Array|null} charts @param {number} start @param {number} count */
  enter(points, charts, start, count) {
    const { all } = this.arithmetic;
    const { spec } = this;
    if (spec.conditioning !== "none" && !charts) throw new Error("charts: expected one for each point, found none");
    const at = this.input >> 2;
    this.sources().forEach(({ axis, absolute }, row) => {
      for (let p = 0; p < count; p++) {
        const value = points[3 * (start + p) + axis];
        all[at + row * POINTS + p] = absolute ? Math.abs(value) : value;
      }
    });
    if (!charts) return this.#encode();
    if (spec.conditioning === "scalar") {
      const row = at + (this.coordinates - 1) * POINTS;
      for (let p = 0; p < count; p++) all[row + p] = (2 * charts[start + p] + 1) / spec.charts - 1;
    }
    this.#encode();
    const first = at + (this.inputs - spec.embedding) * POINTS;
    for (let k = 0; k < spec.embedding; k++) {
      for (let p = 0; p < count; p++) {
        all[first + k * POINTS + p] = this.embedding[charts[start + p] * spec.embedding + k];
      }
    }
  }

  /** Which axis each coordinate is of, and whether its absolute value enters. */
  sources() {
    const has = (/** @type {number} */ bit) => Boolean((this.spec.mirror >> bit) & 1);
    const bits = [0, 1, 2, 3, 4, 5].filter((bit) => bit < 3 || has(bit));
    return bits.map((bit) => ({ axis: bit % 3, absolute: bit < 3 && has(bit) }));
  }

  /** The coordinates' waves in their place, from the last coordinate to the first. */
  #encode() {
    if (this.spec.encoding !== "fourier") return;
    const { all } = this.arithmetic;
    const at = this.input >> 2;
    const { levels } = this.spec;
    for (let row = this.coordinates - 1; row >= 0; row--) {
      const values = all.slice(at + row * POINTS, at + (row + 1) * POINTS);
      for (let level = 0; level < levels; level++) {
        const wave = Math.fround(2 ** level * Math.PI);
        const place = at + 2 * (row * levels + level) * POINTS;
        for (let p = 0; p < POINTS; p++) {
          all[place + p] = Math.sin(wave * values[p]);
          all[place + POINTS + p] = Math.cos(wave * values[p]);
        }
      }
    }
  }

  /** Address of the last layer's sums. @param {number[]} [slopes] where to put those of the hidden layers */
  forward(slopes = []) {
    const { kernel } = this.arithmetic;
    let x = this.input;
    this.layers.forEach(({ weight, bias, rows, columns }, i) => {
      const y = this.buffers[i & 1];
      kernel.linear(weight, bias, x, y, rows, columns, POINTS);
      const hidden = i + 1 < this.layers.length;
      if (hidden && this.spec.activation === "sine") kernel.sine(y, slopes[i] ?? 0, rows * POINTS);
      else if (hidden) this.#rectify(y >> 2, slopes[i] >> 2, rows * POINTS);
      x = y;
    });
    return x;
  }

  /** @param {number} y @param {number} d @param {number} count */
  #rectify(y, d, count) {
    const { all } = this.arithmetic;
    for (let i = 0; i < count; i++) {
      const positive = all[y + i] > 0;
      if (d) all[d + i] = positive ? 1 : 0;
      // NaN stays NaN.
      if (all[y + i] <= 0) all[y + i] = 0;
    }
  }

  /** The output's activation. @param {number} at */
  finish(at) {
    const { output, outputs } = this.spec;
    if (output === "identity") return;
    const { all } = this.arithmetic;
    for (let i = at; i < at + outputs * POINTS; i++) {
      all[i] = output === "tanh" ? Math.tanh(all[i]) : 0.5 + 0.5 * Math.tanh(all[i] / 2);
    }
  }

  /** @param {Float32Array} points @param {Int32Array} charts @param {number} start @param {number} count @param {number} at */
  #addAffine(points, charts, start, count, at) {
    const { all } = this.arithmetic;
    const { outputs } = this.spec;
    const sources = this.sources();
    const n = sources.length;
    for (let p = 0; p < count; p++) {
      const chart = charts[start + p];
      for (let i = 0; i < outputs; i++) {
        let sum = this.offsets[chart * outputs + i];
        for (let j = 0; j < n; j++) {
          const value = points[3 * (start + p) + sources[j].axis];
          sum += this.slopes[(chart * outputs + i) * n + j] * (sources[j].absolute ? Math.abs(value) : value);
        }
        all[at + i * POINTS + p] += sum;
      }
    }
  }
}
