import { networkGradient } from "../evaluate/network_gradient.js";
import { EXTRACTION } from "./config.js";

/**
 * A cube of cells: `across` blocks of 2^3 cells along an edge.
 * @typedef {{root: number, levels: number, across: number, cells: number, cell: number}} GridLayout
 * @typedef {import("../evaluate/network.js").NetworkEvaluator} NetworkEvaluator
 */

/** @param {number} resolution least number of cells along an edge @returns {GridLayout} */
export function layoutOf(resolution) {
  const wanted = Math.ceil(resolution / 2);
  const levels = Math.max(0, Math.ceil(Math.log2(wanted / EXTRACTION.root)));
  const root = Math.ceil(wanted / 2 ** levels);
  const across = root * 2 ** levels;
  return { root, levels, across, cells: 2 * across, cell: EXTRACTION.cube / across };
}

/**
 * Blocks (3 n) that may hold surface. A block is halved and kept while the field at its center is
 * no larger than it may become over half its diagonal; at the end, over half its edge: from there
 * the surface is followed.
 * @param {NetworkEvaluator} network
 * @param {GridLayout} layout
 * @returns {number[]}
 */
export function surfaceBlocks(network, { root, levels, cell }) {
  let blocks = lattice(root);
  let bound = 0;
  for (let level = levels; level >= 0; level--) {
    const size = 2 * cell * 2 ** level;
    const centers = centersOf(blocks, size);
    if (level === levels) bound = steepness(network, centers);
    const reach = (bound * size * (level ? EXTRACTION.margin * Math.sqrt(3) : 1)) / 2;
    const values = network.evaluate(centers);
    blocks = chosen(blocks, (i) => Math.abs(values[i]) <= reach);
    if (level) {
      bound = steepness(network, centersOf(blocks, size));
      blocks = halved(blocks);
    }
  }
  return blocks;
}

/** All points of a cube. @param {number} count */
function lattice(count) {
  const points = [];
  for (let x = 0; x < count; x++) {
    for (let y = 0; y < count; y++) for (let z = 0; z < count; z++) points.push(x, y, z);
  }
  return points;
}

/** @param {number[]} blocks @param {number} size */
function centersOf(blocks, size) {
  return Float32Array.from(blocks, (place) => (place + 0.5) * size - EXTRACTION.cube);
}

/** @param {number[]} blocks @param {(i: number) => boolean} keep */
function chosen(blocks, keep) {
  /** @type {number[]} */
  const kept = [];
  for (let i = 0; i < blocks.length; i += 3) if (keep(i / 3)) kept.push(blocks[i], blocks[i + 1], blocks[i + 2]);
  return kept;
}

/** @param {number[]} blocks */
function halved(blocks) {
  /** @type {number[]} */
  const parts = [];
  for (let i = 0; i < blocks.length; i += 3) {
    for (let k = 0; k < 8; k++) {
      parts.push(2 * blocks[i] + (k >> 2), 2 * blocks[i + 1] + ((k >> 1) & 1), 2 * blocks[i + 2] + (k & 1));
    }
  }
  return parts;
}

/** How steep the field is around most points. @param {NetworkEvaluator} network @param {Float32Array} points */
export function steepness(network, points) {
  const slopes = slopesAt(network, everyFew(points, EXTRACTION.slopeSamples)).sort();
  return slopes.length ? slopes[Math.ceil(0.99 * (slopes.length - 1))] : 1;
}

/** About `count` of the points (3 n), evenly. @param {Float32Array} points @param {number} count */
export function everyFew(points, count) {
  const step = 1 + Math.floor(points.length / 3 / count);
  const found = new Float32Array(3 * Math.ceil(points.length / 3 / step));
  for (let i = 0; i < found.length / 3; i++) found.set(points.subarray(3 * i * step, 3 * i * step + 3), 3 * i);
  return found;
}

/** Lengths (n) of the gradient. @param {NetworkEvaluator} network @param {Float32Array} points */
export function slopesAt(network, points) {
  const { gradients } = networkGradient(network, points);
  return Float32Array.from({ length: points.length / 3 }, (_, i) =>
    Math.hypot(gradients[3 * i], gradients[3 * i + 1], gradients[3 * i + 2]),
  );
}
