import { sideAfter } from "./integers.js";

/** Faces around a node that tell where it is, at most. */
const MOST_HINGES = 16;

/**
 * A node whose value comes next, and what is known around it (section 15.3 of the specification).
 * @typedef {object} Visit
 * @property {number} node
 * @property {number[][]} hinges known ends a and b of an edge, and the node c beyond it or -1
 * @property {number} near a known node where there is no hinge, or -1
 */

/**
 * Goes over all nodes; what one is must be known before the next is asked for.
 * @param {Int32Array} corners nodes (3 m)
 * @param {Int32Array} twin (3 m) the side that each meets, or -1
 * @param {number} count of nodes
 * @returns {Generator<Visit>}
 */
export function* visitsOf(corners, twin, count) {
  const known = new Uint8Array(count);
  const ready = new Uint8Array(count);
  const full = new Uint8Array(corners.length / 3);
  const { first, list } = cornersOf(corners, count);
  /** @type {number[][]} */
  const buckets = [[], [], [], []];
  for (const begin of corners) {
    buckets[0].push(begin);
    for (let node; (node = next(buckets)) >= 0; ) {
      if (known[node]) continue;
      const around = list.subarray(first[node], first[node + 1]);
      yield hingesOf(node, around, corners, twin, known);
      known[node] = 1;
      for (const corner of around) {
        const face = Math.floor(corner / 3);
        if (++full[face] !== 2) continue;
        for (let at = 3 * face; at < 3 * face + 3; at++) {
          const other = corners[at];
          if (known[other]) continue;
          ready[other] = Math.min(ready[other] + 1, 3);
          buckets[ready[other]].push(other);
        }
      }
    }
  }
}

/** The corners of each node, one after the other. @param {Int32Array} corners @param {number} count */
function cornersOf(corners, count) {
  const first = new Int32Array(count + 1);
  for (const node of corners) first[node + 1]++;
  for (let node = 0; node < count; node++) first[node + 1] += first[node];
  const end = first.slice();
  const list = new Int32Array(corners.length);
  corners.forEach((node, corner) => (list[end[node]++] = corner));
  return { first, list };
}

/** @param {number[][]} buckets */
function next(buckets) {
  for (let i = 3; i >= 0; i--) if (buckets[i].length) return /** @type {number} */ (buckets[i].pop());
  return -1;
}

/**
 * @param {number} node @param {Int32Array} around @param {Int32Array} corners @param {Int32Array} twin @param {Uint8Array} known
 * @returns {Visit}
 */
function hingesOf(node, around, corners, twin, known) {
  const hinges = [];
  let near = -1;
  for (const corner of around) {
    const [a, b] = [corners[sideAfter(corner)], corners[sideAfter(corner, 2)]];
    if (known[a] && known[b]) {
      if (hinges.length === MOST_HINGES) break;
      const other = twin[sideAfter(corner)];
      const c = other < 0 ? -1 : corners[sideAfter(other, 2)];
      hinges.push([a, b, c >= 0 && known[c] ? c : -1]);
    } else if (known[a] || known[b]) near = known[a] ? a : b;
  }
  return { node, hinges, near };
}
