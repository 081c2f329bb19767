import { cross, product, shortened, sideAfter, wayBetween } from "./integers.js";

/**
 * How sharp the edge at each side is: from 0, at least a right angle, to 8, flat; 9 at borders.
 * @param {Int32Array} corners vertices (3 m) @param {Int32Array} twin (3 m) @param {Int32Array} places (3 n)
 */
export function bendsOf(corners, twin, places) {
  const normals = new Int32Array(corners.length);
  for (let at = 0; at < corners.length; at += 3) {
    const u = shortened(wayBetween(places, corners[at], corners[at + 1]), 10);
    const v = shortened(wayBetween(places, corners[at], corners[at + 2]), 10);
    normals.set(shortened(cross(u, v), 10), at);
  }
  const bends = twin.map((other, side) => {
    if (other < 0) return 9;
    const m = side - (side % 3);
    const n = other - (other % 3);
    const aligned = product(normals, m, n);
    const both = product(normals, m, m) * product(normals, n, n);
    return aligned > 0 && both ? Math.floor((8 * aligned * aligned) / both) : 0;
  });
  return new Uint8Array(bends);
}

/**
 * Reads a flag for each edge (section 15.5 of the specification); those of borders are there.
 * @param {import("./bits.js").BitDecoder} bits
 * @param {number} slot
 * @param {Int32Array} corners points (3 m)
 * @param {Int32Array} twin (3 m)
 * @param {Uint8Array} bends (3 m)
 * @param {Uint8Array} flags (3 m), changed
 */
export function readEdges(bits, slot, corners, twin, bends, flags) {
  const lines = new Int32Array(corners.length);
  const left = new Int32Array(corners.length);
  twin.forEach((other, side) => {
    for (const end of [corners[side], corners[sideAfter(side)]]) {
      if (other < 0) lines[end] += flags[side];
      if (other > side) left[end]++;
    }
  });
  const stateOf = (/** @type {number} */ end) => Math.min(lines[end], 3) * 4 + Math.min(left[end], 4) - 1;
  twin.forEach((other, side) => {
    if (other <= side) return;
    const ends = [corners[side], corners[sideAfter(side)]];
    const [one, two] = [stateOf(ends[0]), stateOf(ends[1])];
    const [low, high] = [Math.min(one, two), Math.max(one, two)];
    const [state, few] = [low * 16 + high, (low >> 2) * 4 + (high >> 2)];
    const flag = bits.bit(slot, state, state * 10 + bends[side], few * 10 + bends[side]);
    for (const end of ends) {
      left[end]--;
      lines[end] += flag;
    }
    flags[side] = flags[other] = flag;
  });
}
