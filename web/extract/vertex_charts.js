import { EXTRACTION } from "./config.js";
import { DisjointSets } from "./groups.js";

/**
 * @typedef {import("./isosurface.js").Surface} Surface
 * @typedef {import("../evaluate/network.js").NetworkEvaluator} NetworkEvaluator
 */

/**
 * The chart of each vertex (n): patches that are too small are voted away by their neighbors.
 * @param {NetworkEvaluator} network of charts
 * @param {Surface} surface
 * @returns {Int32Array}
 */
export function vertexCharts(network, surface) {
  let charts = network.classify(surface.positions);
  const least = Math.max(EXTRACTION.patchVertices, Math.round(EXTRACTION.patchArea / surface.cell ** 2));
  for (let round = 0; round < EXTRACTION.votes; round++) {
    const changed = withoutSmallPatches(charts, surface.faces, least);
    if (changed.every((chart, i) => chart === charts[i])) break;
    charts = changed;
  }
  return charts;
}

/** @param {Int32Array} charts @param {Int32Array} faces @param {number} least vertices of a patch */
function withoutSmallPatches(charts, faces, least) {
  const { labels, sizes } = patches(charts, faces);
  /** @type {Map<number, number>[]} */
  const votes = [];
  const small = (/** @type {number} */ vertex) => sizes[labels[vertex]] < least;
  forEachSide(faces, (a, b) => {
    if (charts[a] === charts[b] || !small(a) || small(b)) return;
    const ballots = (votes[labels[a]] ??= new Map());
    ballots.set(charts[b], (ballots.get(charts[b]) ?? 0) + 1);
  });
  const elected = new Map();
  votes.forEach((ballots, patch) => elected.set(patch, [...ballots].sort((x, y) => y[1] - x[1])[0][0]));
  return charts.map((chart, i) => elected.get(labels[i]) ?? chart);
}

/** Vertices of one chart that hang together. @param {Int32Array} charts @param {Int32Array} faces */
function patches(charts, faces) {
  const sets = new DisjointSets(charts.length);
  forEachSide(faces, (a, b) => {
    if (charts[a] === charts[b]) sets.join(a, b);
  });
  return sets.labels();
}

/** The sides of all triangles: an edge comes once from either side. @param {Int32Array} faces @param {(a: number, b: number) => void} use */
function forEachSide(faces, use) {
  for (let i = 0; i < faces.length; i++) use(faces[i], faces[i % 3 === 2 ? i - 2 : i + 1]);
}
