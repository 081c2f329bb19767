import { EXTRACTION } from "./config.js";
import { DisjointSets } from "./groups.js";
import { everyFew, slopesAt } from "./surface_blocks.js";

/**
 * @typedef {import("./isosurface.js").Surface} Surface
 * @typedef {import("../evaluate/network.js").NetworkEvaluator} NetworkEvaluator
 */

/**
 * The surface without components that are noise of the fitted field: outside the unit ball; small
 * where the field is steep; small, flat and alone; of a single cell; small hollows.
 * @param {NetworkEvaluator} network
 * @param {Surface} surface
 * @returns {{surface: Surface, dropped: number}}
 */
export function withoutNoise(network, surface) {
  const { labels, sizes } = componentsOf(surface);
  if (sizes.length < 2) return { surface, dropped: 0 };
  const slopes = meanSlopes(network, surface, labels, sizes);
  const nearest = nearestToCenter(surface, labels, sizes.length);
  const volumes = volumesOf(surface, labels, sizes.length);
  const smallest = (/** @type {number} */ i) => sizes[i] * surface.cell ** 2 < EXTRACTION.smallArea;
  const flat = sizes.map((_, i) => slopes[i] < EXTRACTION.flat);
  const lonely = isolated(surface, labels, flat.map((each, i) => each && smallest(i)));
  const unwanted = sizes.map(
    (size, i) =>
      nearest[i] > EXTRACTION.ball ||
      slopes[i] > EXTRACTION.steep ||
      lonely[i] ||
      (size <= EXTRACTION.singleCell && flat[i]) ||
      (size < EXTRACTION.hollowShare * labels.length && volumes[i] < 0),
  );
  const dropped = unwanted.filter(Boolean).length;
  return { surface: dropped ? kept(surface, (vertex) => !unwanted[labels[vertex]]) : surface, dropped };
}

/** @param {Surface} surface */
export function componentsOf({ positions, faces }) {
  const sets = new DisjointSets(positions.length / 3);
  for (let i = 0; i < faces.length; i += 3) {
    sets.join(faces[i], faces[i + 1]);
    sets.join(faces[i], faces[i + 2]);
  }
  return sets.labels();
}

/** The faces whose first vertex is to be kept, and their vertices. @param {Surface} surface @param {(vertex: number) => boolean} keep */
export function kept({ positions, faces, cell }, keep) {
  const numbers = new Int32Array(positions.length / 3).fill(-1);
  /** @type {number[]} */
  const places = [];
  /** @type {number[]} */
  const left = [];
  for (let i = 0; i < faces.length; i++) {
    const vertex = faces[i];
    if (!keep(faces[i - (i % 3)])) continue;
    if (numbers[vertex] < 0) {
      numbers[vertex] = places.length / 3;
      places.push(positions[3 * vertex], positions[3 * vertex + 1], positions[3 * vertex + 2]);
    }
    left.push(numbers[vertex]);
  }
  return { positions: Float32Array.from(places), faces: Int32Array.from(left), cell };
}

/** Mean slope on each small component, relative to the whole; 1 on large ones. @param {NetworkEvaluator} network @param {Surface} surface @param {Int32Array} labels @param {number[]} sizes */
function meanSlopes(network, { positions }, labels, sizes) {
  const sample = slopesAt(network, everyFew(positions, EXTRACTION.slopeSamples)).sort();
  const whole = sample[sample.length >> 1];
  const small = sizes.map((size) => size < EXTRACTION.smallShare * labels.length);
  const chosen = [...labels.keys()].filter((vertex) => small[labels[vertex]]);
  const slopes = slopesAt(network, Float32Array.from({ length: 3 * chosen.length }, (_, i) => positions[3 * chosen[Math.floor(i / 3)] + (i % 3)]));
  const sums = sizes.map(() => 0);
  chosen.forEach((vertex, i) => (sums[labels[vertex]] += slopes[i]));
  return sizes.map((size, i) => (small[i] ? sums[i] / size / whole : 1));
}

/** @param {Surface} surface @param {Int32Array} labels @param {number} count */
function nearestToCenter({ positions }, labels, count) {
  const nearest = new Array(count).fill(Infinity);
  labels.forEach((label, i) => {
    nearest[label] = Math.min(nearest[label], Math.hypot(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]));
  });
  return nearest;
}

/** What components enclose; below 0 where their outside is within (Gauss). @param {Surface} surface @param {Int32Array} labels @param {number} count */
function volumesOf({ positions, faces }, labels, count) {
  const volumes = new Array(count).fill(0);
  for (let i = 0; i < faces.length; i += 3) {
    const [a, b, c] = [3 * faces[i], 3 * faces[i + 1], 3 * faces[i + 2]];
    volumes[labels[faces[i]]] +=
      positions[a] * (positions[b + 1] * positions[c + 2] - positions[b + 2] * positions[c + 1]) +
      positions[a + 1] * (positions[b + 2] * positions[c] - positions[b] * positions[c + 2]) +
      positions[a + 2] * (positions[b] * positions[c + 1] - positions[b + 1] * positions[c]);
  }
  return volumes;
}

/** Of some components those with no vertex of another near. @param {Surface} surface @param {Int32Array} labels @param {boolean[]} some */
function isolated({ positions }, labels, some) {
  const found = some.slice();
  if (!some.includes(true)) return found;
  /** @type {Map<string, number>} */
  const owners = new Map();
  const cellOf = (/** @type {number} */ i) => [0, 1, 2].map((axis) => Math.floor(positions[3 * i + axis] / EXTRACTION.isolated));
  // -1 where several components meet.
  labels.forEach((label, i) => {
    const key = cellOf(i).join();
    owners.set(key, owners.has(key) && owners.get(key) !== label ? -1 : label);
  });
  labels.forEach((label, i) => {
    if (!found[label]) return;
    const [x, y, z] = cellOf(i);
    for (let k = 0; k < 27; k++) {
      const owner = owners.get([x + Math.floor(k / 9) - 1, y + (Math.floor(k / 3) % 3) - 1, z + (k % 3) - 1].join());
      if (owner !== undefined && owner !== label) found[label] = false;
    }
  });
  return found;
}
