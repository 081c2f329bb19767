import { networkGradient } from "../evaluate/network_gradient.js";

/**
 * Points (3 n) after Newton steps towards the zero set, along the gradient at their start. A step
 * is taken only where it brings the field nearer to 0, and none leaves `most` along an axis.
 * @param {import("../evaluate/network.js").NetworkEvaluator} network
 * @param {Float32Array} points
 * @param {number} most
 * @param {number} steps
 * @returns {Float32Array}
 */
export function ontoSurface(network, points, most, steps) {
  const { values, gradients } = networkGradient(network, points);
  const moved = points.slice();
  const trial = new Float32Array(points.length);
  for (let step = 0; step < steps; step++) {
    for (let at = 0; at < points.length; at += 3) {
      const steepness = gradients[at] ** 2 + gradients[at + 1] ** 2 + gradients[at + 2] ** 2;
      const share = values[at / 3] / Math.max(steepness, 1e-6);
      for (let i = at; i < at + 3; i++) {
        trial[i] = Math.min(Math.max(moved[i] - share * gradients[i], points[i] - most), points[i] + most);
      }
    }
    const found = network.evaluate(trial);
    for (let i = 0; i < values.length; i++) {
      if (!(Math.abs(found[i]) < Math.abs(values[i]))) continue;
      values[i] = found[i];
      moved.set(trial.subarray(3 * i, 3 * i + 3), 3 * i);
    }
  }
  return moved;
}
