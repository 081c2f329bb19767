/**
 * Cutting a surface along the borders between charts, so that every triangle lies in one chart.
 *
 * Every edge whose ends lie on different charts gets one new vertex where the chart changes; both
 * triangles at the edge use it, so that the cut leaves no crack.
 */
import { POINTS } from "../evaluate/network.js";
import { EXTRACTION } from "./config.js";
import { distance } from "./isosurface.js";
import { ontoSurface } from "./newton.js";

/**
 * @typedef {import("./isosurface.js").Surface} Surface
 * @typedef {import("../evaluate/network.js").NetworkEvaluator} NetworkEvaluator
 * @typedef {{surface: Surface, charts: Int32Array}} CutSurface with the chart of each face (m)
 */

/**
 * @param {NetworkEvaluator} sdf
 * @param {NetworkEvaluator} chart
 * @param {Surface} surface
 * @param {Int32Array} charts one for each vertex
 * @returns {CutSurface}
 */
export function cutAlongSeams(sdf, chart, surface, charts) {
  const edges = crossedEdges(surface.faces, charts);
  const borders = bordersOn(chart, surface.positions, edges.ends, charts);
  const cuts = ontoSurface(sdf, borders, surface.cell / 2, 1);
  const count = surface.positions.length / 3;
  const cutter = new Cutter(joined(surface.positions, cuts), (a, b) => count + (edges.numbers.get(edgeKey(a, b)) ?? 0));
  for (let i = 0; i < surface.faces.length; i += 3) cutter.add(surface.faces.subarray(i, i + 3), charts);
  const middles = ontoSurface(sdf, Float32Array.from(cutter.middles), surface.cell / 2, 1);
  const positions = joined(cutter.positions, middles);
  return { surface: { positions, faces: Int32Array.from(cutter.faces), cell: surface.cell }, charts: Int32Array.from(cutter.charts) };
}

/** @param {Float32Array} a @param {Float32Array} b */
function joined(a, b) {
  const all = new Float32Array(a.length + b.length);
  all.set(a);
  all.set(b, a.length);
  return all;
}

/** @param {number} a @param {number} b */
function edgeKey(a, b) {
  return Math.min(a, b) * 2 ** 26 + Math.max(a, b);
}

/** Edges between charts: a number for each, and their ends. @param {Int32Array} faces @param {Int32Array} charts */
function crossedEdges(faces, charts) {
  /** @type {Map<number, number>} */
  const numbers = new Map();
  /** @type {[number, number][]} */
  const ends = [];
  for (let i = 0; i < faces.length; i++) {
    const a = faces[i];
    const b = faces[i % 3 === 2 ? i - 2 : i + 1];
    if (charts[a] === charts[b]) continue;
    const key = edgeKey(a, b);
    if (numbers.has(key)) continue;
    numbers.set(key, ends.length);
    ends.push([Math.min(a, b), Math.max(a, b)]);
  }
  return { numbers, ends };
}

/**
 * Where the chart changes along each edge (3 e), by halving. Where a vote overruled the network at
 * an end there is nothing to halve: the middle.
 * @param {NetworkEvaluator} network
 * @param {Float32Array} positions
 * @param {[number, number][]} ends
 * @param {Int32Array} charts
 */
function bordersOn(network, positions, ends, charts) {
  const first = Int32Array.from(ends, ([a]) => charts[a]);
  const second = Int32Array.from(ends, ([, b]) => charts[b]);
  const between = (/** @type {ArrayLike<number>} */ shares) =>
    Float32Array.from({ length: 3 * ends.length }, (_, i) => {
      const [a, b] = ends[Math.floor(i / 3)];
      const start = positions[3 * a + (i % 3)];
      return start + shares[Math.floor(i / 3)] * (positions[3 * b + (i % 3)] - start);
    });
  const low = new Float32Array(ends.length);
  const high = new Float32Array(ends.length).fill(1);
  const contrast = (/** @type {Float32Array} */ shares) => contrastOf(network, between(shares), first, second);
  const [atStart, atEnd] = [contrast(low), contrast(high)];
  for (let step = 0; step < EXTRACTION.bisections; step++) {
    const middle = low.map((value, i) => (value + high[i]) / 2);
    contrast(middle).forEach((value, i) => {
      if (value > 0) low[i] = middle[i];
      else high[i] = middle[i];
    });
  }
  const { clearance } = EXTRACTION;
  return between(
    low.map((value, i) => {
      const share = atStart[i] >= 0 && atEnd[i] <= 0 ? (value + high[i]) / 2 : 0.5;
      return Math.min(Math.max(share, clearance), 1 - clearance);
    }),
  );
}

