import { POINTS } from "./network.js";

/** @typedef {import("./network.js").NetworkEvaluator} NetworkEvaluator */

/** @type {WeakMap<NetworkEvaluator, NetworkGradient>} */
const KNOWN = new WeakMap();

/**
 * Values and gradients of a network with one output and no conditioning.
 * @param {NetworkEvaluator} network
 * @param {Float32Array} points (3 n)
 * @returns {{values: Float32Array, gradients: Float32Array}} (n), (3 n)
 */
export function networkGradient(network, points) {
  let found = KNOWN.get(network);
  if (!found) KNOWN.set(network, (found = new NetworkGradient(network)));
  return found.at(points);
}

/** What the gradient takes besides the network: transposed weights, and slopes of the layers. */
class NetworkGradient {
  /** @param {NetworkEvaluator} network */
  constructor(network) {
    const { arithmetic, layers, spec, inputs } = network;
    this.network = network;
    this.turned = layers.map(({ weight, rows, columns }) =>
      network.matrix(columns, rows, (i, j) => arithmetic.all[(weight >> 2) + j * columns + i]),
    );
    this.slopes = layers.slice(0, -1).map(({ rows }) => arithmetic.reserve((rows + 1) * POINTS));
    /** Address of zeros in place of biases. */
    this.zeros = arithmetic.reserve(Math.max(inputs, ...spec.hidden) + 1);
    this.inputSlopes = 0;
  }

  /** @param {Float32Array} points */
  at(points) {
    const { network } = this;
    const total = points.length / 3;
    const values = new Float32Array(total);
    const gradients = new Float32Array(3 * total);
    for (let start = 0; start < total; start += POINTS) {
      const count = Math.min(POINTS, total - start);
      network.enter(points, null, start, count);
      const at = network.forward(this.slopes) >> 2;
      network.finish(at);
      values.set(network.arithmetic.all.subarray(at, at + count), start);
      this.backward(at);
      this.leave(points, start, count, gradients);
    }
    return { values, gradients };
  }

  /** From the finished output at `at` to the slopes of the inputs. @param {number} at */
  backward(at) {
    const { arithmetic, layers, buffers } = this.network;
    const last = layers.length - 1;
    let x = this.outputSlopes(at);
    for (let i = last; i >= 0; i--) {
      const { rows, columns } = layers[i];
      if (i < last) arithmetic.kernel.multiply(x, this.slopes[i], rows * POINTS);
      const y = x === buffers[0] ? buffers[1] : buffers[0];
      arithmetic.kernel.linear(this.turned[i], this.zeros, x, y, columns, rows, POINTS);
      x = y;
    }
    this.inputSlopes = x >> 2;
  }

  /** @param {number} at */
  outputSlopes(at) {
    const { arithmetic, spec } = this.network;
    const { all } = arithmetic;
    for (let i = at; i < at + POINTS; i++) {
      const value = all[i];
      all[i] = spec.output === "identity" ? 1 : spec.output === "tanh" ? 1 - value * value : value * (1 - value);
    }
    return 4 * at;
  }

  /** Slopes of the inputs as gradients of the points. @param {Float32Array} points @param {number} start @param {number} count @param {Float32Array} gradients */
  leave(points, start, count, gradients) {
    this.network.sources().forEach(({ axis, absolute }, row) => {
      for (let p = 0; p < count; p++) {
        const at = 3 * (start + p) + axis;
        gradients[at] += this.coordinateSlope(row, p) * (absolute ? Math.sign(points[at]) : 1);
      }
    });
  }

  /** @param {number} row @param {number} p */
  coordinateSlope(row, p) {
    const { arithmetic, spec, input } = this.network;
    const { all } = arithmetic;
    const slopes = this.inputSlopes;
    if (spec.encoding !== "fourier") return all[slopes + row * POINTS + p];
    let sum = 0;
    for (let level = 0; level < spec.levels; level++) {
      const place = 2 * (row * spec.levels + level) * POINTS + p;
      const [sine, cosine] = [all[(input >> 2) + place], all[(input >> 2) + place + POINTS]];
      sum += 2 ** level * Math.PI * (cosine * all[slopes + place] - sine * all[slopes + place + POINTS]);
    }
    return sum;
  }
}
