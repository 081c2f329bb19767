import { EXTRACTION } from "../extract/config.js";
import { everyFew, slopesAt } from "../extract/surface_blocks.js";

/**
 * Where rays need not ask the network. `cells` has, for each cell of a cube of `size`^3, how many
 * cells away the nearest that may hold surface is (at most 255, the largest difference of any
 * coordinate counts); 0 for those themselves. x is fastest.
 * @typedef {{size: number, cells: Uint8Array, slope: number}} Occupancy slope: how fast the field may grow
 */

/** Cells that the search starts from, and how often they are halved: 64 at the end. */
const OCCUPANCY = Object.freeze({ root: 16, halvings: 2, margin: 1.15, slopeShare: 0.99 });

/**
 * @param {import("../evaluate/network.js").NetworkEvaluator} network
 * @returns {Occupancy}
 */
export function occupancyOf(network) {
  let size = OCCUPANCY.root;
  let cells = Array.from({ length: size ** 3 }, (_, i) => i);
  let slope = 1;
  for (let level = 0; ; level++) {
    const centers = centersOf(cells, size);
    slope = slopeNear(network, centers);
    const reach = (OCCUPANCY.margin * slope * Math.sqrt(3) * EXTRACTION.cube) / size;
    const values = network.evaluate(centers);
    cells = cells.filter((_, i) => Math.abs(values[i]) <= reach && touchesBall(centers, i, size));
    if (level === OCCUPANCY.halvings) break;
    cells = cells.flatMap((cell) => halvesOf(cell, size));
    size *= 2;
  }
  slope = slopeNear(network, centersOf(cells, size));
  return { size, cells: distances(cells, size), slope };
}

/** @param {number[]} cells @param {number} size */
function centersOf(cells, size) {
  const step = (2 * EXTRACTION.cube) / size;
  const centers = new Float32Array(3 * cells.length);
  cells.forEach((cell, i) => {
    const place = [cell % size, Math.floor(cell / size) % size, Math.floor(cell / size ** 2)];
    for (let axis = 0; axis < 3; axis++) centers[3 * i + axis] = (place[axis] + 0.5) * step - EXTRACTION.cube;
  });
  return centers;
}

/** @param {import("../evaluate/network.js").NetworkEvaluator} network @param {Float32Array} points */
function slopeNear(network, points) {
  const slopes = slopesAt(network, everyFew(points, EXTRACTION.slopeSamples)).sort();
  return Math.max(slopes[Math.floor(OCCUPANCY.slopeShare * slopes.length)] ?? 1, 0.1);
}

/** @param {Float32Array} centers @param {number} i @param {number} size */
function touchesBall(centers, i, size) {
  const reach = (Math.sqrt(3) * EXTRACTION.cube) / size;
  return Math.hypot(centers[3 * i], centers[3 * i + 1], centers[3 * i + 2]) < EXTRACTION.ball + reach;
}

/** @param {number} cell @param {number} size */
function halvesOf(cell, size) {
  const [x, y, z] = [cell % size, Math.floor(cell / size) % size, Math.floor(cell / size ** 2)];
  return [0, 1, 2, 3, 4, 5, 6, 7].map(
    (k) => ((2 * z + (k >> 2)) * 2 * size + 2 * y + ((k >> 1) & 1)) * 2 * size + 2 * x + (k & 1),
  );
}

/** How far each cell is from the nearest of some (two sweeps over all neighbors). @param {number[]} cells @param {number} size */
function distances(cells, size) {
  // With a border of cells that nothing is near, so that all have neighbors.
  const wide = size + 2;
  const places = new Int32Array(size ** 3).map((_, cell) => {
    const [x, y, z] = [cell % size, Math.floor(cell / size) % size, Math.floor(cell / size ** 2)];
    return ((z + 1) * wide + y + 1) * wide + x + 1;
  });
  const away = new Uint8Array(wide ** 3).fill(255);
  for (const cell of cells) away[places[cell]] = 0;
  const before = Array.from({ length: 13 }, (_, k) => ((Math.floor(k / 9) - 1) * wide + (Math.floor(k / 3) % 3) - 1) * wide + (k % 3) - 1);
  const sweep = (/** @type {Int32Array} */ order, /** @type {number} */ sign) => {
    for (const place of order) {
      let least = away[place];
      for (const step of before) least = Math.min(least, away[place + sign * step] + 1);
      away[place] = least;
    }
  };
  sweep(places, 1);
  sweep(places.toReversed(), -1);
  return new Uint8Array(places.map((place) => away[place]));
}