/**
 * Output `first` less output `second` of each point.
 * @param {NetworkEvaluator} network @param {Float32Array} points (3 n) @param {Int32Array} first (n) @param {Int32Array} second (n)
 */
function contrastOf(network, points, first, second) {
  const found = new Float32Array(first.length);
  network.blocks(points, null, (all, at, start, count) => {
    for (let p = 0; p < count; p++) {
      found[start + p] = all[at + first[start + p] * POINTS + p] - all[at + second[start + p] * POINTS + p];
    }
  });
  return found;
}

class Cutter {
  /** @param {Float32Array} positions cuts included @param {(a: number, b: number) => number} cutOn number of an edge's cut */
  constructor(positions, cutOn) {
    this.positions = positions;
    this.cutOn = cutOn;
    /** @type {number[]} */
    this.faces = [];
    /** @type {number[]} */
    this.charts = [];
    /** @type {number[]} */
    this.middles = [];
  }

  /** @param {Int32Array} face @param {Int32Array} charts */
  add(face, charts) {
    const chart = charts[face[0]];
    if (charts[face[1]] === chart && charts[face[2]] === chart) return this.put(chart, face[0], face[1], face[2]);
    const own = Array.from(face, (vertex) => charts[vertex]);
    const crossings = [0, 1, 2].filter((i) => own[i] !== own[(i + 1) % 3]);
    if (crossings.length === 3) this.inThree(face, own);
    else {
      // The corner that is alone is between the two sides that are crossed.
      const lone = crossings[0] === 0 && crossings[1] === 2 ? 0 : crossings[1];
      const turned = [0, 1, 2].map((i) => face[(lone + i) % 3]);
      this.inTwo(turned[0], turned[1], turned[2], own[lone], own[(lone + 1) % 3]);
    }
  }

  /** @param {number} chart @param {number} a @param {number} b @param {number} c */
  put(chart, a, b, c) {
    this.faces.push(a, b, c);
    this.charts.push(chart);
  }

  /**
   * A triangle at the lone corner p, a quad at the others, divided along its shorter diagonal.
   * @param {number} p @param {number} q @param {number} r @param {number} lone @param {number} other
   */
  inTwo(p, q, r, lone, other) {
    const after = this.cutOn(p, q);
    const before = this.cutOn(r, p);
    this.put(lone, p, after, before);
    if (distance(this.positions, before, q) < distance(this.positions, after, r)) {
      this.put(other, after, q, before);
      this.put(other, before, q, r);
    } else {
      this.put(other, after, q, r);
      this.put(other, before, after, r);
    }
  }

  /** A quad at each corner, all meeting in a new vertex. @param {Int32Array} face @param {number[]} own */
  inThree(face, own) {
    const cuts = [0, 1, 2].map((i) => this.cutOn(face[i], face[(i + 1) % 3]));
    const middle = (this.positions.length + this.middles.length) / 3;
    for (let axis = 0; axis < 3; axis++) {
      this.middles.push(cuts.reduce((sum, cut) => sum + this.positions[3 * cut + axis] / 3, 0));
    }
    for (let i = 0; i < 3; i++) {
      this.put(own[i], face[i], cuts[i], middle);
      this.put(own[i], face[i], middle, cuts[(i + 2) % 3]);
    }
  }
}
