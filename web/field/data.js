import { inputCount, coordinateCount } from "../decoder/topology.js";

/** Texels in a row of the texture. */
export const DATA_WIDTH = 1024;
const HEADER = 4;

/**
 * The networks of a model as the texels of one float texture, for shader.js. Texels are RGBA float32,
 * row by row. The networks sdf, chart and uv have HEADER texels each, at the front:
 *
 *     0  first layer's texel; layers; charts; outputs
 *     1  mirror; fourier levels; conditioning (0 none, 1 scalar, 2 chart_affine); coordinates
 *     2  activation (0 sine, 1 relu); output (0 identity, 1 tanh, 2 sigmoid); embedding's texel; affine's texel
 *     3  numbers of the embedding; inputs; slope; chart of openings, -1 without (the last two alike in all)
 *
 * A layer has one texel (input groups of 4, output groups, weights' texel, 0). Its weights are for each
 * group of 4 outputs one texel of biases, and for each input one texel of 4 weights. A chart's
 * embedding takes one texel for each number; its affine map one for each coordinate, then its offset.
 *
 * At the end there is a texel for each chart, which the caller gives.
 *
 * @param {import("../decoder/document.js").Document} document
 * @param {number[][]} charts texels, of 4 numbers
 * @param {number} slope how fast the distance may grow, from occupancy.js
 * @returns {{texels: Float32Array, height: number, groups: number, at: number}} groups: of 4 in the
 *     widest layer; at: the first chart's texel
 */
export function packField({ metadata, tensors }, charts, slope) {
  const packer = new Packer();
  const opening = metadata.openings ? metadata.charts - 1 : -1;
  let widest = 1;
  for (let i = 0; i < 3 * HEADER; i++) packer.put(0, 0, 0, 0);
  ["sdf", "chart", "uv"].forEach((name, number) => {
    const spec = metadata.specs.get(name);
    const held = tensors.get(name);
    if (!spec || !held) return;
    packer.network(number * HEADER, spec, (tensor) => held.get(tensor)?.values ?? new Float32Array(0), [slope, opening]);
    widest = Math.max(widest, inputCount(spec), ...spec.hidden);
  });
  const at = packer.at;
  for (const texel of charts) packer.put(...texel);
  return { ...packer.finish(), groups: Math.ceil(widest / 4), at };
}

class Packer {
  constructor() {
    /** @type {number[]} */
    this.values = [];
  }

  get at() {
    return this.values.length / 4;
  }

  /** @param {...number} texel */
  put(...texel) {
    this.values.push(...texel);
  }

  /**
   * @param {number} header its texel
   * @param {import("../decoder/topology.js").Spec} spec
   * @param {(name: string) => Float32Array} tensor
   * @param {number[]} ends two numbers that end the header
   */
  network(header, spec, tensor, ends) {
    const conditioning = ["none", "scalar", "chart_affine"].indexOf(spec.conditioning);
    const embedding = this.at;
    for (const value of tensor("embedding")) this.put(value, 0, 0, 0);
    const affine = this.at;
    if (conditioning === 2) this.affine(spec, tensor("slopes"), tensor("offsets"));
    const layers = [...spec.hidden, spec.outputs].map((_, i) => this.weights(spec, i, tensor(`weight.${i}`), tensor(`bias.${i}`)));
    const first = this.at;
    for (const layer of layers) this.put(...layer, 0);
    this.values.splice(
      4 * header,
      4 * HEADER,
      ...[first, layers.length, spec.charts, spec.outputs],
      ...[spec.mirror, spec.levels, conditioning, coordinateCount(spec)],
      ...[spec.activation === "sine" ? 0 : 1, ["identity", "tanh", "sigmoid"].indexOf(spec.output), embedding, affine],
      ...[spec.embedding, inputCount(spec), ...ends],
    );
  }

  /** @param {import("../decoder/topology.js").Spec} spec @param {Float32Array} slopes @param {Float32Array} offsets */
  affine({ charts, outputs }, slopes, offsets) {
    const n = slopes.length / charts / outputs;
    for (let chart = 0; chart < charts; chart++) {
      for (let j = 0; j < n; j++) this.put(slopes[chart * outputs * n + j], slopes[(chart * outputs + 1) * n + j], 0, 0);
      this.put(offsets[chart * outputs], offsets[chart * outputs + 1], 0, 0);
    }
  }

  /**
   * Sine layers compute sin(pi t): w0 / pi is in their weights.
   * @param {import("../decoder/topology.js").Spec} spec @param {number} layer @param {Float32Array} weight @param {Float32Array} bias
   */
  weights(spec, layer, weight, bias) {
    const hidden = layer < spec.hidden.length;
    const scale = hidden && spec.activation === "sine" ? spec.w0 / Math.PI : 1;
    const columns = weight.length / bias.length;
    const [inputs, outputs, start] = [Math.ceil(columns / 4), Math.ceil(bias.length / 4), this.at];
    const four = (/** @type {number} */ group, /** @type {(row: number) => number} */ value) =>
      [0, 1, 2, 3].map((i) => (4 * group + i < bias.length ? scale * value(4 * group + i) : 0));
    for (let group = 0; group < outputs; group++) {
      this.put(...four(group, (row) => bias[row]));
      for (let column = 0; column < 4 * inputs; column++) {
        this.put(...four(group, (row) => (column < columns ? weight[row * columns + column] : 0)));
      }
    }
    return [inputs, outputs, start];
  }

  finish() {
    const height = Math.max(1, Math.ceil(this.at / DATA_WIDTH));
    const texels = new Float32Array(4 * DATA_WIDTH * height);
    texels.set(this.values);
    return { texels, height };
  }
}
