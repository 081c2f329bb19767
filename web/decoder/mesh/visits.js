import { sideAfter } from "./integers.js";

/** Faces around a node that tell where it is, at most. */
const MOST_HINGES = 16;

/**
 * A node whose value comes next, and what is known around it (section 15.3 of the specification).
 * @typedef {object} Visit
 * @property {number} node
 * @property {number[]} hinges three numbers each: known ends a and b of an edge, and the node c beyond it or -1
 * @property {number} near a known node where there is no hinge, or -1
 */

/**
 * Goes over all nodes; `read` knows what one is before the next comes.
 * @param {Int32Array} corners nodes (3 m)
 * @param {Int32Array} twin (3 m) the side that each meets, or -1
 * @param {number} count of nodes
 * @param {(visit: Visit) => void} read
 */
export function visitAll(corners, twin, count, read) {
  const known = new Uint8Array(count);
  const ready = new Uint8Array(count);
  const full = new Uint8Array(corners.length / 3);
  const { first, list } = cornersOf(corners, count);
  /** @type {number[][]} */
  const buckets = [[], [], [], []];
  for (let begin = 0; begin < corners.length; begin++) {
    if (known[corners[begin]]) continue;
    buckets[0].push(corners[begin]);
    for (let node; (node = next(buckets)) >= 0; ) {
      if (known[node]) continue;
      read(visitOf(node, list, first, corners, twin, known));
      known[node] = 1;
      for (let i = first[node]; i < first[node + 1]; i++) {
        const face = Math.floor(list[i] / 3);
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
  corners.forEach((node) => first[node + 1]++);
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
 * @param {number} node @param {Int32Array} list @param {Int32Array} first @param {Int32Array} corners @param {Int32Array} twin
 * @param {Uint8Array} known
 * @returns {Visit}
 */
function visitOf(node, list, first, corners, twin, known) {
  /** @type {number[]} */
  const hinges = [];
  let near = -1;
  for (let i = first[node]; i < first[node + 1]; i++) {
    const side = sideAfter(list[i]);
    const [a, b] = [corners[side], corners[sideAfter(side)]];
    if (known[a] && known[b]) {
      if (hinges.length === 3 * MOST_HINGES) break;
      const other = twin[side];
      const c = other < 0 ? -1 : corners[sideAfter(other, 2)];
      hinges.push(a, b, c >= 0 && known[c] ? c : -1);
    } else if (known[a] || known[b]) near = known[a] ? a : b;
  }
  return { node, hinges, near };
}
